"""Loads or compiles all that mapping needs, by exploring a closet: then a run is timed alone."""

from __future__ import annotations

import functools
from typing import Any, Final

from roomba.commands.compiling import compiled_functions_told
from roomba.commands.map.map_error import map_error
from roomba.commands.map.seen_floor import seen_floor
from roomba.commands.trials.warm import closet
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.headless.mission import HeadlessMission
from roomba.perception.rooms.rooms import segment

_ALWAYS: Final[dict[str, Any]] = {"submap_keyframes": 4, "link_points": 50, "redrawn_shift": 1e-6}
"""So that submaps are closed, linked, and drawn anew even in a closet."""


@functools.cache
def warm_up() -> None:
    """Explore it once in this process, compare the map with it, and cut it into rooms."""
    home = closet()
    station = (home.station.x, home.station.y)
    robot = HeadlessMission(home, known=MappingConfig(**_ALWAYS))
    made = robot.explore().occupancy
    # What it does where it got stuck between things that it did not see.
    robot.mission.context.squeeze((0.6, 0.9), (1.0, 0.5), [(0.8, 0.7, 0.02)])
    seen = seen_floor(home.solid, home.frame, station, RobotConfig())
    map_error(made, home.frame, home.solid, seen)
    segment(made)


if __name__ == "__main__":
    with compiled_functions_told():
        warm_up()
