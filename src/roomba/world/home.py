"""A home as it really is: its map, and everything that stands, lies and falls in it.

Metres and radians in the map frame; dirt in grams. :mod:`roomba.world.layer` reads homes from
files.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap


@dataclass(frozen=True, slots=True)
class Box:
    """A block of furniture: an upright cuboid that may be turned about the vertical.

    ``x``, ``y`` is the middle of its footprint, ``theta`` the direction of its length;
    ``bottom`` and ``top`` are heights above the floor; ``material`` names a look of the camera.
    """

    x: float
    y: float
    theta: float
    length: float
    width: float
    bottom: float
    top: float
    material: str


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle along the axes: lower left and upper right corner."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies in it, its border included."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max


@dataclass(frozen=True, slots=True)
class Room:
    """A named room: the corners of its outline, and the look of its floor."""

    name: str
    outline: tuple[tuple[float, float], ...]
    floor: str

    def contains(self, x: float, y: float) -> bool:
        """Whether a point lies inside the outline (even-odd rule; on the border either holds)."""
        inside = False
        previous_x, previous_y = self.outline[-1]
        for corner_x, corner_y in self.outline:
            if (corner_y > y) != (previous_y > y):
                share = (y - corner_y) / (previous_y - corner_y)
                if x < corner_x + share * (previous_x - corner_x):
                    inside = not inside
            previous_x, previous_y = corner_x, corner_y
        return inside


@dataclass(frozen=True, slots=True)
class Furniture:
    """One piece: its kind in the catalogue, where it stands, and the boxes that it is made of.

    ``on_map`` is False for things that the robot's map does not show.
    """

    name: str
    kind: str
    pose: Pose
    boxes: tuple[Box, ...]
    on_map: bool


@dataclass(frozen=True, slots=True)
class Door:
    """An opening in a wall that a leaf can close; a closed one is solid."""

    name: str
    opening: Rectangle
    is_open: bool


@dataclass(frozen=True, slots=True)
class Carpet:
    """A carpet on the floor, and its look."""

    name: str
    area: Rectangle
    material: str


@dataclass(frozen=True, slots=True)
class DirtSource:
    """Where dirt comes from.

    ``amount`` lies there at the start, g; ``rate`` falls later, g/h; both are spread as a
    Gaussian of standard deviation ``radius``, m, over the floor that is free.
    """

    name: str
    x: float
    y: float
    radius: float
    amount: float
    rate: float


@dataclass(frozen=True, slots=True, eq=False)
class Home:
    """The truth about a home.

    ``map`` is what a robot that had mapped the home would know. ``solid`` (bool [rows, columns],
    same frame) is what stops its body: all that is not free floor at the body's height, things
    off the map, closed doors and stairs included. ``walls`` are those solid cells that stand up
    to the ceiling. ``station`` is the pose of the docked robot, its nose to the station.
    """

    name: str
    map: OccupancyMap
    solid: NDArray[np.bool_]
    walls: NDArray[np.bool_]
    station: Pose
    rooms: tuple[Room, ...] = ()
    furniture: tuple[Furniture, ...] = ()
    doors: tuple[Door, ...] = ()
    carpets: tuple[Carpet, ...] = ()
    stairs: tuple[Rectangle, ...] = ()
    dirt_sources: tuple[DirtSource, ...] = ()
    wall_height: float = 2.4

    @property
    def frame(self) -> GridFrame:
        """Where the grids of this home lie."""
        return self.map.frame

    def room_at(self, x: float, y: float) -> Room | None:
        """Return the room in which a point lies, the first of several; None outside of all."""
        return next((room for room in self.rooms if room.contains(x, y)), None)
