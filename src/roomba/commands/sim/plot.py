"""A run as a picture: the floor by how often it was swept, the path by its time, what is left."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from numpy.typing import NDArray

from roomba.commands.output import clock
from roomba.commands.sim.passes import passes_over
from roomba.commands.trials.figures import Figures
from roomba.commands.trials.runs import Run
from roomba.grid import FREE
from roomba.mission.cleaning.result import MissReason
from roomba.plots.png import write_png
from roomba.plots.style import INK, RED, drawn, empty_figure, show_floor_plan

_WIDTH: Final = 1200
_LEAST_HEIGHT, _MOST_HEIGHT = 420, 1400
_REST: Final = 170
"""px; of title, axes and legend."""
_MARGIN: Final = 0.3
"""m of map around the floor."""
_MOST_CELLS: Final = 30_000_000
"""Larger floors are drawn as swept or not: counting passes would take long."""
_SHOWN_CELLS: Final = 2400
"""Cells; more cells are drawn as swept or not, since to count passes would take long."""
_MOST_MARKS: Final = 12
SWEPT: Final = ("#D3E9DF", "#A5D0BF", "#6FB09A")
"""The colours of floor that was swept once, twice, and more often."""
MISSED: Final = "#F0A582"
_THING: Final = "#5B5F66"
_SHORT: Final = {
    MissReason.THING.value: "a thing",
    MissReason.SHUT.value: "no way",
    MissReason.STOPPED.value: "stopped",
    MissReason.LEFT_OVER.value: "left over",
    MissReason.EDGE.value: "an edge",
}


def write_plot(path: Path, run: Run) -> None:
    """Draw a run into a PNG file; raises OSError."""
    write_png(path, picture_of(run))


@drawn
def picture_of(run: Run) -> Figure:
    """Return the picture of a run."""
    area = _area(run)
    wide, high = area[2] - area[0], area[3] - area[1]
    height = min(max(0.88 * _WIDTH * high / wide, _LEAST_HEIGHT), _MOST_HEIGHT)
    figure = empty_figure(_WIDTH, round(height) + _REST)
    axes = figure.subplots()
    show_floor_plan(axes, run.home, area)
    _draw_floor(axes, run)
    path = _draw_path(axes, run)
    bar = figure.colorbar(path, ax=axes, fraction=0.03, pad=0.01, aspect=40)
    bar.set_label("robot time, min")
    bar.outline.set_visible(False)
    for x, y, radius in run.things:
        axes.add_patch(Circle((x, y), radius, facecolor=_THING, edgecolor="white", zorder=6))
    station = run.home.station
    axes.plot(station.x, station.y, "P", c="white", mec=INK, ms=13.0, mew=1.5, zorder=7)
    _draw_missed(axes, run)
    axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    figure.suptitle(title_of(run), fontsize=12.5)
    figure.legend(handles=_legend(run), loc="outside lower center", ncols=4, fontsize=10.5)
    return figure


def title_of(run: Run) -> str:
    """Return two lines with the figures."""
    figures = run.figures
    ratio = figures.path_ratio
    where = "docked" if figures.docked else "not docked"
    return (
        f"{run.home.name}, seed {run.trial.seed}: {figures.outcome}, {where}, "
        f"{100.0 * figures.fraction:.2f} % of {figures.coverable_m2:.1f} m², "
        f"{_count(figures)}\n"
        f"{figures.distance_m:.0f} m"
        + ("" if ratio is None else f" (path ratio {ratio:.2f})")
        + f", {figures.turning_rad:.0f} rad, {clock(figures.duration_s)}, "
        f"{figures.energy_wh:.1f} Wh, {figures.dirt_g:.0f} g of dirt"
    )


def _count(figures: Figures) -> str:
    return "1 hit" if figures.hits == 1 else f"{figures.hits} hits"


def _area(run: Run) -> tuple[float, float, float, float]:
    """Return lowest x and y, highest x and y, m, of the free floor with a margin."""
    frame = run.home.frame
    cells = np.argwhere(run.home.map.values == FREE)
    low, high = cells.min(axis=0), cells.max(axis=0)
    x_min, y_min = frame.centre_of(int(low[0]), int(low[1]))
    x_max, y_max = frame.centre_of(int(high[0]), int(high[1]))
    return x_min - _MARGIN, y_min - _MARGIN, x_max + _MARGIN, y_max + _MARGIN


def _draw_floor(axes: Axes, run: Run) -> None:
    """Tint what was swept, by how often, and what was not and could have been."""
    swept = run.truth.swept
    counts = swept.astype(np.uint8)
    if swept.size <= _MOST_CELLS:
        tool = run.figures.tool_width_m
        passes = passes_over(run.trajectory, run.truth.frame, tool)
        counts = np.where(swept, np.maximum(passes, 1), np.uint8(0))
    stride = max(1, math.ceil(max(swept.shape) / _SHOWN_CELLS))
    counts = counts[::stride, ::stride]
    missed = (run.coverable & ~swept)[::stride, ::stride]
    tint = np.zeros((*counts.shape, 4))
    for times, colour in enumerate(SWEPT, 1):
        tint[counts >= times] = to_rgba(colour, 0.88)
    tint[missed] = to_rgba(MISSED, 1.0)
    extent = run.truth.frame.extent
    axes.imshow(tint, origin="lower", extent=extent, interpolation="nearest", zorder=2)


def _draw_path(axes: Axes, run: Run) -> LineCollection:
    """Draw the path, coloured by its time."""
    points = run.trajectory[:, 1:3]
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    minutes = (run.trajectory[:-1, 0] - run.trajectory[0, 0]) / 60.0
    # from dark to middle tones: the bright end would vanish on the floor
    shades = colormaps["plasma"](np.linspace(0.0, 0.78, 256))
    path = LineCollection(
        list(_without_jumps(pieces)), cmap=ListedColormap(shades), linewidths=0.9, zorder=4
    )
    path.set_array(minutes)
    axes.add_collection(path)
    return path


def _without_jumps(pieces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return pieces of a path, those without any way included; a robot that is carried has none."""
    far = np.hypot(*(pieces[:, 1] - pieces[:, 0]).T) > 0.5
    pieces[far, 1] = pieces[far, 0]
    return pieces


def _draw_missed(axes: Axes, run: Run) -> None:
    for number, each in enumerate(run.figures.missed[:_MOST_MARKS]):
        size = 8.0 + 14.0 * math.sqrt(min(each.area_m2, 4.0))
        axes.plot(each.x, each.y, "o", mfc="none", mec=RED, ms=size, mew=1.8, zorder=8)
        axes.annotate(
            f"{each.area_m2:.2f} m²: {_SHORT.get(each.reason, each.reason)}",
            (each.x, each.y),
            xytext=(8.0, 10.0 if number % 2 else -16.0),
            textcoords="offset points",
            fontsize=9.5,
            color=RED,
            zorder=9,
            bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.0},
        )


def _legend(run: Run) -> list[Any]:
    marks: list[Any] = [
        Patch(color=colour, label=label)
        for colour, label in zip(
            (*SWEPT, MISSED), ("swept once", "twice", "more often", "missed"), strict=True
        )
    ]
    marks.append(Line2D([], [], ls="", marker="P", c="white", mec=INK, ms=11.0, label="station"))
    if run.things:
        marks.append(
            Line2D([], [], ls="", marker="o", c=_THING, ms=9.0, label="things not on the map")
        )
    if run.figures.missed:
        marks.append(
            Line2D([], [], ls="", marker="o", mfc="none", mec=RED, ms=9.0, label="left, and why")
        )
    return marks
