"""A path along walls, the curve that rounds it off, and what a robot drives of it."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.robot import RobotConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Pose
from roomba.plots.style import BLUE, GREEN, GREY, ORANGE, drawn, empty_figure
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_PATH: Final = (
    (0.00, 0.01), (0.64, 0.01), (0.66, 0.02), (0.69, 0.04), (0.72, 0.07), (0.74, 0.10),
    (0.75, 0.12), (0.75, 0.43), (0.74, 0.45), (0.72, 0.48), (0.61, 0.59), (0.56, 0.70),
)  # fmt: skip
"""m; a piece of a plan along walls, whose fine grid is of 1 cm."""
_SPEED: Final = 0.3
"""m/s; that is wanted."""
_MOST_TICKS: Final = 400
"""A drive that takes more of them does not come to its end."""
_FROM: Final = (1.2, 1.2)
"""m; where the path begins in the home, which is to be empty there."""


@drawn
def picture_of_bends(home: Home) -> Figure:
    """Draw a path, its curve and a drive; and beside it the curvature and the speed along it."""
    points = np.array(_PATH) + _FROM
    config = RobotConfig()
    tracker = PathTracker(points, config.tracking, config.body, config.timing.tick)
    places, off = _driven(home, tracker)
    figure = empty_figure(1150, 430)
    on_floor, along = figure.subplots(1, 2, width_ratios=[1.2, 1.0])
    samples = tracker.course.samples
    on_floor.plot(*points.T, "o-", color=GREY, ms=6, lw=1.0, label="path")
    on_floor.plot(samples["x"], samples["y"], color=BLUE, lw=3.0, label="curve")
    on_floor.plot(*places.T, color=ORANGE, lw=1.2, label="driven")
    on_floor.set_title(f"Driven {np.median(off):.1f} mm off the curve, {off.max():.1f} mm at most")
    on_floor.set_aspect("equal")
    on_floor.set(xlabel="x, m", ylabel="y, m")
    on_floor.legend(loc="center left")
    _draw_along(along, samples)
    return figure


def _draw_along(along: Axes, samples: NDArray[np.void]) -> None:
    """Draw curvature and speed along a curve."""
    steps = np.hypot(np.diff(samples["x"]), np.diff(samples["y"]))
    stations = np.concatenate(([0.0], np.cumsum(steps)))
    along.plot(stations, samples["curvature"], color=BLUE, label="curvature, 1/m")
    along.plot([], [], color=GREEN, label="speed, m/s")
    along.set(xlabel="along the curve, m", ylabel="curvature, 1/m", ylim=(-12.0, 24.0))
    speeds = along.twinx()
    speeds.plot(stations, np.minimum(samples["speed"], _SPEED), color=GREEN)
    speeds.set(ylabel="speed, m/s", ylim=(-0.2, 0.4), yticks=(0.0, 0.1, 0.2, 0.3, 0.4))
    along.set_title("How it bends, and the speed that this allows")
    along.legend(loc="lower left")


def _driven(home: Home, tracker: PathTracker) -> tuple[Floats, Floats]:
    """Let a robot that knows its place follow a path: where it was, m, and how far off, mm."""
    x, y = tracker.course.points[0].tolist()
    robot = Simulator(home, SimulatedRobotConfig(), start=Pose(x, y, 0.0))
    places: list[tuple[float, float]] = []
    off: list[float] = []
    tick = RobotConfig().timing.tick
    while not tracker.is_done and len(places) < _MOST_TICKS:
        robot.step(tracker.tick(robot.pose, _SPEED), tick)
        places.append((robot.pose.x, robot.pose.y))
        off.append(1000.0 * abs(tracker.aside))
    return np.array(places), np.array(off)
