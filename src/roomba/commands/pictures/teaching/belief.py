"""The belief of the place: how sure it is along a way, by wheels alone and with scans."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from roomba.arrays import Floats
from roomba.commands.pictures.teaching.matching import ends_at, matched
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.perception.localization.belief.belief import numbers_of
from roomba.perception.localization.belief.reckon_kernels import carry
from roomba.plots.style import BLUE, ORANGE, drawn, empty_figure, show_floor_plan
from roomba.world.home.home import Home

_START: Final = (5.25, -0.5)
"""m; in the hallway, which is bare along its sides."""
_WAY: Final = 6.0
_STEP: Final = 0.01
_EVERY: Final = 0.75
"""m: the way, a step of it, and how often there is a scan."""
_FIRST: Final = (0.02, 0.02, 0.01)
"""m, m, rad; deviations at the beginning."""
_TIMES: Final = 20.0
"""So many times larger than one deviation are ellipses drawn."""


@drawn
def picture_of_belief(home: Home) -> Figure:
    """Draw ellipses of the place along a hallway, and deviations over the way."""
    figure = empty_figure(1150, 560)
    alone, with_scans, over_way = figure.subplots(1, 3, width_ratios=[1.0, 1.0, 1.7])
    area = (_START[0] - 1.6, _START[1] - 0.8, _START[0] + 1.6, _START[1] + _WAY + 0.9)
    for axes, scans, name, colour in (
        (alone, False, "wheels alone", ORANGE),
        (with_scans, True, "with scans", BLUE),
    ):
        show_floor_plan(axes, home, area)
        ways, covariances = _along(home, scans)
        for number in range(0, len(ways), round(_EVERY / _STEP)):
            _draw_ellipse(axes, ways[number], covariances[number], colour)
        axes.set_title(f"{name}, {_TIMES:.0f} deviations")
        deviations = np.sqrt(covariances[:, [0, 1], [0, 1]])
        over_way.plot(ways, 1000.0 * deviations[:, 0], color=colour, label=f"{name}: across")
        over_way.plot(ways, 1000.0 * deviations[:, 1], color=colour, ls="--", label="along")
    over_way.set_yscale("log")
    over_way.set(xlabel="way, m", ylabel="standard deviation, mm")
    over_way.legend()
    return figure


def _along(home: Home, scans: bool) -> tuple[Floats, Floats]:
    """Return the ways [n], m, and the covariances [n, 3, 3] of a pose that is carried along."""
    config = SimulatedRobotConfig()
    numbers = numbers_of(config.localization, config.gyro)[0]
    pose, covariance = np.array([*_START, np.pi / 2.0]), np.diag(np.square(_FIRST))
    turn = numbers["wheel_variance"] * _STEP
    ways, covariances = [0.0], [covariance.copy()]
    for number in range(1, round(_WAY / _STEP) + 1):
        of_way, of_side = numbers["way_variance"] * _STEP, numbers["side_variance"] * _STEP
        carry(pose, covariance, _STEP, 0.0, 0.0, of_way, of_side, turn)
        if scans and number % round(_EVERY / _STEP) == 0:
            ends = ends_at(home, Pose(*pose.tolist()), seed=number)
            _, covariance = matched(home, ends, pose, covariance)
        ways.append(number * _STEP)
        covariances.append(covariance.copy())
    return np.array(ways), np.array(covariances)


def _draw_ellipse(axes: Axes, way: float, covariance: Floats, colour: str) -> None:
    variances, directions = np.linalg.eigh(covariance[:2, :2])
    width, height = 2.0 * _TIMES * np.sqrt(variances)
    angle = float(np.degrees(np.arctan2(directions[1, 0], directions[0, 0])))
    middle = (_START[0], _START[1] + way)
    axes.add_patch(Ellipse(middle, width, height, angle=angle, fill=False, edgecolor=colour))
