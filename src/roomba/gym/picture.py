"""A picture of a world for people: the plan with its dirt and its robot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.plots.home import draw_floor_plan
from roomba.world.fleet import Fleet

PIXELS_PER_METRE = 40.0


def picture_of(fleet: Fleet, world: int) -> NDArray[np.uint8]:
    """Return a world with one robot, seen from above, RGB uint8 [height, width, 3].

    Furniture that moves is drawn where it stands at first. A turned home is drawn in its own axes.
    """
    home, dirt = fleet.homes[world], fleet.dirt(world)
    rows, columns = home.frame.shape
    fineness = dirt.frame.rows // rows
    density = dirt.density.reshape(rows, fineness, columns, fineness).mean(axis=(1, 3))
    x, y, theta = fleet.poses[world].tolist()
    return draw_floor_plan(
        home,
        pixels_per_metre=PIXELS_PER_METRE,
        dirt=density,
        robot=Pose(x, y, theta),
        labels=False,
    )
