"""Faults: what a wheel without grip, and one that is held, do to the way and to the sensors."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from roomba.commands.pictures.sensors.drives import STEP, DriveRecording
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import BLUE, INK, ORANGE, drawn, empty_figure, side_by_side
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_SLIP, _STALL = (4.0, 7.0), (11.0, 12.0)
"""s; from when to when."""
_END = 15.0
_LOST = 0.5
"""0..1; share of the left wheel's way that is lost while it slips."""
_SPEED = 0.2
"""m/s"""


@drawn
def picture_of_faults(home: Home) -> Figure:
    """Draw a drive straight on: the left wheel slips for a while, later the right one is held."""
    x_min, _, y_min, y_max = home.frame.extent
    start = Pose(x_min + 0.8, 0.5 * (y_min + y_max), 0.0)
    recording = DriveRecording(Simulator(home, SimulatedRobotConfig(), start=start))
    for until, fault, value in (
        (_SLIP[0], Fault.SLIP_LEFT, _LOST),
        (_SLIP[1], Fault.SLIP_LEFT, 0.0),
        (_STALL[0], Fault.STALL_RIGHT, 1.0),
        (_STALL[1], Fault.STALL_RIGHT, 0.0),
        (_END, Fault.STALL_RIGHT, 0.0),
    ):
        recording.drive(Twist(_SPEED, 0.0), until - recording.simulator.time)
        recording.simulator.inject(fault, value)
    time = recording.of("time")
    figure = empty_figure(1100, 480)
    left, right = side_by_side(figure, [1.0, 1.0])
    way = left.subplots()
    told_x, told_y = start.x + recording.of("odometry_x"), start.y + recording.of("odometry_y")
    way.plot(recording.of("x"), recording.of("y"), color=INK, label="true")
    way.plot(told_x, told_y, color=ORANGE, label="by the encoders")
    way.plot(start.x, start.y, "o", color=INK)
    way.set(xlabel="x, m", ylabel="y, m", aspect="equal")
    way.set_title("The way")
    way.legend(loc="best")
    heading, power = right.subplots(2, 1, sharex=True)
    for name, values, colour in (
        ("true", np.unwrap(recording.of("theta")), INK),
        ("encoders", np.unwrap(recording.of("odometry_theta")), ORANGE),
        ("gyro, summed up", np.cumsum(recording.of("gyro")) * STEP, BLUE),
    ):
        style = "--" if colour == BLUE else "-"
        heading.plot(time, np.degrees(values), color=colour, linestyle=style, label=name)
    heading.set(ylabel="heading, degrees")
    heading.legend(loc="lower left")
    power.plot(time, recording.of("power"), color=BLUE)
    power.set(xlabel="time, s", ylabel="power out, W", ylim=(0.0, None), xlim=(0.0, _END))
    for axes in (heading, power):
        axes.axvspan(*_SLIP, color=ORANGE, alpha=0.18, linewidth=0.0)
        axes.axvspan(*_STALL, color=BLUE, alpha=0.18, linewidth=0.0)
    heading.set_title("Orange: slip_left 0.5; blue: stall_right")
    return figure
