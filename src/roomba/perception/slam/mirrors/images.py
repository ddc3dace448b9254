"""What beams show behind a plane, turned over to its front: the image that a mirror makes.

A mirror sends a beam on, and the lidar takes what that meets for something behind the mirror, as
far as it is before it. Turned over, the ends of such beams lie on surfaces that the map has before
the mirror. Of a door, a window, or a wall of glass they lie anywhere: many where floor is free.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.raster.regions import dilated

Flags = NDArray[np.bool_]

_BEHIND: Final = 0.05
"""m; a beam that ends nearer behind a plane may have met what is on it."""
_BESIDE: Final = 0.08
"""m; what is so near to a plane may be a wall on which the mirror hangs."""
_OWN: Final = 0.25
"""m; an image so near to the lidar is that of the robot itself."""
_PLACE: Final = 0.1
"""m; side of the squares that count as a place each."""
_AT_RIGHT_ANGLES: Final = 0.25
"""Cosine between what was met and the plane, below which its image lies on itself."""
_AROUND: Final = np.ones((3, 3), np.bool_)
"""Cells around an occupied one in which its surface may be."""


class Beams(NamedTuple):
    """Beams where they were taken: ``starts``, ``ends`` and the ``normals`` of what they met.

    Each float64 [n, 2], m, map frame; a normal is 0 where it is not known.
    """

    starts: Floats
    ends: Floats
    normals: Floats

    def chosen(self, which: Flags | NDArray[np.int64] | slice) -> Beams:
        """Return some of them."""
        return Beams(self.starts[which], self.ends[which], self.normals[which])


class Plane(NamedTuple):
    """A vertical plane: ``x``, ``y``, m, on it, and ``facing``, rad, into what is behind it."""

    x: float
    y: float
    facing: float

    @property
    def middle(self) -> Floats:
        """The point on it, float64 [2]."""
        return np.array([self.x, self.y])

    @property
    def normal(self) -> Floats:
        """The direction into what is behind it, float64 [2]."""
        return np.array([np.cos(self.facing), np.sin(self.facing)])

    def moved(self, turn: float, shift: float) -> Plane:
        """Return it turned about its middle, rad, and then ``shift`` m farther off."""
        facing = self.facing + turn
        x, y = self.x + shift * np.cos(facing), self.y + shift * np.sin(facing)
        return Plane(float(x), float(y), facing)

    def turned_over(self, points: Floats) -> Floats:
        """Return where points, [n, 2], m, are that it shows as those."""
        behind = (points - self.middle) @ self.normal
        over: Floats = points - 2.0 * behind[:, None] * self.normal
        return over

    @property
    def along(self) -> Floats:
        """The direction along it, to the left of one who looks at it, float64 [2]."""
        return np.array([-np.sin(self.facing), np.cos(self.facing)])


class MappedFloor(NamedTuple):
    """What the map has: cells ``beside`` surfaces, and floor that is ``free`` of them."""

    frame: GridFrame
    beside: Flags
    free: Flags

    @staticmethod
    def of(occupancy: OccupancyMap) -> MappedFloor:
        """Return that of a map."""
        beside = dilated(occupancy.values == OCCUPIED, _AROUND)
        return MappedFloor(occupancy.frame, beside, (occupancy.values == FREE) & ~beside)


class Images(NamedTuple):
    """Beams that pass a plane: ``places``, m, along it from its middle, where they do.

    ``fits``: turned over, they end beside a surface, or on the robot itself; ``contradicts``: on
    free floor. Neither where the map knows nothing. ``informs``: what was met is not at right
    angles to the plane, as a wall is that goes on behind it and has itself for an image. Each bool
    [n].
    """

    places: Floats
    fits: Flags
    contradicts: Flags
    informs: Flags


def places_of_ends(beams: Beams, plane: Plane) -> Floats:
    """Return where along a plane, m from its middle, beams end that met something on it."""
    off = beams.ends - plane.middle
    places: Floats = (off @ plane.along)[np.abs(off @ plane.normal) < _BESIDE]
    return places


def count_of_places(starts: Floats) -> int:
    """Return from how many places beams were taken that begin at ``starts``, [n, 2], m.

    A robot that turns on the spot is at one place.
    """
    return len(np.unique(np.floor(starts / _PLACE), axis=0))


def own_images(beams: Beams, plane: Plane) -> Flags:
    """Return which beams end behind a plane where it would show the robot itself, bool [n]."""
    behind = (beams.ends - plane.middle) @ plane.normal
    return (behind > _BEHIND) & _is_own(beams, plane.turned_over(beams.ends))


def _is_own(beams: Beams, image: Floats) -> Flags:
    own: Flags = np.hypot(*(image - beams.starts).T) < _OWN
    return own


def images(beams: Beams, plane: Plane, floor: MappedFloor) -> Images:
    """Return what the beams show that pass a plane from its front."""
    normal = plane.normal
    before = (beams.starts - plane.middle) @ normal
    behind = (beams.ends - plane.middle) @ normal
    passes = (before < 0.0) & (behind > _BEHIND)
    passing, before, behind = beams.chosen(passes), before[passes], behind[passes]
    share = before / (before - behind)
    there = passing.starts + share[:, None] * (passing.ends - passing.starts)
    image = plane.turned_over(passing.ends)
    rows, columns = floor.frame.cells_of(image[:, 0], image[:, 1])
    held = floor.frame.holds(rows, columns)
    rows, columns = np.where(held, rows, 0), np.where(held, columns, 0)
    is_own = _is_own(passing, image)
    return Images(
        (there - plane.middle) @ plane.along,
        is_own | (held & floor.beside[rows, columns]),
        ~is_own & held & floor.free[rows, columns],
        is_own | (np.abs(passing.normals @ normal) > _AT_RIGHT_ANGLES),
    )
