"""The lidar: noisy scans over the plan, and how far its ranges are off."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedLidar, SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import (
    BLUE,
    INK,
    RED,
    area_of,
    draw_robot,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home
from roomba.world.lidar import Lidar
from roomba.world.simulator import Simulator

_STAND = Pose(1.1, 1.4, 0.4)
"""A place in the flat from which doors and other rooms are seen."""
_SOLD = "neato"
_MOST_LINES = 20
"""Lost beams are drawn one by one, unless there are more than this."""
_BINS = np.arange(-20.0, 20.1, 1.0)
"""mm"""
_ABOVE = 1.3
"""The axis is higher than the data by this factor, so that the legend has room."""


@drawn
def picture_of_lidar(home: Home, stand: Pose = _STAND, scans: int = 100) -> Figure:
    """Draw one scan and one of a lidar as sold, and the errors of all ranges of so many scans."""
    config = SimulatedRobotConfig()
    world = Simulator(home, config, seed=1, start=stand)
    exact = Lidar.of(home, config.lidar).scan(np.array([[stand.x, stand.y, stand.theta]]))[0]
    measured = np.array([_next_scan(world) for _ in range(scans)])
    figure = empty_figure(1200, 400)
    plan, sold, errors = figure.subplots(1, 3, width_ratios=[1.25, 1.25, 1.0])
    for axes, title, scan in (
        (plan, "One scan", measured[0]),
        (sold, "One scan of a Neato's lidar", _scan_of(home, config.with_lidar(_SOLD), stand)),
    ):
        show_floor_plan(axes, home, area_of(home))
        _draw_scan(axes, stand, scan, exact)
        axes.set_title(title)
    _draw_errors(errors, measured, exact, config.simulation.lidar)
    return figure


def _scan_of(home: Home, config: SimulatedRobotConfig, stand: Pose) -> NDArray[np.float32]:
    world = Simulator(home, config, seed=1, start=stand)
    world.advance(Twist(), config.timing.world_step, 20)
    return world.ranges


def _next_scan(world: Simulator) -> NDArray[np.float32]:
    world.advance(Twist(), 1.0 / world.config.lidar.rate, 1)
    return world.ranges


def _draw_scan(
    axes: Axes, stand: Pose, measured: NDArray[np.float32], exact: NDArray[np.float32]
) -> None:
    angles = stand.theta + np.arange(len(measured)) * (2.0 * math.pi / len(measured))
    hit = np.isfinite(measured)
    lost = np.flatnonzero(~hit & np.isfinite(exact))
    axes.plot(
        stand.x + measured[hit] * np.cos(angles[hit]),
        stand.y + measured[hit] * np.sin(angles[hit]),
        ".",
        color=BLUE,
        markersize=4.0,
        label=f"{np.count_nonzero(hit)} ranges",
    )
    label = f"{len(lost)} beams lost"
    if len(lost) > _MOST_LINES:
        axes.plot([], [], "x", color=RED, label=label)
        lost = lost[:0]
    for number, beam in enumerate(lost):
        x = stand.x + exact[beam] * math.cos(angles[beam])
        y = stand.y + exact[beam] * math.sin(angles[beam])
        axes.plot(
            [stand.x, x],
            [stand.y, y],
            "--",
            color=RED,
            linewidth=1.2,
            marker="x",
            label=label if number == 0 else None,
            markevery=[1],
            markersize=7.0,
            markeredgewidth=2.0,
        )
    draw_robot(axes, stand)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=2, columnspacing=3.0)


def _draw_errors(
    axes: Axes, measured: NDArray[np.float32], exact: NDArray[np.float32], config: SimulatedLidar
) -> None:
    errors = 1000.0 * (measured - exact)[np.isfinite(measured) & np.isfinite(exact)]
    share = np.full(len(errors), 1.0 / len(errors))
    axes.hist(errors, bins=list(_BINS), weights=share, color=BLUE, alpha=0.55, label="measured")
    x = np.linspace(_BINS[0], _BINS[-1], 200)
    met = exact[np.isfinite(exact)]
    sigma = 1000.0 * (config.noise + config.noise_growth * met * met)
    normal = np.exp(-0.5 * (x[:, None] / sigma) ** 2) / (sigma * math.sqrt(2.0 * math.pi))
    axes.plot(x, normal.mean(axis=1), color=INK, label="normal, σ by the range,\nif met squarely")
    axes.set(xlabel="error of a range, mm", ylabel="share per mm")
    half, most = np.quantile(np.abs(errors), (0.5, 0.95))
    axes.set_title(f"{len(errors)} ranges: half within\n{half:.1f} mm, 95 % within {most:.0f} mm")
    axes.set_ylim(top=_ABOVE * axes.get_ylim()[1])
    axes.legend(loc="upper right")
