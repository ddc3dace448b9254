"""The charging station: what the robot's receiver sees of it, place by place."""

from __future__ import annotations

import cv2
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.plots.style import draw_robot, drawn, empty_figure, show_floor_plan
from roomba.world.engine.state.arrays import Infrared, code_of
from roomba.world.fleet import Fleet
from roomba.world.home.home import Home

_COLOURS = {
    Infrared.HALO: "#C9CCD1",
    Infrared.RED: "#F2B48C",
    Infrared.RED | Infrared.HALO: "#D55E00",
    Infrared.GREEN: "#8FD3BF",
    Infrared.GREEN | Infrared.HALO: "#009E73",
    Infrared.RED | Infrared.GREEN: "#A9A2D6",
    Infrared.RED | Infrared.GREEN | Infrared.HALO: "#5B4FB3",
}
_MARGIN = 0.25
"""m; shown around the reach of the beams."""


@drawn
def picture_of_station(home: Home, spacing: float = 0.01) -> Figure:
    """Draw which beams are received where the robot's middle can be, on a grid, m."""
    config = SimulatedRobotConfig()
    reach = config.station.beam + config.body.radius + _MARGIN
    x_min, x_max, y_min, y_max = home.frame.extent
    area = (
        max(x_min, home.station.x - reach),
        max(y_min, home.station.y - reach),
        min(x_max, home.station.x + reach),
        min(y_max, home.station.y + reach),
    )
    seen = _beams(home, config, np.arange(area[0], area[2], spacing), _rows(area, spacing))
    figure = empty_figure(820, 620)
    axes = figure.subplots()
    show_floor_plan(axes, home, area)
    kinds = list(_COLOURS)
    number = np.full(seen.shape, np.nan)
    for index, kind in enumerate(kinds):
        number[seen == int(kind)] = index
    axes.imshow(
        number,
        extent=(area[0], area[2], area[1], area[3]),
        origin="lower",
        interpolation="nearest",
        cmap=ListedColormap(list(_COLOURS.values())),
        vmin=-0.5,
        vmax=len(kinds) - 0.5,
        alpha=0.8,
    )
    axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    draw_robot(axes, home.station)
    axes.set_title("What the receiver sees, by where the robot's middle is")
    axes.legend(
        handles=[Patch(color=_COLOURS[kind], label=_label(kind)) for kind in kinds],
        title="/ir_omni",
        alignment="left",
        loc="upper left",
        bbox_to_anchor=(1.02, 1.0),
    )
    return figure


def _rows(area: tuple[float, float, float, float], spacing: float) -> NDArray[np.float64]:
    return np.arange(area[1], area[3], spacing)


def _label(kind: Infrared) -> str:
    names = [part.name.lower() for part in Infrared if part in kind and part.name]
    return f"{code_of(kind)}: {', '.join(reversed(names))}"


def _beams(
    home: Home,
    config: SimulatedRobotConfig,
    columns: NDArray[np.float64],
    rows: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Return the beams at each point where the body fits, int64 [rows, columns]; else 0."""
    fleet = Fleet([home], config, threads=1)
    room = cv2.distanceTransform((~home.solid).astype(np.uint8), cv2.DIST_L2, 5)
    fits = room * home.frame.resolution > config.body.radius
    still = np.zeros((1, 2))
    seen = np.zeros((len(rows), len(columns)), np.int64)
    for row, y in enumerate(rows):
        for column, x in enumerate(columns):
            cell = home.frame.cell_of(float(x), float(y))
            if home.frame.contains(float(x), float(y)) and fits[cell]:
                fleet.poses[0] = x, y, 0.0
                fleet.step(still, 1e-9)
                seen[row, column] = fleet.robots["beams"][0]
    return seen
