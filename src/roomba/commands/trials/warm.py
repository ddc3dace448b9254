"""Loads or compiles all that a clean needs, by cleaning a closet: then a clean is timed alone."""

from __future__ import annotations

import functools
import sys

import numpy as np

from roomba.commands.compiling import compiled_functions_told
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.headless.cleaner import HeadlessMission
from roomba.world.home.home import DirtSource, Home


@functools.cache
def warm_up() -> None:
    """Clean it once in this process, with a thing on the floor that the map does not show."""
    robot = HeadlessMission(closet())
    robot.simulator.place_obstacle(1.9, 0.45, 0.05)
    robot.clean()


def closet() -> Home:
    """Return a home of 2.6 x 1.6 m with a box in it."""
    frame = GridFrame(0.05, 0.0, 0.0, 36, 56)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    values[20:24, 30:36] = OCCUPIED
    solid = values != FREE
    return Home(
        "closet",
        OccupancyMap(frame, values),
        solid=solid,
        walls=solid,
        station=Pose(0.30, 0.90, np.pi),
        dirt_sources=(DirtSource("dust", 1.2, 0.8, 0.3, 1.0, 0.0),),
    )


def warm_up_ticks() -> None:
    """Clean it tick by tick, as nodes do: without the burst, which is the largest loop of all.

    First it walks: :mod:`roomba.commands.warm_up`, which may run beside it, begins with planning.
    """
    robot = HeadlessMission(closet(), longest_burst=0)
    robot.walk(0.9, 0.9)
    robot.clean()


if __name__ == "__main__":
    with compiled_functions_told():
        warm_up_ticks() if sys.argv[1:] == ["ticks"] else warm_up()
