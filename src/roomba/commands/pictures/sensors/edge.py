"""Cliff sensors and wheel drops: slowly over the edge of the stairs, and kept from it."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roomba.commands.pictures.sensors.drives import STEP, DriveRecording
from roomba.configuration.robot import RobotConfig
from roomba.control.speed_loop import Hazards, SpeedLoop
from roomba.geometry import Pose, Twist
from roomba.plots.style import (
    BLUE,
    INK,
    ORANGE,
    Area,
    draw_robot,
    draw_signals,
    drawn,
    empty_figure,
    show_floor_plan,
    side_by_side,
    stacked,
)
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_START = Pose(6.0, -0.55, -0.3)
_SPEED = 0.1
"""m/s"""
_AREA: Area = (5.4, -1.4, 7.9, 0.1)
_SIGNALS = {
    "cliff left": "cliff_left",
    "cliff front left": "cliff_front_left",
    "cliff front right": "cliff_front_right",
    "cliff right": "cliff_right",
    "wheel drop left": "drop_left",
    "wheel drop right": "drop_right",
}


@drawn
def picture_of_edge(home: Home, seconds: float = 8.0) -> Figure:
    """Draw the signals while it drives over the edge, and what the speed loop does instead."""
    blind = DriveRecording(Simulator(home, start=_START))
    blind.drive(Twist(_SPEED, 0.0), seconds)
    careful = _with_speed_loop(home, seconds)
    figure = empty_figure(1100, 620)
    left, right = side_by_side(figure, [1.0, 1.15])
    plan, distance = left.subplots(2, 1, height_ratios=[1.0, 0.8])
    _draw_plan(plan, home, blind)
    edge = home.stairs[0].x_min
    for recording, colour, name in (
        (blind, ORANGE, "the drive alone"),
        (careful, BLUE, "with the speed loop"),
    ):
        time = recording.of("time")
        distance.plot(time, 100.0 * (edge - recording.of("x")), color=colour, label=name)
    distance.set(xlabel="time, s", ylabel="middle to the edge, cm", xlim=(0.0, seconds))
    distance.legend(loc="upper right")
    alone, held = stacked(right, 2)
    for axes, recording in ((alone, blind), (held, careful)):
        signals = {name: recording.of(key) for name, key in _SIGNALS.items()}
        draw_signals(axes, recording.of("time"), signals)
    alone.set_title("The drive alone, asked for 0.1 m/s ahead")
    held.set_title("With the speed loop, asked for the same")
    held.set(xlabel="time, s", xlim=(0.0, seconds))
    return figure


def _with_speed_loop(home: Home, seconds: float) -> DriveRecording:
    recording = DriveRecording(Simulator(home, start=_START))
    world = recording.simulator
    loop = SpeedLoop(world.config.body, world.max_speed)
    while world.time < seconds:
        seen = world.observe()
        loop.set_hazards(Hazards(cliff=seen.cliff.any, wheel_drop=seen.wheels.dropped))
        loop.command(seen.time, Twist(_SPEED, 0.0))
        recording.step(loop.tick(seen.time)[0], STEP)
    return recording


def _draw_plan(axes: Axes, home: Home, recording: DriveRecording) -> None:
    show_floor_plan(axes, home, _AREA)
    draw_robot(axes, _START)
    cliff = RobotConfig().cliff
    for angle in np.radians(cliff.angles):
        at = _START.compose(
            Pose(cliff.radius * math.cos(angle), cliff.radius * math.sin(angle), 0.0)
        )
        axes.plot(at.x, at.y, "s", color=BLUE, markersize=4.0)
    half = 0.5 * RobotConfig().body.wheel_separation
    for side in (half, -half):
        at = _START.compose(Pose(0.0, side, 0.0))
        axes.plot(at.x, at.y, "o", color=INK, markersize=4.0)
    draw_robot(axes, recording.simulator.pose, ORANGE)
    axes.plot(recording.of("x"), recording.of("y"), color=ORANGE)
    axes.set_title("■ cliff sensors, ● wheels; where the drive alone ends")
