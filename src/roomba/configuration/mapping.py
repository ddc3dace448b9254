"""Validated, frozen configuration of making maps: ``configuration/mapping.yaml``."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field

from roomba.configuration.frozen import (
    Angle,
    AtLeastOne,
    Cell,
    Count,
    Duration,
    Frozen,
    Length,
    NotNegative,
    Positive,
    Ratio,
)

Window = Annotated[float, Field(ge=0.01, le=50.0)]
"""m to each side, in which scans are matched: time and memory grow with its square."""


class MapChangesConfig(Frozen):
    """What is a lasting change of a map that the robot knows: m, m2, s."""

    farthest: Length = 5.0
    """The longest range that counts: there a degree is two cells."""
    look_way: Length = 0.5
    """A look at the home lasts until so much was driven, or longer."""
    look_time: Duration = 15.0
    """A look at the home lasts for so long, or longer: people who stand about are no change."""
    sure: Annotated[int, Field(ge=1, le=5)] = 4
    """Looks that show a change of a cell, minus those that show none, for the change to count."""
    blur: Length = 0.12
    """A cell that is nearer to what stands as mapped tells no change."""
    least_area: Positive = 0.06
    """A change with less area, and with less extent than ``least_length``, is no furniture."""
    least_length: Length = 0.4
    behind: Length = 0.8
    """Depth of unknown cells behind vanished furniture that become known."""
    movable: Length = 0.7
    """People move things about that are no larger; a chair that was moved is no change."""
    moved: Length = 1.0
    """The farthest that a thing counts as moved; farther off, another thing appeared."""
    new_way: Length = 0.05
    new_turn: Angle = 0.2
    """m, rad; a scan from nearer to the last one says nothing new."""
    least_beams: AtLeastOne = 2
    """Beams in a cell, for a look to count there."""
    solid_share: Ratio = 0.25
    """Share of a cell's beams that must end in it: with noise many end in the next cell."""
    open_share: Ratio = 0.1
    """With less of them a cell is open."""

    in_order: ClassVar[tuple[str, ...]] = ("open_share <= solid_share",)


class FloorsConfig(Frozen):
    """Telling floors, and their rooms, from others: m, rad; evidence is a natural logarithm."""

    station_radius: Length = 0.3
    station_turn: Angle = 0.3
    """Around its station, where a robot is expected to wake."""
    station_evidence: NotNegative = 6.0
    """Evidence for such a place; less than believing it needs, so that it never decides alone."""
    new_evidence: Annotated[float, Field(le=0.0, allow_inf_nan=False)] = -0.11
    """Of each beam, for a floor that is new: as if 7 of 10 beams agreed with a map and 3 did not at
    all. In homes that are known, with noise, a beam has -0.001 to -0.013; with some furniture
    moved, -0.05. The best place in a furnished home that the robot never was in has -0.15 to -0.30.
    """
    least_walls: Ratio = 0.73
    """The least share of their walls that two maps of one floor have in common."""
    least_floor: Ratio = 0.6
    """The least share of the smaller map's floor that two maps of one floor have in common."""
    same_wall: Length = 0.08
    """Walls so near to each other are the same: those of neighbouring cells."""
    same_room: Ratio = 0.5
    """Share of the smaller of two rooms' floor; with less in common they are different rooms."""


class FollowingConfig(Frozen):
    """Following the robot from scan to scan, and finding it back: m, rad, s."""

    least_points: AtLeastOne = 30
    fewest_points: AtLeastOne = 10
    """Points of a scan that counts: a quarter of the beams, but at least ``fewest_points``; never
    more than ``least_points`` are needed."""
    many_misses: AtLeastOne = 5
    """Scans without a match, after which the next is matched from farther away."""
    doubtful: Ratio = 0.85
    """Share of the usual agreement; a scan that agrees less is searched for around the robot."""
    searched_way: Window = 0.5
    searched_turn: Angle = 0.8
    """The window to each side, before anything was driven unconfirmed."""
    searched_share: NotNegative = 0.2
    """The window grows by this share of what was driven and turned unconfirmed."""
    searched_farthest: Annotated[float, Field(ge=0.0, le=50.0)] = 4.0
    """The most by which the window grows for what it drives unconfirmed at its pace."""
    pace_fades: Duration = 10.0
    """s after which the fastest pace counts a third."""
    likelihood: Ratio = 0.5
    """Mean likelihood of points from which a pose is looked at closely."""
    far_apart: Length = 0.5
    """Scans so far apart show much that no scan before them showed."""
    likelihood_apart: Ratio = 0.3
    """The same mean between such scans, up to half as far off as wheels may have slipped."""
    better: Annotated[float, Field(ge=1.0, le=10.0)] = 1.2
    """Factor by which a found place must agree better than the one that is thought to be right."""
    leap_way: Length = 0.5
    leap_turn: Angle = 0.35
    """A place that is farther off than this and ``searched_share`` of what was driven and turned
    unconfirmed is of a piece of its own, until more than one scan shows it."""
    carried_way: Length = 0.3
    carried_turn: Angle = 0.3
    """From a scan that fitted to one that does not: if less was driven and turned, the robot was
    carried, since what it saw before must still be in sight."""
    given_up_after: AtLeastOne = 7
    """Scans that show enough and confirm nothing, before the map goes on in a piece of its own."""
    piece_way: NotNegative = 0.6
    piece_turn: NotNegative = 2.0
    """Driven or turned unconfirmed, too, before the map goes on in a piece of its own."""
    standing_deviation: Length = 0.001
    standing_heading: Angle = 0.0005
    """Standard deviations, besides those of the way, of dead reckoning between two scans."""
    sure_deviation: Length = 0.01
    sure_heading: Angle = 0.005
    unsure_deviation: Length = 0.1
    unsure_heading: Angle = 0.05
    """Standard deviations that are told of the pose: with a match of the scan, and without one."""

    in_order: ClassVar[tuple[str, ...]] = ("fewest_points <= least_points",)


class WindowsConfig(Frozen):
    """How far submaps that are matched may lie off: m, rad."""

    beside: Window = 0.15
    """From where they were thought to be, always."""
    narrow: Window = 0.35
    """In a window that is no wider points find their surfaces by themselves."""
    ambiguous: Window = 1.5
    """In a wider window nothing else may fit nearly as well."""
    widest: Window = 12.0
    """No wider window is searched."""
    turn: Angle = 0.1
    turn_per_metre: NotNegative = 0.15
    most_turn: NotNegative = 0.9
    """rad, and rad/m of the window; how much submaps may be turned, the second at most this."""
    most_far: Count = 6
    far_apart: AtLeastOne = 3
    """Of submaps that are near only if much is wrong, at most ``most_far`` are looked at, whose
    numbers are at least ``far_apart`` apart."""
    likely: Ratio = 0.45
    """Mean likelihood of points from which a pose of a wide window is looked at closely."""
    hardly: Length = 0.3
    """A link with a larger standard deviation was made without a scan that confirmed it."""

    in_order: ClassVar[tuple[str, ...]] = ("beside <= narrow <= ambiguous <= widest",)


class BackingConfig(Frozen):
    """Loops that move a part of the map far, which another one must back: m, rad."""

    far: Length = 2.0
    neighbours: AtLeastOne = 3
    """Submaps; the other loop must belong to a submap at most so many away."""
    same_place: Length = 0.4
    same_heading: Angle = 0.08
    """Two loops agree if they place a submap as nearly alike as this."""


class PiecesConfig(Frozen):
    """Standard deviations of links that no scan measured: m, rad."""

    deviation: Length = 0.5
    heading_deviation: Angle = 0.1
    """Of a link to a piece of its own, before anything was driven unconfirmed."""
    share: NotNegative = 0.1
    """Such a link is less sure by this share of what was driven and turned unconfirmed."""
    told_deviation: Length = 0.05
    told_heading_deviation: Angle = 0.05
    """Of a link to a pose that people told."""


class PartsConfig(Frozen):
    """Finding parts of a map that no scan joined to it."""

    looked_for: AtLeastOne = 8
    """The most samples of a part, each of which is looked for on all of the map."""
    keyframes: AtLeastOne = 5
    """The fewest keyframes of a sample."""
    backed: AtLeastOne = 3
    """The fewest samples that must agree on where the part lies."""
    clearer: Annotated[float, Field(ge=1.0, le=10.0)] = 2.0
    """So many times as many samples must be found there as at any other place."""
    seen_through: Ratio = 0.05
    """Share of a part's beams that go through surfaces seen before: with more it does not lie where
    it is thought to lie, and its robot was carried."""
    cell: Length = 0.1
    """m; of the grid of these surfaces."""


class RelocationConfig(Frozen):
    """Finding a robot on its growing map after it was carried: m, rad."""

    window: Window = 3.0
    """Around each submap's beginning."""
    likelihood: Ratio = 0.85
    """Mean likelihood of points that a place must have."""
    clearly: Ratio = 0.85
    """Share of the best place's likelihood that other places may have."""
    elsewhere_way: Length = 0.5
    elsewhere_turn: Angle = 0.3
    """Poses that are farther apart are of two places."""
    moved: Length = 0.25
    turned: Angle = 0.5
    """Driven or turned between two scans that are searched for."""
    same_place: Length = 0.2
    same_heading: Angle = 0.1
    """Two scans agree if they are found as near as this to where they lie to each other."""


class OpenWaysConfig(Frozen):
    """Floor that beams without an echo show to be free: m."""

    farthest: Length = 1.0
    """From the lidar: within this it sees black things as well."""
    margin: Length = 0.1
    """By how much nearer than what the beams beside them met."""


class MappingConfig(Frozen):
    """Keyframes, submaps and their links: m, rad; the drawing: shares 0..1."""

    resolution: Cell = 0.05
    keyframe_way: Length = 0.15
    keyframe_turn: Angle = 0.35
    submap_way: Length = 3.0
    submap_keyframes: Annotated[int, Field(ge=4)] = 40
    point_deviation: Length = 0.03
    least_met: Ratio = 0.35
    least_close: Ratio = 0.6
    link_radius: Length = 5.0
    link_met: Ratio = 0.3
    link_close: Ratio = 0.8
    link_points: Annotated[int, Field(ge=50)] = 150
    drift: Positive = 0.03
    least_link_deviation: Length = 0.004
    least_link_turn: Angle = 0.0015
    occupied_share: Ratio = 0.3
    occupied_beams: AtLeastOne = 2
    least_floor: NotNegative = 0.05
    """m2; smaller patches of free cells, cut off from the others, lie behind surfaces."""
    redrawn_shift: Positive = 0.01
    farthest: Length = 30.0
    """Points that are farther are drawn, but nothing is matched to them."""
    spare: Length = 4.0
    """The farthest that a robot gets from the beginning of a submap."""
    search_reach: Length = 12.0
    """Points farther from a place are no help in looking for it: their bearing is less sure."""
    oblique: Annotated[float, Field(gt=0.0, lt=45.0)] = 4.0
    """Degrees; walls that are turned by more from the map's axes are so by design."""
    open_ways: OpenWaysConfig = OpenWaysConfig()
    following: FollowingConfig = FollowingConfig()
    windows: WindowsConfig = WindowsConfig()
    backing: BackingConfig = BackingConfig()
    pieces: PiecesConfig = PiecesConfig()
    parts: PartsConfig = PartsConfig()
    relocation: RelocationConfig = RelocationConfig()
    changes: MapChangesConfig = MapChangesConfig()
    floors: FloorsConfig = FloorsConfig()
