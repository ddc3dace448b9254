"""Ends of beams behind a plane, reflected to its front: a test whether the plane is a mirror.

A mirror reflects a beam. The lidar takes the thing that the reflected beam meets for one behind the
mirror, as far behind it as the thing is before it. Reflected back, the ends of such beams lie on
surfaces that the map has before the mirror. If the plane is a door, a window, or a wall of glass,
they lie anywhere, and many on free floor.
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
"""m; a beam that ends nearer than this behind a plane may have met the plane itself."""
_BESIDE: Final = 0.08
"""m; a surface so near to a plane may be a wall on which the mirror hangs."""
_OWN: Final = 0.25
"""m; an image so near to the lidar is that of the robot itself."""
_PLACE: Final = 0.1
"""m; side of the squares of which each counts as one place."""
_AT_RIGHT_ANGLES: Final = 0.25
"""Cosine of the angle between surface normal and plane normal; below it the image of the surface
lies on the surface itself."""
_AROUND: Final = np.ones((3, 3), np.bool_)
"""Cells around an occupied one in which its surface may be."""


class Beams(NamedTuple):
    """Beams: their ``starts``, ``ends`` and the ``normals`` of the surfaces that they met.

    Each is float64 [n, 2], m, map frame; a normal is 0 if it is not known.
    """

    starts: Floats
    ends: Floats
    normals: Floats

    def chosen(self, which: Flags | NDArray[np.int64] | slice) -> Beams:
        """Return some of the beams."""
        return Beams(self.starts[which], self.ends[which], self.normals[which])


class Plane(NamedTuple):
    """A vertical plane: a point ``x``, ``y``, m, on it, and ``facing``, rad, the way behind it."""

    x: float
    y: float
    facing: float

    @property
    def middle(self) -> Floats:
        """The given point on the plane, float64 [2]."""
        return np.array([self.x, self.y])

    @property
    def normal(self) -> Floats:
        """The direction to behind the plane, float64 [2], of length 1."""
        return np.array([np.cos(self.facing), np.sin(self.facing)])

    def moved(self, turn: float, shift: float) -> Plane:
        """Return the plane turned about its middle, rad, and then shifted ``shift`` m backwards."""
        facing = self.facing + turn
        x, y = self.x + shift * np.cos(facing), self.y + shift * np.sin(facing)
        return Plane(float(x), float(y), facing)

    def turned_over(self, points: Floats) -> Floats:
        """Return the mirror images of points, [n, 2], m, in the plane."""
        behind = (points - self.middle) @ self.normal
        over: Floats = points - 2.0 * behind[:, None] * self.normal
        return over

    @property
    def along(self) -> Floats:
        """The direction along the plane, to the left for a viewer before it, float64 [2]."""
        return np.array([-np.sin(self.facing), np.cos(self.facing)])


class MappedFloor(NamedTuple):
    """Cells of the map: those ``beside`` surfaces, and ``free`` floor away from surfaces."""

    frame: GridFrame
    beside: Flags
    free: Flags

    @staticmethod
    def of(occupancy: OccupancyMap) -> MappedFloor:
        """Return the cells of a map."""
        beside = dilated(occupancy.values == OCCUPIED, _AROUND)
        return MappedFloor(occupancy.frame, beside, (occupancy.values == FREE) & ~beside)


class Images(NamedTuple):
    """Beams that pass a plane; ``places`` are where, m along the plane from its middle.

    The others are bool [n]. ``fits``: reflected, the beam ends beside a surface, or on the robot
    itself. ``contradicts``: it ends on free floor. Where the map is unknown neither holds.
    ``informs``: the surface that was met is not at right angles to the plane. A wall at right
    angles that goes on behind the plane has itself for an image.
    """

    places: Floats
    fits: Flags
    contradicts: Flags
    informs: Flags


def places_of_ends(beams: Beams, plane: Plane) -> Floats:
    """Return where along a plane, m from its middle, those beams ended that met it."""
    off = beams.ends - plane.middle
    places: Floats = (off @ plane.along)[np.abs(off @ plane.normal) < _BESIDE]
    return places


def count_of_places(starts: Floats) -> int:
    """Return the number of places from which beams begin, at ``starts``, [n, 2], m.

    A robot that turns on the spot is at one place.
    """
    return len(np.unique(np.floor(starts / _PLACE), axis=0))


def own_images(beams: Beams, plane: Plane) -> Flags:
    """Return which beams end behind a plane where a mirror would show the robot, bool [n]."""
    behind = (beams.ends - plane.middle) @ plane.normal
    return (behind > _BEHIND) & _is_own(beams, plane.turned_over(beams.ends))


def _is_own(beams: Beams, image: Floats) -> Flags:
    own: Flags = np.hypot(*(image - beams.starts).T) < _OWN
    return own


def images(beams: Beams, plane: Plane, floor: MappedFloor) -> Images:
    """Return the images of the beams that pass a plane from its front."""
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
