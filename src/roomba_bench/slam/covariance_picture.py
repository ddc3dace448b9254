"""Checks covariances: whether the share of errors in a confidence region is the nominal one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from roomba.arrays import Floats
from roomba.plots.style import BLUE, GREEN, INK, ORANGE, RED, drawn, empty_figure
from roomba_bench.localization.drive import Wander
from roomba_bench.localization.robot import LocalizedRobot, home_named
from roomba_bench.slam.localized import HELD, square_of

_SHARES: Final = np.linspace(0.0, 0.999, 200)
_COLOURS: Final = (BLUE, GREEN, ORANGE, RED, "#7a5195", "#5d8aa8")
_SIMULATED: Final = ("flat", "apartment")


def simulated_squares(seconds: float) -> dict[str, Floats]:
    """Return squared Mahalanobis errors, [n], of simulated drives of so many ``seconds``."""
    squares = {}
    for name in _SIMULATED:
        robot, rows = LocalizedRobot(home_named(name), 1), []
        wander = Wander(np.random.default_rng(1))
        while robot.seen.time < seconds:
            seen = robot.seen
            robot.tick(wander.tick(seen.time, seen.odometry.theta, robot.ranges, robot.touches))
            estimate, true = robot.localizer.estimate, robot.seen.pose
            off = np.array([estimate.pose.x - true.x, estimate.pose.y - true.y])
            rows.append(off @ np.linalg.inv(estimate.covariance[:2, :2]) @ off)
        squares[f"simulated, {name}"] = np.array(rows)
    return squares


def write_covariances(path: Path, squares: Mapping[str, Floats]) -> None:
    """Write the picture of squared errors by covariances, [n] for each drive; raises OSError."""
    Image.fromarray(picture_of_covariances(squares)).quantize(64).save(path, optimize=True)


@drawn
def picture_of_covariances(squares: Mapping[str, Floats]) -> Figure:
    """Return the share of errors in regions that should hold a share of them, for each drive."""
    figure = empty_figure(1150, 520)
    axes = figure.subplots()
    regions = np.array([square_of(share) for share in _SHARES])
    for number, (name, each) in enumerate(squares.items()):
        held = 100.0 * np.mean(each[:, None] < regions, axis=0)
        colour = _COLOURS[number % len(_COLOURS)]
        at = 100.0 * np.mean(each < square_of(HELD))
        style = "--" if number >= len(_COLOURS) else "-"
        axes.plot(100.0 * _SHARES, held, style, color=colour, label=f"{name}: {at:.1f} %")
    axes.plot((0, 100), (0, 100), ":", color=INK, label="as many as should")
    axes.axvline(100.0 * HELD, color=INK, linewidth=0.6)
    axes.set(xlabel="region of the covariance, % of errors that it should hold")
    axes.set(ylabel="% of errors that it holds", xlim=(0, 100), ylim=(0, 101))
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), title="in the region of 95 %")
    return figure
