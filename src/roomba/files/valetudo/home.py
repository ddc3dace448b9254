"""A home as a map of Valetudo tells it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from roomba.arrays import Mask
from roomba.errors import RoombaError
from roomba.geometry import Point, Pose
from roomba.grid import OccupancyMap

VERSION: Final = 2
"""Version of the format that is written."""
CM: Final = 0.01
"""m; the format's unit."""


class ValetudoError(RoombaError):
    """A file that is no such map, or a home that cannot be written as one."""


@dataclass(frozen=True, slots=True, eq=False)
class ValetudoHome:
    """A home as such a map tells it: m and rad, map frame.

    ``rooms`` are names with masks, bool over the map; ``no_go`` are corners of areas, ``walls``
    those of virtual walls. ``station`` is the docked robot; ``has_own_frame`` whether the file said
    where its corner lies. Without that only the station's place is to be relied on, at (0, 0), not
    its heading: that means something else with each vendor.

    ``robot`` is where the robot is, if not on its station, and ``way`` how it came there; both are
    only written.
    """

    occupancy: OccupancyMap
    rooms: tuple[tuple[str, Mask], ...] = ()
    station: Pose | None = None
    no_go: tuple[tuple[Point, ...], ...] = ()
    walls: tuple[tuple[Point, ...], ...] = ()
    has_own_frame: bool = True
    robot: Pose | None = None
    way: tuple[Point, ...] = ()
