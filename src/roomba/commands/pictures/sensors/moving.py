"""What moves in a home: where it is, when, and how the lidar sees a person."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    PINK,
    area_of,
    draw_robot,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Box, Home, MovingKind, MovingThing
from roomba.world.simulator import Simulator

_STAND = Pose(3.0, 1.0, 0.0)
"""Beside the way that people take."""
_COLOURS = (PINK, GREEN, ORANGE, BLUE)
_NEAR = 0.9
"""m"""
_DT = 0.1
"""s"""


@drawn
def picture_of_moving(home: Home, minutes: float = 40.0) -> Figure:
    """Draw ways and times of all that moves, and a scan when the first person comes near."""
    world = Simulator(home, start=_STAND)
    rows, seen = [], None
    people = [thing.kind is MovingKind.PERSON for thing in home.moving]
    for _ in range(round(60.0 * minutes / _DT)):
        world.advance(Twist(), _DT, 1)
        rows.append(world.things)
        away = np.hypot(rows[-1][:, 0] - _STAND.x, rows[-1][:, 1] - _STAND.y)
        away = np.where(people & (rows[-1][:, 3] > 0.0), away, np.inf)
        if seen is None and away.min(initial=np.inf) < _NEAR:
            seen = world.ranges, rows[-1]
    poses = np.array(rows)
    figure = empty_figure(1150, 760)
    panels = figure.subplot_mosaic(
        [["plan", "close"], ["times", "times"]], width_ratios=[1.1, 1.0], height_ratios=[1.0, 0.35]
    )
    plan, close = panels["plan"], panels["close"]
    show_floor_plan(plan, home, area_of(home))
    for number, thing in enumerate(home.moving):
        _draw_way(plan, number, thing, poses[:, number])
    draw_robot(plan, _STAND)
    plan.set_title(f"Where things were in {minutes:g} minutes")
    _draw_scan(close, home, *(seen or (world.ranges, rows[-1])))
    _draw_times(panels["times"], home, poses, minutes)
    return figure


def _draw_way(axes: Axes, number: int, thing: MovingThing, poses: NDArray[np.float64]) -> None:
    colour = _COLOURS[number % len(_COLOURS)]
    there = poses[:, 3] > 0.0
    if thing.kind is MovingKind.PERSON:
        x = np.where(there, poses[:, 0], np.nan)
        # Two may take the same way.
        width, style = (4.0, "-") if number % 2 == 0 else (1.6, "--")
        axes.plot(x, poses[:, 1], color=colour, linewidth=width, linestyle=style)
        return
    for pose in np.unique(poses[there][:: max(1, round(30.0 / _DT))], axis=0):
        _draw_boxes(axes, thing.boxes, Pose(*pose[:3].tolist()), colour)


def _draw_boxes(axes: Axes, boxes: tuple[Box, ...], pose: Pose, colour: str) -> None:
    for box in boxes:
        at = box.placed_at(pose)
        axes.add_patch(
            Rectangle(
                (at.x - 0.5 * at.length, at.y - 0.5 * at.width),
                at.length,
                at.width,
                angle=math.degrees(at.theta),
                rotation_point="center",
                facecolor="none",
                edgecolor=colour,
                linewidth=1.2,
            )
        )


def _draw_scan(
    axes: Axes, home: Home, ranges: NDArray[np.float32], things: NDArray[np.float64]
) -> None:
    show_floor_plan(axes, home, (2.6, 0.0, 4.4, 1.6))
    height = LidarConfig().mount_height
    for number, thing in enumerate(home.moving):
        if things[number, 3] > 0.0:
            low = tuple(box for box in thing.boxes if box.bottom < height)
            pose = Pose(*things[number, :3].tolist())
            _draw_boxes(axes, low, pose, _COLOURS[number % len(_COLOURS)])
    angles = _STAND.theta + np.arange(len(ranges)) * (2.0 * math.pi / len(ranges))
    near = np.isfinite(ranges)
    axes.plot(
        _STAND.x + ranges[near] * np.cos(angles[near]),
        _STAND.y + ranges[near] * np.sin(angles[near]),
        ".",
        color=INK,
        markersize=5.0,
    )
    draw_robot(axes, _STAND)
    axes.set_title("A scan of a person who comes near: two feet")


def _draw_times(axes: Axes, home: Home, poses: NDArray[np.float64], minutes: float) -> None:
    names, words = [], {MovingKind.PERSON: "is there", MovingKind.DOOR: "shut"}
    for number, thing in enumerate(home.moving):
        first = poses[0, number, :3]
        is_on = poses[:, number, 3] > 0.0
        if thing.kind is MovingKind.FURNITURE:
            is_on = np.any(np.abs(poses[:, number, :3] - first) > 1e-3, axis=1)
        time = np.arange(len(poses)) * _DT / 60.0
        colour = _COLOURS[number % len(_COLOURS)]
        axes.fill_between(time, number - 0.35, number + 0.35, where=list(is_on), color=colour)
        names.append(f"{thing.name} {words.get(thing.kind, 'elsewhere')}")
    axes.set_yticks(range(len(names)), names)
    axes.set(xlabel="time, minutes", xlim=(0.0, minutes))
    axes.grid(visible=False, axis="y")
