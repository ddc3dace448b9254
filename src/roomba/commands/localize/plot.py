"""A recorded drive as a picture: the path on its map, and how well it was known over time."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from roomba.commands.localize.replay import Row
from roomba.commands.localize.tally import Loss
from roomba.grid import FREE, UNKNOWN, OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba.plots.png import write_png
from roomba.plots.style import BLUE, INK, ORANGE, PINK, RED, drawn, empty_figure

COLOURS: Final = {
    Knowledge.KNOWN: BLUE,
    Knowledge.ROUGH: ORANGE,
    Knowledge.SEARCHING: PINK,
    Knowledge.LOST: RED,
}
_WIDTH, _LEAST_HEIGHT, _MOST_HEIGHT = 900, 300, 850
_PANELS_HEIGHT, _REST_HEIGHT = 300, 90
"""px; of the figure, of the plan, of the panels under it, and of title and legend."""
_MARGIN: Final = 0.3
"""m of map around what is shown."""
_FASTEST: Final = 2.0
"""m/s; a pose that goes on faster has jumped."""
_LEAST_DEVIATION: Final = 1e-3
"""m; less is drawn as this on the logarithmic scale."""


def write_plot(
    path: Path, occupancy: OccupancyMap, rows: Sequence[Row], losses: Sequence[Loss], title: str
) -> None:
    """Draw a drive into a PNG file; raises OSError."""
    write_png(path, _picture(occupancy, rows, losses, title))


@drawn
def _picture(
    occupancy: OccupancyMap, rows: Sequence[Row], losses: Sequence[Loss], title: str
) -> Figure:
    area = _area(occupancy, rows)
    height = _WIDTH * (area[3] - area[2]) / (area[1] - area[0])
    height = min(max(height, _LEAST_HEIGHT), _MOST_HEIGHT)
    figure = empty_figure(_WIDTH, round(height + _PANELS_HEIGHT + _REST_HEIGHT))
    heights = [height + _REST_HEIGHT, 0.5 * _PANELS_HEIGHT, 0.5 * _PANELS_HEIGHT]
    plan, deviation, agreement = figure.subplots(3, 1, height_ratios=heights)
    deviation.sharex(agreement)
    _draw_plan(plan, occupancy, rows, losses, area)
    figure.suptitle(title, fontsize=10.5)
    _draw_deviation(deviation, rows)
    _draw_agreement(agreement, rows)
    return figure


def _area(occupancy: OccupancyMap, rows: Sequence[Row]) -> tuple[float, float, float, float]:
    """Return lowest and highest x, lowest and highest y, m, of the floor and the path."""
    frame = occupancy.frame
    x_min, x_max, y_min, y_max = frame.extent
    known = np.argwhere(occupancy.values == FREE)
    if len(known):
        (low_row, low_column), (high_row, high_column) = known.min(axis=0), known.max(axis=0)
        x_min, y_min = frame.centre_of(int(low_row), int(low_column))
        x_max, y_max = frame.centre_of(int(high_row), int(high_column))
    poses = [row.estimate.pose for row in rows if row.estimate.knowledge.is_usable]
    xs = [x_min, x_max, *(pose.x for pose in poses)]
    ys = [y_min, y_max, *(pose.y for pose in poses)]
    return min(xs) - _MARGIN, max(xs) + _MARGIN, min(ys) - _MARGIN, max(ys) + _MARGIN


def _draw_plan(
    axes: Axes,
    occupancy: OccupancyMap,
    rows: Sequence[Row],
    losses: Sequence[Loss],
    area: tuple[float, float, float, float],
) -> None:
    shades = np.full(occupancy.values.shape, 110, np.uint8)
    shades[occupancy.values == FREE] = 255
    shades[occupancy.values == UNKNOWN] = 226
    axes.imshow(
        shades,
        cmap="gray",
        vmin=0,
        vmax=255,
        origin="lower",
        extent=occupancy.frame.extent,
        interpolation="nearest",
    )
    axes.add_collection(_path(rows))
    for row, marker, colour in ((rows[0], "o", "white"), (rows[-1], "s", INK)):
        pose = row.estimate.pose
        axes.plot(pose.x, pose.y, marker, mfc=colour, mec=INK, ms=7.0, zorder=5)
    axes.plot(
        [loss.x for loss in losses],
        [loss.y for loss in losses],
        "x",
        c=RED,
        ms=9.0,
        mew=2.2,
        zorder=6,
    )
    axes.grid(visible=False)
    axes.set_aspect("equal")
    axes.set(xlim=area[:2], ylim=area[2:], xlabel="x, m", ylabel="y, m")
    marks = [
        Line2D([], [], color=colour, lw=2.4, label=knowledge.value)
        for knowledge, colour in COLOURS.items()
        if any(row.estimate.knowledge is knowledge for row in rows)
    ]
    marks.append(Line2D([], [], ls="", marker="o", mfc="white", mec=INK, label="start"))
    marks.append(Line2D([], [], ls="", marker="s", mfc=INK, mec=INK, label="end"))
    if losses:
        marks.append(Line2D([], [], ls="", marker="x", c=RED, mew=2.2, label="place lost"))
    axes.legend(handles=marks, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(marks))


def _path(rows: Sequence[Row]) -> LineCollection:
    """Return the path in pieces of one colour; where the pose jumps there is none."""
    pieces, colours = [], []
    for one, other in itertools.pairwise(rows):
        start, end = one.estimate.pose, other.estimate.pose
        way = start.distance_to(end.x, end.y)
        if way > 0.1 + _FASTEST * (other.elapsed - one.elapsed):
            continue
        pieces.append(((start.x, start.y), (end.x, end.y)))
        colours.append(COLOURS[other.estimate.knowledge])
    return LineCollection(pieces, colors=colours, linewidths=2.0, capstyle="round", zorder=4)


def _draw_deviation(axes: Axes, rows: Sequence[Row]) -> None:
    deviations = np.array([row.estimate.position_deviation for row in rows])
    axes.set_yscale("log")
    axes.plot(_times(rows), np.maximum(deviations, _LEAST_DEVIATION), color=INK)
    axes.set_ylabel("deviation, m")
    axes.tick_params(labelbottom=False)
    _shade(axes, rows)


def _draw_agreement(axes: Axes, rows: Sequence[Row]) -> None:
    axes.plot(_times(rows), [row.estimate.agreement for row in rows], color=INK)
    axes.set(ylim=(0.0, 1.03), ylabel="beams that agree", xlabel="time, s")
    _shade(axes, rows)


def _shade(axes: Axes, rows: Sequence[Row]) -> None:
    """Colour the times when the place was not known."""
    times = _times(rows)
    axes.set_xlim(0.0, max(float(times[-1]), 1e-3))
    for knowledge, colour in COLOURS.items():
        is_so = np.array([row.estimate.knowledge is knowledge for row in rows])
        if knowledge is Knowledge.KNOWN or not is_so.any():
            continue
        axes.fill_between(
            times,
            0.0,
            1.0,
            where=list(is_so),
            transform=axes.get_xaxis_transform(),
            color=colour,
            alpha=0.22,
            lw=0.0,
            step="post",
        )


def _times(rows: Sequence[Row]) -> NDArray[np.float64]:
    return np.array([row.elapsed for row in rows])
