"""The folders of the sources in layers, drawn from their imports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from roomba.commands.pictures.import_graph import (
    PACKAGES,
    folders_in,
    imports_in,
    layers_of,
    reduced,
)
from roomba.errors import RoombaError
from roomba.plots.style import BLUE, GREEN, GREY, INK, ORANGE, PINK, RED, drawn, empty_figure
from roomba.world.home.home import Home

_WIDTH, _HEIGHT = 1200, 1000
"""px; of the picture, and of its coordinates, y up."""
_BOX: Final = (92.0, 30.0)
"""px; width and height of a folder's box."""
_LEGEND: Final = (42.0, 4)
"""px; height of the legend above the folders, and its columns."""
_LONG: Final = 12
"""Letters; longer names are written smaller, so that they stay in their boxes."""
_SWEEPS: Final = 24
"""How often the order in the layers is improved, up and down in turn."""

_COLOURS: Final = {
    "the ROS layer": (INK, ("roomba_ros",)),
    "commands, plots, gym": (GREY, ("roomba.commands", "roomba.plots", "roomba.gym")),
    "user interfaces": (ORANGE, ("roomba.ui", "roomba.client")),
    "mission and control": (RED, ("roomba.mission", "roomba.control")),
    "planning": (PINK, ("roomba.planning",)),
    "perception and what is kept": (BLUE, ("roomba.perception", "roomba.storage")),
    "the simulated world": (GREEN, ("roomba.world", "roomba.headless")),
    "what all share": ("#56B4E9", ("roomba",)),
}
"""By what the legend says: a colour and the folders that have it, the first that fits."""

_Places = dict[str, tuple[float, float]]


class ImportsUnreadableError(RoombaError):
    """The imports of the sources cannot be read; says what to install."""


@drawn
def picture_of_layers(home: Home) -> Figure:
    """Draw every folder above all that it imports; the home has no part in it.

    Raises ImportsUnreadableError without grimp, which the tests bring.
    """
    imports = _imports_by_folder()
    arrows = reduced(imports)
    places = _places(_ordered(layers_of(imports), arrows))
    figure = empty_figure(_WIDTH, _HEIGHT)
    figure.set_layout_engine("none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, _WIDTH), ylim=(0.0, _HEIGHT))
    axes.set_axis_off()
    for folder, below in sorted(arrows.items()):
        for other in sorted(below):
            _draw_arrow(axes, places[folder], places[other], _colour_of(folder))
    for folder, place in places.items():
        _draw_folder(axes, folder, place)
    _draw_legend(axes)
    return figure


def _imports_by_folder() -> dict[str, set[str]]:
    try:
        import grimp
    except ImportError as error:
        raise ImportsUnreadableError(
            "expected grimp, which reads imports, got none; install requirements-dev.txt "
            "(`./roomba test lint` does) to draw the picture layers"
        ) from error
    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    found: dict[str, set[str]] = {folder: set() for folder in folders_in(graph)}
    for each in imports_in(graph):
        found[each.from_folder].add(each.to_folder)
    # A folder of folders alone is no layer.
    imported = set().union(*found.values())
    return {folder: below for folder, below in found.items() if below or folder in imported}


def _ordered(layers: list[list[str]], arrows: Mapping[str, set[str]]) -> list[list[str]]:
    """Return the layers, each sorted so that folders lie near the folders they are joined to."""
    joined: dict[str, set[str]] = {folder: set(below) for folder, below in arrows.items()}
    for folder, below in arrows.items():
        for other in below:
            joined[other].add(folder)
    result = [sorted(layer, key=_part_of) for layer in layers]
    for sweep in range(_SWEEPS):
        for layer in result if sweep % 2 else reversed(result):
            places = _places(result)
            layer.sort(key=lambda folder: _mean_x(places, joined[folder], places[folder][0]))
    return result


def _mean_x(places: _Places, folders: set[str], otherwise: float) -> float:
    across = [places[folder][0] for folder in sorted(folders)]
    return sum(across) / len(across) if across else otherwise


def _places(layers: Sequence[Sequence[str]]) -> _Places:
    """Return the middle of each folder's box, px; each layer fills the picture's width."""
    rise = (_HEIGHT - _LEGEND[0] - 1.0 * _BOX[1]) / len(layers)
    return {
        folder: (_WIDTH * (index + 0.5) / len(layer), 0.9 * _BOX[1] + rise * height)
        for height, layer in enumerate(layers)
        for index, folder in enumerate(layer)
    }


def _part_of(folder: str) -> int:
    parts = [prefixes for _, prefixes in _COLOURS.values()]
    return next(
        index
        for index, prefixes in enumerate(parts)
        if any(folder == prefix or folder.startswith(f"{prefix}.") for prefix in prefixes)
    )


def _colour_of(folder: str) -> str:
    return list(_COLOURS.values())[_part_of(folder)][0]


def _draw_arrow(
    axes: Axes, above: tuple[float, float], below: tuple[float, float], colour: str
) -> None:
    half = _BOX[1] / 2.0
    axes.add_patch(
        FancyArrowPatch(
            (above[0], above[1] - half),
            (below[0], below[1] + half),
            arrowstyle="-|>",
            mutation_scale=7.0,
            shrinkA=0.0,
            shrinkB=0.0,
            linewidth=0.9,
            color=colour,
            alpha=0.55,
        )
    )


def _draw_folder(axes: Axes, folder: str, place: tuple[float, float]) -> None:
    width, height = _BOX
    x, y = place
    colour = _colour_of(folder)
    axes.add_patch(
        FancyBboxPatch(
            (x - width / 2.0, y - height / 2.0),
            width,
            height,
            boxstyle="round,pad=0,rounding_size=5",
            facecolor="white",
            edgecolor=colour,
            linewidth=1.4,
            zorder=3,
        )
    )
    *parents, name = folder.split(".")
    text: dict[str, Any] = {"ha": "center", "va": "center", "zorder": 4}
    axes.text(x, y + 7.0, "/".join(parents).removeprefix("roomba/"), fontsize=6.0, **text)
    size = 8.5 if len(name) <= _LONG else 7.5
    axes.text(x, y - 5.0, name, fontsize=size, color=colour, fontweight="bold", **text)


def _draw_legend(axes: Axes) -> None:
    for index, (name, (colour, _)) in enumerate(_COLOURS.items()):
        row, column = divmod(index, _LEGEND[1])
        x, y = 14.0 + column * _WIDTH / _LEGEND[1], _HEIGHT - 17.0 - 17.0 * row
        axes.text(x, y, name, fontsize=8.5, color=colour)
