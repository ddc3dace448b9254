"""A mapped drive as a picture: its map, and beside it the one by odometry alone."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from matplotlib.figure import Figure

from roomba.commands.map.drive.mapped import MappedDrive
from roomba.commands.map.plot import (
    area_of_maps,
    draw_map,
    draw_station,
    draw_way,
    height_for,
)
from roomba.plots.png import write_png
from roomba.plots.style import drawn, empty_figure

_WIDTH: Final = 1200
_REST: Final = 130


def write_plot(path: Path, done: MappedDrive) -> None:
    """Draw a drive into a PNG file; raises OSError."""
    write_png(path, picture_of(done))


@drawn
def picture_of(done: MappedDrive) -> Figure:
    """Return the picture of a drive: its map, and beside it the one by odometry alone.

    Without odometry that is the map as if the robot always went on at its pace.
    """
    blind = done.replay.blind.occupancy()
    area = area_of_maps([done.occupancy, blind])
    figure = empty_figure(_WIDTH, height_for(area, 0.46 * _WIDTH) + _REST)
    ours, theirs = figure.subplots(1, 2, sharex=True, sharey=True)
    draw_map(ours, done.occupancy)
    draw_way(ours, done.replay.mapper.trajectory[:, :2])
    draw_station(ours, done.begin)
    ours.set_title("its map, the way, and where it began")
    draw_map(theirs, blind)
    draw_way(theirs, done.replay.by_odometry[:, 1:3])
    theirs.set_title(f"by {'odometry' if done.replay.has_odometry else 'its pace'} alone")
    for axes in (ours, theirs):
        axes.set(xlim=(area[0], area[2]), ylim=(area[1], area[3]))
    figure.suptitle(
        f"{done.name}: {done.replay.elapsed:.0f} s, {done.replay.way:.0f} m",
        fontsize=12.5,
    )
    return figure
