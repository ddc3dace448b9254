"""A home as it really is: its map, and everything that stands, lies and falls in it.

Metres and radians in the map frame; dirt in grams. :mod:`roomba.world.layers.layer` reads homes
from files. What moves by itself has a script, which :mod:`roomba.world.home.moving` plays.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.world.home.free_wall import FreeWalls


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

    def placed_at(self, pose: Pose) -> Box:
        """Return this box, given in the frame at ``pose``, in the frame that ``pose`` is in."""
        placed = pose.compose(Pose(self.x, self.y, self.theta))
        return replace(self, x=placed.x, y=placed.y, theta=placed.theta)


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
    """An opening in a wall; it is solid unless it ``is_open``, or its leaf is a moving thing."""

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


LEAF_HEIGHT: Final = 2.03
"""m; of a door's leaf, in a home that is not lower."""


class MovingKind(Enum):
    """What moves by itself or is moved by a person."""

    DOOR = "door"
    """A door's leaf: stands in its opening, or is out of the way."""
    FURNITURE = "furniture"
    """A piece that is moved to another place."""
    PERSON = "person"
    """A person who walks through."""


@dataclass(frozen=True, slots=True)
class Move:
    """One piece of a script: from ``begins`` on the thing goes to ``pose``, evenly.

    It arrives ``takes`` s later, and stays until the next move; with 0 s it is there at once.
    From ``begins`` on it is there for bodies and sensors if it ``is_present``. Times in s.
    """

    begins: float
    takes: float
    pose: Pose
    is_present: bool = True

    @property
    def ends(self) -> float:
        """When it arrives, s."""
        return self.begins + self.takes


@dataclass(frozen=True, slots=True)
class Script:
    """When and where a thing moves.

    The times of ``moves``, in order, count from the start of the day, and from the start of each
    ``period`` s after that; with a period of 0 all happens once. Each of these occurrences is put
    off by up to ``jitter`` s, at random from the seed, but never into the next one.
    """

    moves: tuple[Move, ...]
    period: float = 0.0
    jitter: float = 0.0


@dataclass(frozen=True, slots=True)
class MovingThing:
    """A thing that moves during the day as its script says.

    ``boxes`` are in the thing's own frame; ``pose``, in the map frame, is where it stands before
    its first move, if it ``is_present`` then.
    """

    name: str
    kind: MovingKind
    boxes: tuple[Box, ...]
    pose: Pose
    is_present: bool
    script: Script

    @property
    def first_boxes(self) -> tuple[Box, ...]:
        """Its boxes in the map frame before its first move; none if it is not present."""
        return tuple(box.placed_at(self.pose) for box in self.boxes) if self.is_present else ()


@dataclass(frozen=True, slots=True, eq=False)
class TurnedFrom:
    """What a home with slanted walls is made of: the same ``home`` in its own axes, exact.

    These axes lie at ``axes`` in the turned home's frame, where the cells without floor are
    ``drop``, bool [rows, columns].
    """

    home: Home
    axes: Pose
    drop: NDArray[np.bool_]


class StationPlace(Enum):
    """Who said where the station stands."""

    TOLD = "told"
    """The home's layer, or a person."""
    FOUND = "found"
    """The program put it where there is room."""
    ON_PAPER = "on paper"
    """The program put it on floor that reaches the end of the picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Home:
    """The truth about a home.

    ``map`` is what a robot that had mapped the home would know. ``solid`` (bool [rows, columns],
    same frame) is what stops its body and stays where it is: all that is not free floor at the
    body's height, things off the map and closed doors included. ``walls`` are those solid cells
    that stand up to the ceiling. ``station`` is the pose of the docked robot, its nose to the
    station. What is ``moving`` is not solid and in no other list: not among ``furniture``, and a
    door whose leaf moves is open in ``doors``. ``stairs`` lead down: floor on the map, a drop to
    a robot. A home that was ``turned`` by :mod:`roomba.world.home.turned`, or has ``free_walls``,
    has slanted walls: its grids show them in steps. ``exact`` is the home without these steps: its
    free walls are not in its ``walls``, and only cells that lie within one are ``solid``.
    ``surfaces``, of ``exact`` too, are codes of what the cells' surfaces do to light, uint8
    [rows, columns]: see :class:`roomba.world.home.surface.Surface`; None if no material is given.
    ``station_place`` is who said where the station stands.
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
    moving: tuple[MovingThing, ...] = ()
    wall_height: float = 2.4
    turned: TurnedFrom | None = None
    free_walls: FreeWalls | None = None
    surfaces: NDArray[np.uint8] | None = None
    station_place: StationPlace = StationPlace.TOLD

    @property
    def blocked(self) -> NDArray[np.bool_]:
        """Cells on which no dirt lies and no robot stands: bool [rows, columns]."""
        blocked = self.solid | self.drop
        return blocked if self.free_walls is None else blocked | self.free_walls.touched

    @property
    def exact(self) -> Home:
        """What bodies meet and sensors see: the home in its own axes, which lie at ``axes``."""
        return self if self.turned is None else self.turned.home

    @property
    def axes(self) -> Pose:
        """Where the axes of ``exact`` lie in this home's frame."""
        return Pose() if self.turned is None else self.turned.axes

    def told(self, pose: Pose) -> Pose:
        """Return a pose of the frame of ``exact`` in this home's frame."""
        return pose if self.turned is None else self.turned.axes.compose(pose)

    def own(self, pose: Pose) -> Pose:
        """Return a pose of this home's frame in that of ``exact``."""
        return pose if self.turned is None else self.turned.axes.inverse().compose(pose)

    @property
    def frame(self) -> GridFrame:
        """Where the grids of this home lie."""
        return self.map.frame

    @property
    def drop(self) -> NDArray[np.bool_]:
        """Cells without floor, since stairs begin there: bool [rows, columns]."""
        return cells_in(self.frame, self.stairs) if self.turned is None else self.turned.drop

    def room_at(self, x: float, y: float) -> Room | None:
        """Return the room in which a point lies, the first of several; None outside of all."""
        return next((room for room in self.rooms if room.contains(x, y)), None)


def cells_in(frame: GridFrame, areas: Iterable[Rectangle]) -> NDArray[np.bool_]:
    """Return the cells whose centres lie in any of the rectangles, bool [rows, columns]."""
    x, y = frame.centres()
    mask = np.zeros(frame.shape, np.bool_)
    for area in areas:
        rows = (area.y_min <= y) & (y <= area.y_max)
        columns = (area.x_min <= x) & (x <= area.x_max)
        mask |= rows[:, None] & columns[None, :]
    return mask
