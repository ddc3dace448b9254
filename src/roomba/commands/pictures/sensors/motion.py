"""Encoders, gyro and accelerometer: a short drive as each of them feels it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from roomba.commands.pictures.sensors.drives import STEP, DriveRecording
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import BLUE, INK, ORANGE, drawn, empty_figure, stacked
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_START = Pose(1.5, 5.0, 0.0)
_DRIVE = (
    (Twist(0.0, 0.0), 0.5),
    (Twist(0.3, 0.0), 2.0),
    (Twist(0.3, 1.0), 1.5),
    (Twist(0.0, -1.5), 1.5),
    (Twist(0.0, 0.0), 1.0),
)
"""Twists, and for how many seconds each."""


@drawn
def picture_of_motion(home: Home, start: Pose = _START) -> Figure:
    """Draw speed, turning speed and acceleration: the drive's own, and what the sensors tell."""
    recording = DriveRecording(Simulator(home, SimulatedRobotConfig(), start=start))
    for twist, seconds in _DRIVE:
        recording.drive(twist, seconds)
    time = recording.of("time")
    figure = empty_figure(1000, 680)
    speed, turning, acceleration = stacked(figure, 3)
    speed.plot(time, recording.of("odometry_linear"), color=ORANGE, label="encoders")
    speed.plot(time, recording.of("linear"), color=INK, label="the drive")
    speed.set(ylabel="speed, m/s")
    turning.plot(time, recording.of("odometry_angular"), color=ORANGE, label="encoders")
    turning.plot(time, recording.of("gyro"), color=BLUE, label="gyro")
    turning.plot(time, recording.of("angular"), color=INK, label="the drive")
    turning.set(ylabel="turning speed, rad/s")
    driven = np.diff(recording.of("linear"), prepend=0.0) / STEP
    acceleration.plot(time, recording.of("acceleration"), color=BLUE, label="accelerometer")
    acceleration.plot(time, driven, color=INK, label="the drive")
    acceleration.set(ylabel="acceleration ahead, m/s²", xlabel="time, s", xlim=(0.0, time[-1]))
    for axes in (speed, turning, acceleration):
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.suptitle("Ahead, round a bend, and a turn on the spot; one value each 25 ms")
    return figure
