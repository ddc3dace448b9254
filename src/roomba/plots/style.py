"""The style of all plots: quiet, in colours for all kinds of colour vision, with floor plans below.

The colours are those of Okabe and Ito, "Color universal design" (2008).
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, Final, ParamSpec

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from roomba.configuration.body import BodyConfig
from roomba.geometry import Pose
from roomba.plots.canvas import Canvas, Picture
from roomba.plots.floor import draw_carpets, draw_floor
from roomba.plots.furniture import draw_furniture, draw_shadows
from roomba.plots.walls import draw_openings, draw_stairs, draw_station, draw_walls
from roomba.world.home.home import Home

BLUE: Final = "#0072B2"
ORANGE: Final = "#E69F00"
GREEN: Final = "#009E73"
RED: Final = "#D55E00"
PINK: Final = "#CC79A7"
GREY: Final = "#8A8F98"
INK: Final = "#3A3D42"

Area = tuple[float, float, float, float]
"""x_min, y_min, x_max, y_max, m, map frame."""

_DOTS_PER_INCH = 100
PLAN_PIXELS = 620.0
"""px; the longer side of a plan under a plot: a little more than is shown."""
_PAPER = (255, 255, 255)
_PLAN_STRENGTH = 0.55
"""0..1; the rest of a plan's colours is white, so that what is drawn over it stands out."""
_STYLE: Final[dict[str, Any]] = {
    "figure.dpi": _DOTS_PER_INCH,
    "figure.facecolor": "white",
    "font.size": 10.0,
    "axes.titlesize": 10.5,
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E4E6E9",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 9.0,
    "ytick.labelsize": 9.0,
}

_Arguments = ParamSpec("_Arguments")


def drawn(function: Callable[_Arguments, Figure]) -> Callable[_Arguments, Picture]:
    """Make a function that draws a figure return its pixels, RGB uint8 [height, width, 3]."""

    @functools.wraps(function)
    def picture(*arguments: _Arguments.args, **named: _Arguments.kwargs) -> Picture:
        with matplotlib.style.context(["default", _STYLE]):
            canvas: Any = FigureCanvasAgg(function(*arguments, **named))
            canvas.draw()
        return np.asarray(canvas.buffer_rgba(), np.uint8)[:, :, :3].copy()

    return picture


def empty_figure(width: int, height: int) -> Figure:
    """Return an empty figure of so many pixels."""
    size = (width / _DOTS_PER_INCH, height / _DOTS_PER_INCH)
    return Figure(figsize=size, layout="constrained")


def side_by_side(figure: Figure, widths: list[float]) -> list[Any]:
    """Return parts of a figure, to be filled with panels of their own, left to right."""
    parts: Any = figure.subfigures(1, len(widths), width_ratios=widths)
    return list(parts)


def stacked(figure: Any, panels: int, heights: list[float] | None = None) -> list[Axes]:
    """Return panels one below the other, of a figure or a part of one, over the same axis."""
    axes = figure.subplots(panels, 1, sharex=True, squeeze=False, height_ratios=heights)
    return list(axes[:, 0])


def show_floor_plan(axes: Axes, home: Home, area: Area) -> None:
    """Lay a pale plan of a part of a home under what is drawn; the axes are in m, map frame."""
    x_min, y_min, x_max, y_max = area
    canvas = Canvas.over(area, PLAN_PIXELS / max(x_max - x_min, y_max - y_min), _PAPER)
    draw_floor(canvas, home)
    draw_carpets(canvas, home)
    draw_stairs(canvas, home)
    draw_shadows(canvas, home)
    draw_furniture(canvas, home)
    draw_walls(canvas, home)
    draw_openings(canvas, home)
    draw_station(canvas, home)
    pale = 255.0 + _PLAN_STRENGTH * (canvas.finished() - 255.0)
    axes.imshow(pale.astype(np.uint8), extent=(x_min, x_max, y_min, y_max), zorder=0)
    axes.grid(visible=False)
    axes.set_aspect("equal")
    axes.set(xlim=(x_min, x_max), ylim=(y_min, y_max), xlabel="x, m", ylabel="y, m")


def area_of(home: Home) -> Area:
    """Return the area of a home's whole grid."""
    x_min, x_max, y_min, y_max = home.frame.extent
    return x_min, y_min, x_max, y_max


def draw_robot(axes: Axes, pose: Pose, colour: str = INK) -> None:
    """Draw the robot's disc, and a line from its middle to its front."""
    radius = BodyConfig().radius
    axes.add_patch(
        Circle(
            (pose.x, pose.y),
            radius,
            facecolor=(1.0, 1.0, 1.0, 0.75),
            edgecolor=colour,
            linewidth=1.5,
        )
    )
    front = pose.compose(Pose(radius, 0.0, 0.0))
    axes.plot([pose.x, front.x], [pose.y, front.y], color=colour, linewidth=1.5)


def draw_signals(
    axes: Axes, times: NDArray[np.float64], signals: dict[str, NDArray[np.float64]]
) -> None:
    """Draw signals that are on or off as bars, the first one on top."""
    names = list(signals)
    for row, name in enumerate(reversed(names)):
        on = signals[name] > 0.0
        axes.fill_between(times, row - 0.36, row + 0.36, where=list(on), color=BLUE, step="post")
    axes.set_yticks(range(len(names)), list(reversed(names)))
    axes.set_ylim(-0.6, len(names) - 0.4)
    axes.grid(visible=False, axis="y")
