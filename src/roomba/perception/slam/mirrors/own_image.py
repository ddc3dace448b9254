"""Planes in which a driving robot may have seen itself, before it touched a mirror.

The robot's own image is as far behind a mirror as the robot is before it. So a beam straight into
the mirror is twice as long as the way to the mirror, from each place of the robot: half of the beam
always ends on one plane. For a thing that stands still, half of the beam ends on that plane from
one distance only. A thing that comes towards the robot as fast as it drives looks like the robot's
image that one time. Such a plane is checked again as long as the map is made.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats
from roomba.perception.slam.mirrors.images import Beams, Plane, count_of_places

_AHEAD: Final = 0.03
"""rad; a beam that is turned by less from the normal of a plane looks straight at it."""
_FARTHEST: Final = 4.0
"""m; from farther off hardly a beam meets its own image."""
_BODY: Final = 0.04
"""m; half of the beam ends so far before a mirror, as the image is of the robot's near side."""
_OFF: Final = 0.05
"""m; images that are taken together are less than this off one plane."""
_ASIDE: Final = 0.4
"""m; images that are taken together are less than this off one point along the plane."""
_LEAST: Final = 6
"""The fewest places from which the robot saw itself in a plane."""
_LEAST_SPREAD: Final = 1.2
"""m; the least by which the farthest of these images is farther off than the nearest."""
_MOST: Final = 3
"""Planes that are returned for one direction, at most."""


class OwnImage(NamedTuple):
    """A ``plane`` in which the robot may have seen itself, from ``farthest`` m away on."""

    plane: Plane
    farthest: float


def own_image_planes(beams: Beams, facing: float) -> list[OwnImage]:
    """Return planes that face about one way, rad, in which the robot may have seen itself.

    The planes with the most images come first.
    """
    ways = beams.ends - beams.starts
    off = wrap_angles(np.arctan2(ways[:, 1], ways[:, 0]) - facing)
    away = 0.5 * np.hypot(ways[:, 0], ways[:, 1])
    ahead = (np.abs(off) < _AHEAD) & (away < _FARTHEST)
    starts, away = beams.starts[ahead], away[ahead]
    toward = Plane(0.0, 0.0, facing)
    distance, place = starts @ toward.normal + away, starts @ toward.along
    found, left = list[OwnImage](), np.ones(len(starts), np.bool_)
    while len(found) < _MOST and left.any():
        together = _most_together(distance, place, left)
        left &= ~together
        if count_of_places(starts[together]) < _LEAST:
            break
        if np.ptp(away[together]) >= _LEAST_SPREAD:
            middle = (np.median(distance[together]) + _BODY) * toward.normal
            x, y = (middle + np.median(place[together]) * toward.along).tolist()
            found.append(OwnImage(Plane(x, y, facing), float(away[together].max())))
    return found


def _most_together(distance: Floats, place: Floats, left: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the largest group of beams that are ``left`` and end near one point of a plane."""
    best, most = left & False, 0
    bins = np.round(np.column_stack((distance / _OFF, place / _ASIDE))[left])
    centres, counts = np.unique(bins, axis=0, return_counts=True)
    for centre in centres[counts > 1]:
        near = left & (np.abs(distance - centre[0] * _OFF) < _OFF)
        near &= np.abs(place - centre[1] * _ASIDE) < _ASIDE
        count = int(near.sum())
        if count > most:
            best, most = near, count
    return best
