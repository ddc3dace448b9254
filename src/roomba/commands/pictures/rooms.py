"""Rooms: a furnished map cut at its doorways."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from roomba.grid import FREE
from roomba.perception.rooms.rooms import segment
from roomba.plots.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    PINK,
    RED,
    area_of,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home

_COLOURS = np.array([to_rgb(colour) for colour in (BLUE, ORANGE, GREEN, PINK, RED, "#56B4E9")])


@drawn
def picture_of_rooms(home: Home) -> Figure:
    """Draw a home's plan, and the rooms that are found in its map."""
    figure = empty_figure(1150, 520)
    plan, cut = figure.subplots(1, 2)
    show_floor_plan(plan, home, area_of(home))
    plan.set_title(f"The home: {len(home.rooms)} rooms")
    _draw_rooms(cut, home)
    return figure


def _draw_rooms(axes: Axes, home: Home) -> None:
    rooms = segment(home.map)
    picture = np.full((*home.frame.shape, 3), 0.25)
    picture[home.map.values == FREE] = 0.93
    inside = rooms.labels > 0
    colours = _COLOURS[(rooms.labels[inside] - 1) % len(_COLOURS)]
    picture[inside] = 0.45 + 0.55 * colours
    x_min, y_min, x_max, y_max = area_of(home)
    axes.imshow(picture, origin="lower", extent=(x_min, x_max, y_min, y_max))
    for label, name in enumerate(rooms.names, 1):
        text = f"{name}\n{rooms.area(label):.1f} m²"
        axes.text(*rooms.anchor(label), text, ha="center", va="center", color=INK, fontsize=9.0)
    axes.grid(visible=False)
    axes.set(xlabel="x, m", ylabel="y, m")
    axes.set_title(f"Its map, cut at the doorways: {len(rooms.names)} rooms")
