"""The shortest path over a map's cells, and what string pulling makes of it."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from roomba.arrays import Floats
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Point
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.joining import join_goal
from roomba.planning.path.search.any_angle import AnyAngleSearch, FreeSpace
from roomba.planning.path.string_pulling import StringPulling
from roomba.plots.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    Area,
    area_of,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home

_FROM: Final = (8.06, 1.52)
_TO: Final = (3.71, 6.18)
"""m."""
_NEAR: Final[Area] = (7.0, 3.95, 8.1, 5.05)
"""What is shown larger."""
_ON_ARC: Final = 1e-6
"""m; points as near as this to an arc are its own."""


@drawn
def picture_of_paths(home: Home) -> Figure:
    """Draw both paths through a home, and beside it the cells and the corners that they pass."""
    config = RobotConfig()
    fit = FitMap.build(home.map, config.body.radius, config.walk.clearance)
    string = StringPulling(fit)
    over_cells = path_over_cells(fit, _FROM, _TO)
    pulled = string.pulled(over_cells)
    figure = empty_figure(1150, 580)
    whole, near = figure.subplots(1, 2)
    show_floor_plan(whole, home, area_of(home))
    _show_cells(near, fit)
    for axes in (whole, near):
        axes.plot(*over_cells.T, "o-", color=ORANGE, ms=4, lw=1.4, label="over the cells")
        axes.plot(*pulled.T, color=BLUE, lw=2.0, label="pulled taut")
    lengths = [float(np.hypot(*np.diff(way, axis=0).T).sum()) for way in (over_cells, pulled)]
    whole.set_title(f"{lengths[0]:.2f} m over the cells, {lengths[1]:.2f} m pulled taut")
    whole.legend(loc="lower left")
    near.set_title("Around a corner: centres that fit, and the room that is kept")
    for corner in _corners(fit):
        if abs(np.hypot(*(pulled - corner).T) - string.room).min() < _ON_ARC:
            near.add_patch(Circle(corner, string.room, fill=False, color=GREEN, lw=1.2))
    return figure


def path_over_cells(fit: FitMap, start: Point, goal: Point) -> Floats:
    """Return the shortest path over the cells that fit, float64 [n, 2], m.

    Raises ValueError when there is none.
    """
    frame = fit.map.frame
    ends = [
        (
            (x - frame.origin_x) / frame.resolution - 0.5,
            (y - frame.origin_y) / frame.resolution - 0.5,
        )
        for x, y in (start, goal)
    ]
    joints = [join_goal(fit, end) for end in (start, goal)]
    if joints[0] is None or joints[1] is None:
        raise ValueError(f"expected ends at which the body fits, got {start} and {goal}")
    bends = AnyAngleSearch(frame.shape).shortest_path(
        FreeSpace.of(fit.fits), ends[0], joints[0], ends[1], joints[1]
    )
    if bends is None:
        raise ValueError(f"expected a way from {start} to {goal}, and there is none")
    return np.vstack((start, np.column_stack(frame.centres(bends[:, 1], bends[:, 0])), goal))


def _show_cells(axes: Axes, fit: FitMap) -> None:
    """Draw the solid cells of the map near a corner, and the centres of those that fit."""
    frame = fit.map.frame
    left, bottom, right, top = _NEAR
    sides = (frame.origin_x, frame.origin_y)
    ends = (
        sides[0] + frame.columns * frame.resolution,
        sides[1] + frame.rows * frame.resolution,
    )
    axes.imshow(
        fit.map.solid,
        extent=(sides[0], ends[0], sides[1], ends[1]),
        origin="lower",
        cmap=ListedColormap(["white", INK]),
        interpolation="nearest",
    )
    x, y = frame.centres(*np.nonzero(fit.fits))
    shown = (x > left) & (x < right) & (y > bottom) & (y < top)
    axes.plot(x[shown], y[shown], ".", color=GREY, ms=3)
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel="x, m", ylabel="y, m")
    axes.grid(visible=False)


def _corners(fit: FitMap) -> Floats:
    """Return the corners of the map's cells that are solid, float64 [n, 2], m."""
    rows, columns = np.nonzero(fit.map.solid)
    x, y = fit.map.frame.centres(rows, columns)
    half = 0.5 * fit.map.frame.resolution
    corners: Floats = np.concatenate(
        [np.column_stack((x + dx, y + dy)) for dx in (-half, half) for dy in (-half, half)]
    )
    return corners
