"""Odometry: the true way beside what the wheels tell, and the heading by encoders and by gyro."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from roomba.arrays import Floats
from roomba.commands.pictures.sensors.drives import STEP, DriveRecording, follow
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.plots.style import (
    BLUE,
    INK,
    ORANGE,
    area_of,
    draw_robot,
    drawn,
    empty_figure,
    show_floor_plan,
    side_by_side,
)
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_WAY = (
    (3.1, 5.0),
    (3.1, 3.9),
    (1.3, 3.9),
    (1.3, 0.5),
    (4.6, 0.5),
    (3.5, 2.6),
    (3.1, 5.0),
    (8.45, 5.0),
    (8.45, 7.0),
    (7.4, 6.6),
    (8.45, 6.2),
    (8.45, 5.0),
    (1.65, 5.0),
    (1.65, 7.2),
    (0.9, 6.6),
    (1.65, 6.2),
    (1.65, 5.0),
)
"""m; a way through rooms of the apartment that comes back to where it began."""
_SPEED = 0.3
"""m/s"""
_SHOWN = 150.0
"""s; of the way on the plan. Later ones would cover each other."""


@drawn
def picture_of_odometry(
    home: Home, way: tuple[tuple[float, float], ...] = _WAY, seconds: float = 600.0
) -> Figure:
    """Draw where the robot was and where its wheels say it was, and how both differ."""
    recording = DriveRecording(Simulator(home, SimulatedRobotConfig(), seed=7))
    start = recording.simulator.pose
    follow(recording, way, _SPEED, seconds)
    x, y = recording.of("x"), recording.of("y")
    told_x, told_y = _in_map(start, recording.of("odometry_x"), recording.of("odometry_y"))
    truth = np.unwrap(recording.of("theta"))
    truth -= truth[0]
    by_wheels = np.unwrap(recording.of("odometry_theta"))
    by_gyro = np.cumsum(recording.of("gyro")) * STEP
    shown = recording.of("time") <= _SHOWN
    figure = empty_figure(1150, 620)
    left, right = side_by_side(figure, [1.15, 1.0])
    plan = left.subplots()
    show_floor_plan(plan, home, area_of(home))
    plan.plot(
        told_x[shown], told_y[shown], color=ORANGE, linewidth=1.0, label="by the wheels' encoders"
    )
    plan.plot(x[shown], y[shown], color=BLUE, linewidth=1.2, label="true")
    draw_robot(plan, Pose(x[shown][-1], y[shown][-1], recording.of("theta")[shown][-1]))
    plan.set_title(f"The first {_SHOWN:g} s, about {_SHOWN * _SPEED:.0f} m")
    plan.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2)
    place, heading = right.subplots(2, 1)
    place.plot(recording.of("distance"), np.hypot(told_x - x, told_y - y), color=ORANGE)
    place.set(xlabel="way, m", ylabel="error of the place, m", ylim=(0.0, None))
    place.set_title("Place by the encoders")
    minutes = recording.of("time") / 60.0
    heading.axhline(0.0, color=INK, linewidth=0.8)
    heading.plot(minutes, np.degrees(by_wheels - truth), color=ORANGE, label="encoders")
    heading.plot(minutes, np.degrees(by_gyro - truth), color=BLUE, label="gyro, summed up")
    heading.set(xlabel="time, minutes", ylabel="error, degrees")
    heading.set_title("Heading")
    heading.legend(loc="best")
    return figure


def _in_map(start: Pose, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return points of the frame that the robot started in, in the map frame."""
    cosine, sine = np.cos(start.theta), np.sin(start.theta)
    return start.x + cosine * x - sine * y, start.y + sine * x + cosine * y
