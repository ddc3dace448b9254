"""A mirror: what a scan shows behind it, turned over, and how its plane is told from others."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from roomba.commands.pictures.teaching.matching import ends_at
from roomba.geometry import Pose
from roomba.perception.slam.mirrors.images import Beams, MappedFloor, Plane, images, own_images
from roomba.plots.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    RED,
    draw_robot,
    drawn,
    empty_figure,
    show_floor_plan,
)
from roomba.world.home.home import Home

_AT: Final = Pose(2.1, -0.9, 0.0)
_MIRROR: Final = Plane(2.1, -1.575, -math.pi / 2.0)
"""That on the loft's southern wall, where it is nearest to the robot."""
_AREA: Final = (-0.7, -9.0, 7.0, 3.7)
_TURNS: Final = np.radians(np.arange(-40.0, 40.01, 0.5))


@drawn
def picture_of_a_mirror(home: Home) -> Figure:
    """Draw the scan of a robot before a mirror, and how well images fit by the plane's turn."""
    ends = ends_at(home, _AT)
    places = _AT.transform(ends[:, :2])
    here = np.tile((_AT.x, _AT.y), (len(places), 1))
    beams, floor = Beams(here, places, np.zeros_like(places)), MappedFloor.of(home.map)
    behind = (places - _MIRROR.middle) @ _MIRROR.normal > 0.05
    own = own_images(beams, _MIRROR)
    turned_over = _MIRROR.turned_over(places)
    figure = empty_figure(1150, 640)
    plan, fits = figure.subplots(1, 2, width_ratios=[1.0, 1.1])
    show_floor_plan(plan, home, _AREA)
    for what, which, points, colour in (
        ("what beams met", ~behind, places, BLUE),
        ("what the mirror shows", behind & ~own, places, RED),
        ("the same, turned over", behind & ~own, turned_over, GREEN),
        ("the robot itself", own, places, ORANGE),
    ):
        plan.scatter(*points[which].T, s=9, color=colour, label=what, zorder=4)
    draw_robot(plan, _AT, INK)
    plan.set(xlim=_AREA[::2], ylim=_AREA[1::2], xlabel="x, m", ylabel="y, m")
    plan.legend(loc="lower right", frameon=True)
    seen = [images(beams, _MIRROR.moved(turn, 0.0), floor) for turn in _TURNS]
    turns = np.degrees(_TURNS)
    fits.plot(turns, [each.fits.sum() for each in seen], color=GREEN, label="they fit")
    against = [each.contradicts.sum() for each in seen]
    fits.plot(turns, against, color=RED, label="they contradict: the floor is free there")
    fits.set_title("Images, by how the plane is turned about the touched point")
    fits.set(xlabel="degrees", ylabel="beams")
    fits.legend()
    return figure
