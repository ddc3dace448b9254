"""Loads or compiles all that mapping needs, by exploring a closet: then a run is timed alone."""

from __future__ import annotations

import functools
from typing import Any, Final

import numpy as np

from roomba.commands.compiling import compiled_functions_told
from roomba.commands.map.map_error import map_error
from roomba.commands.map.seen_floor import seen_floor
from roomba.commands.trials.warm import closet
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.headless.mission import HeadlessMission
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.rooms.rooms import segment
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher

_ALWAYS: Final[dict[str, Any]] = {"submap_keyframes": 4, "link_points": 50, "redrawn_shift": 1e-6}
"""So that even in a closet submaps are closed, linked, and drawn anew."""


@functools.cache
def warm_up() -> None:
    """Explore it once in this process, compare the map with it, and cut it into rooms.

    Before that, walk through it tick by tick, as nodes and maps of recorded drives do.
    """
    home = closet()
    HeadlessMission(home, known=MappingConfig(), longest_burst=0).walk(0.9, 0.9)
    station = (home.station.x, home.station.y)
    robot = HeadlessMission(home, known=MappingConfig(**_ALWAYS))
    made = robot.explore().occupancy
    # The motions of a robot that gets stuck between unseen things.
    robot.mission.context.squeeze((0.6, 0.9), (1.0, 0.5), [(0.8, 0.7, 0.02)])
    _match_in_wide_windows()
    seen = seen_floor(home.solid, home.frame, station, RobotConfig())
    map_error(made, home.frame, home.solid, seen)
    segment(made)


def _match_in_wide_windows() -> None:
    """Match in wide windows as loop closures do, for which a closet is too small."""
    angles = np.linspace(0.0, 6.0, 60)
    normals = np.column_stack([np.cos(angles), np.sin(angles)])
    points = np.hstack([2.0 * normals, -normals])
    CorrelativeMatcher(points, 5.0).best(points, np.zeros(3), 0.2, 0.1, 0.5)
    is_apart(np.zeros(3), np.ones(3), 0.1, 0.1)


if __name__ == "__main__":
    with compiled_functions_told():
        warm_up()
