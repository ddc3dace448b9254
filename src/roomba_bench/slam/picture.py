"""The map of a recorded drive as a small PNG, with the way on it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from matplotlib.figure import Figure
from PIL import Image

from roomba.commands.map.plot import area_of_maps, draw_map, draw_station, draw_way
from roomba.plots.style import drawn, empty_figure
from roomba_bench.slam.run import Judged

_LARGEST: Final = 830
"""px; the longer side of the map."""
_LEAST_WIDTH: Final = 340
"""px; the title is as wide."""
_REST: Final = 90
"""px; of the title and the axes."""
_COLOURS: Final = 32
"""Of walls, floor and lines with their edges: a third of the bytes of all colours."""


def write_picture(path: Path, judged: Judged) -> None:
    """Write the picture; raises OSError."""
    Image.fromarray(picture_of(judged)).quantize(_COLOURS).save(path, optimize=True)


@drawn
def picture_of(judged: Judged) -> Figure:
    """Return the picture of a drive: its map, the way, and where it began."""
    drive = judged.drive
    area = area_of_maps([drive.occupancy])
    wide, high = area[2] - area[0], area[3] - area[1]
    scale = _LARGEST / max(wide, high)
    width = max(round(scale * wide), _LEAST_WIDTH)
    figure = empty_figure(width + _REST, round(scale * high) + _REST)
    axes = figure.subplots()
    draw_map(axes, drive.occupancy)
    draw_way(axes, drive.replay.mapper.trajectory[:, :2])
    draw_station(axes, drive.begin)
    axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    axes.set_title(f"{judged.name}: {drive.replay.elapsed:.0f} s, {drive.replay.way:.0f} m")
    return figure
