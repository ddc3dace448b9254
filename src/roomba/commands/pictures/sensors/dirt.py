"""Brushes, dirt sensor, brush current and bin: along the hallway, over crumbs and a carpet."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from numpy.typing import NDArray

from roomba.commands.pictures.sensors.drives import DriveRecording
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.plots.style import BLUE, INK, drawn, empty_figure, stacked
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

_START = Pose(5.25, 0.6, 0.5 * np.pi)
_WAY = 3.0
"""m, to the north."""
_HALF_WIDTH = 0.4
"""m; of the strip of floor that is shown."""
_SPILLS = ((5.25, 1.05, 0.06, 0.1), (5.25, 2.0, 0.06, 0.1), (5.25, 2.8, 0.06, 1.0))
"""x, y, radius, m, and g: the same on stone and carpet, and more than the sensor can count."""
_SPEED = 0.2
"""m/s"""
_MOST_SHOWN = 10.0
"""g/m²"""


@drawn
def picture_of_dirt(home: Home, way: float = _WAY) -> Figure:
    """Draw the floor before and after one pass, and what the sensors tell on the way."""
    world = Simulator(home, SimulatedRobotConfig(), start=_START)
    for spill in _SPILLS:
        world.spill(*spill)
    before = _strip(world.dirt, way)
    recording = DriveRecording(
        world, {"dirt_under": lambda simulator: simulator.observe().dirt_under}
    )
    recording.drive(Twist(_SPEED, 0.0), way / _SPEED)
    figure = empty_figure(1000, 900)
    panels = stacked(figure, 6, [0.9, 0.9, 1.0, 1.0, 1.0, 1.0])
    for axes, density, title in (
        (panels[0], before, "Dirt on the floor before"),
        (panels[1], _strip(world.dirt, way), "and after one pass"),
    ):
        image = _show_strip(axes, density, way)
        axes.set_title(title)
    figure.colorbar(image, ax=panels[:2], label="g/m²", extend="max", pad=0.01)
    at = recording.of("y") - _START.y
    for axes, name, factor, label in (
        (panels[2], "dirt_under", 1.0, "g under the body"),
        (panels[3], "grains", 1.0, "grains/s"),
        (panels[4], "brush_current", 1.0, "brush, A"),
        (panels[5], "in_bin", 1e-6, "g in the bin"),
    ):
        axes.plot(at, factor * recording.of(name), color=BLUE, linewidth=1.0)
        axes.set(ylabel=label, ylim=(0.0, None))
    carpet = next(carpet.area for carpet in home.carpets if carpet.name == "hallway runner")
    for axes in panels[2:]:
        axes.axvspan(carpet.y_min - _START.y, way, color=INK, alpha=0.07, linewidth=0.0)
    panels[4].annotate("carpet", (carpet.y_min - _START.y + 0.03, 0.05), fontsize=9.0)
    panels[5].set(xlabel="way to the north, m", xlim=(0.0, way))
    return figure


def _strip(dirt: DirtField, way: float) -> NDArray[np.float32]:
    """Return g/m² along the way, float32 [across, along], west on top."""
    low_row, low_column = dirt.frame.cell_of(_START.x - _HALF_WIDTH, _START.y)
    high_row, high_column = dirt.frame.cell_of(_START.x + _HALF_WIDTH, _START.y + way)
    return dirt.density[low_row : high_row + 1, low_column : high_column + 1].T.copy()


def _show_strip(axes: Axes, density: NDArray[np.float32], way: float) -> AxesImage:
    axes.grid(visible=False)
    axes.set(ylabel="m", yticks=[-0.4, 0.0, 0.4])
    return axes.imshow(
        density,
        extent=(0.0, way, -_HALF_WIDTH, _HALF_WIDTH),
        aspect="auto",
        cmap="YlOrBr",
        vmin=0.0,
        vmax=_MOST_SHOWN,
    )
