"""A run as a picture: the robot's map with its way and its errors, and the map by odometry."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from roomba.commands.map.map_error import wrong_sides
from roomba.commands.map.runs import Drawn, MapRun
from roomba.commands.output import clock
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, OccupancyMap
from roomba.plots.png import write_png
from roomba.plots.style import BLUE, GREEN, INK, PINK, RED, Area, drawn, empty_figure

_WIDTH: Final = 1200
_LEAST_HEIGHT, _MOST_HEIGHT = 330, 900
_REST: Final = 190
"""px; of titles, axes and legend."""
_MARGIN: Final = 0.3
"""m around what is known."""
_PAPER, _FLOOR, _WALL = 0.86, 1.0, 0.2


def write_plot(path: Path, run: MapRun) -> None:
    """Draw a run into a PNG file; raises OSError."""
    write_png(path, picture_of(run))


@drawn
def picture_of(run: MapRun) -> Figure:
    """Return the picture of a run: its map, and beside it the one by odometry alone."""
    maps = [run.made.occupancy, run.by_odometry.occupancy]
    area = area_of_maps(maps)
    figure = empty_figure(_WIDTH, height_for(area, 0.46 * _WIDTH) + _REST)
    ours, theirs = figure.subplots(1, 2, sharex=True, sharey=True)
    _draw(ours, run, run.made)
    draw_way(ours, run.record.poses[:, 1:3])
    for x, y in run.record.result.unseen:
        ours.plot(x, y, "o", mfc="none", mec=PINK, ms=9.0, mew=1.6, zorder=6)
    draw_station(ours, run.station)
    ours.set_title(f"its map: {_words(run.made)}")
    _draw(theirs, run, run.by_odometry)
    draw_station(theirs, run.home.station)
    theirs.set_title(f"by wheels and gyro alone: {_words(run.by_odometry)}")
    for axes in (ours, theirs):
        axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    result = run.record.result
    figure.suptitle(
        f"{run.home.name}, seed {run.trial.seed}: {result.outcome.name}, {result.known:.1f} m² in "
        f"{clock(result.duration)}, {result.distance:.0f} m",
        fontsize=12.5,
    )
    figure.legend(handles=_legend(), loc="outside lower center", ncols=5, fontsize=10.0)
    return figure


def area_of_maps(maps: list[OccupancyMap]) -> Area:
    """Return lowest x and y, highest x and y, m, of what is known on maps, with a margin."""
    corners = []
    for each in maps:
        rows, columns = np.nonzero(each.values != -1)
        frame = each.frame
        low = frame.centre_of(int(rows.min()), int(columns.min()))
        high = frame.centre_of(int(rows.max()), int(columns.max()))
        corners.append((*low, *high))
    x_min, y_min = (np.min(corners, axis=0)[:2] - _MARGIN).tolist()
    x_max, y_max = (np.max(corners, axis=0)[2:] + _MARGIN).tolist()
    return x_min, y_min, x_max, y_max


def height_for(area: Area, width: float) -> int:
    """Return how high a panel of a width is, px, that shows an area."""
    height = width * (area[3] - area[1]) / (area[2] - area[0])
    return round(min(max(height, _LEAST_HEIGHT), _MOST_HEIGHT))


def draw_map(axes: Axes, occupancy: OccupancyMap) -> None:
    """Draw a map: free floor white, walls dark, the unknown grey; axes in m, map frame."""
    picture = np.full((*occupancy.frame.shape, 3), _PAPER)
    picture[occupancy.values == FREE] = _FLOOR
    picture[occupancy.values == OCCUPIED] = _WALL
    axes.imshow(picture, origin="lower", extent=occupancy.frame.extent, interpolation="antialiased")
    axes.set_facecolor((_PAPER,) * 3)
    axes.grid(visible=False)
    axes.set_aspect("equal")
    axes.set(xlabel="x, m", ylabel="y, m")


def draw_way(axes: Axes, points: NDArray[np.float64]) -> None:
    """Draw a way, [n, 2], m."""
    axes.plot(points[:, 0], points[:, 1], color=BLUE, linewidth=0.9, zorder=4)


def draw_station(axes: Axes, station: Pose) -> None:
    """Draw where the robot docks."""
    axes.plot(station.x, station.y, "P", c="white", mec=INK, ms=12.0, mew=1.5, zorder=7)


def _draw(axes: Axes, run: MapRun, made: Drawn) -> None:
    """Draw a map with its errors: sides that are off, and true floor that is not free on it."""
    draw_map(axes, made.occupancy)
    frame = run.home.frame
    missed = np.zeros((*frame.shape, 4))
    missed[run.seen & ~_free_at(made.occupancy, run)] = (*to_rgb(GREEN), 0.55)
    axes.imshow(missed, origin="lower", extent=frame.extent, interpolation="nearest", zorder=2)
    wrong = wrong_sides(made.occupancy, frame, run.home.solid, run.seen)
    axes.plot(wrong[:, 0], wrong[:, 1], "s", c=RED, ms=1.8, mew=0.0, zorder=5)


def _free_at(occupancy: OccupancyMap, run: MapRun) -> NDArray[np.bool_]:
    """Return where a map is free at the middles of the home's cells, bool over its grid."""
    true, own = run.home.frame, occupancy.frame
    x, y = true.centres()
    rows, columns = own.cells_of(x, y)
    free = np.pad(occupancy.values == FREE, 1)
    inside = np.ix_(np.clip(rows + 1, 0, own.rows + 1), np.clip(columns + 1, 0, own.columns + 1))
    at: NDArray[np.bool_] = free[inside]
    return at


def _words(made: Drawn) -> str:
    error = made.error
    return (
        f"{100.0 * error.walls:.1f} % of walls within 5 cm,\nfloor IoU {error.floor:.3f}, "
        f"{error.doubled} cells twice, place off by {100.0 * made.largest:.1f} cm at most"
    )


def _legend() -> list[Any]:
    return [
        Line2D([], [], color=BLUE, label="true way"),
        Line2D([], [], ls="", marker="s", c=RED, ms=5.0, label="wall more than 5 cm off"),
        Patch(color=GREEN, alpha=0.55, label="floor not found free"),
        Line2D([], [], ls="", marker="o", mfc="none", mec=PINK, ms=9.0, label="given up"),
        Line2D([], [], ls="", marker="P", c="white", mec=INK, ms=11.0, label="station"),
    ]
