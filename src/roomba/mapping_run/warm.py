"""Loads or compiles all that mapping needs, by exploring a closet: then a run is timed alone."""

from __future__ import annotations

import functools

from roomba.config import RobotConfig
from roomba.headless_explorer import HeadlessExplorer
from roomba.mapping_run.map_error import map_error
from roomba.mapping_run.seen_floor import seen_floor
from roomba.perception.rooms import segment
from roomba.sim.warm import closet


@functools.cache
def warm_up() -> None:
    """Explore it once in this process, compare the map with it, and cut it into rooms."""
    home = closet()
    station = (home.station.x, home.station.y)
    made = HeadlessExplorer(home).explore().occupancy
    seen = seen_floor(home.solid, home.frame, station, RobotConfig())
    map_error(made, home.frame, home.solid, seen)
    segment(made)


if __name__ == "__main__":
    warm_up()
