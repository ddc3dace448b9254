"""Validated, frozen configuration of making maps: ``configuration/mapping.yaml``."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.frozen import AtLeastOne, Frozen, NotNegative, Positive, Ratio


class MapChangesConfig(Frozen):
    """What is a lasting change of a map that the robot knows: m, m2, s."""

    farthest: Positive = 5.0
    """The longest range that counts: there a degree is two cells."""
    look_way: Positive = 0.5
    """A look at the home lasts until so much was driven,"""
    look_time: Positive = 15.0
    """and so much time has passed: people who stand about are no change."""
    sure: Annotated[int, Field(ge=1, le=5)] = 4
    """Looks that show a change of a cell, minus those that show none, for the change to count."""
    blur: Positive = 0.12
    """Nearer to what stands as mapped a cell tells no change."""
    least_area: Positive = 0.06
    """A change with less area, and with less extent than ``least_length``, is no furniture."""
    least_length: Positive = 0.4
    behind: Positive = 0.8
    """Depth of unknown cells behind vanished furniture that become known."""
    movable: Positive = 0.7
    """What is no larger is moved about by people; a chair that was moved is no change."""
    moved: Positive = 1.0
    """So far a thing is moved at most; farther off another one appeared."""
    new_way: Positive = 0.05
    new_turn: Positive = 0.2
    """m, rad; a scan from nearer to the last one says nothing new."""
    least_beams: AtLeastOne = 2
    """In a cell, for a look to count there."""
    solid_share: Ratio = 0.25
    """Share of a cell's beams that must end in it: with noise many end in the next cell."""
    open_share: Ratio = 0.1
    """With less of them a cell is open."""

    in_order: ClassVar = ("open_share <= solid_share",)


class FloorsConfig(Frozen):
    """Telling floors, and their rooms, from others: m, rad; evidence is a natural logarithm."""

    station_radius: Positive = 0.3
    station_turn: Positive = 0.3
    """Around its station, where a robot is expected to wake."""
    station_evidence: NotNegative = 6.0
    """For that; less than believing a place needs, so that it never decides alone."""
    new_evidence: Annotated[float, Field(le=0.0, allow_inf_nan=False)] = -0.11
    """Of each beam, for a floor that is new: as if 7 of 10 beams agreed with a map and 3 did not at
    all. In homes that are known, with noise, a beam has -0.001 to -0.013; with some furniture
    moved, -0.05. The best place in a furnished home that the robot never was in has -0.15 to -0.30.
    """
    least_walls: Ratio = 0.73
    """Share of the walls that two maps of one floor have in common, or more,"""
    least_floor: Ratio = 0.6
    """and of the smaller map's floor."""
    same_wall: Positive = 0.08
    """Walls so near to each other are the same: those of neighbouring cells."""
    same_room: Ratio = 0.5
    """Share of the smaller of two rooms' floor; with less in common they are different rooms."""


class MappingConfig(Frozen):
    """Keyframes, submaps and their links: m, rad; the drawing: shares 0..1."""

    resolution: Positive = 0.05
    keyframe_way: Positive = 0.15
    keyframe_turn: Positive = 0.35
    submap_way: Positive = 3.0
    submap_keyframes: Annotated[int, Field(ge=4)] = 40
    point_deviation: Positive = 0.03
    least_met: Ratio = 0.35
    least_close: Ratio = 0.6
    link_radius: Positive = 5.0
    link_met: Ratio = 0.3
    link_close: Ratio = 0.8
    link_points: Annotated[int, Field(ge=50)] = 150
    drift: Positive = 0.03
    least_link_deviation: Positive = 0.004
    least_link_turn: Positive = 0.0015
    occupied_share: Ratio = 0.3
    occupied_beams: AtLeastOne = 2
    redrawn_shift: Positive = 0.01
    changes: MapChangesConfig = MapChangesConfig()
    floors: FloorsConfig = FloorsConfig()
