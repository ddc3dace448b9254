"""Compiled: beams that a match leaves behind surfaces of the map tell nothing of the pose.

A mirror sends beams on, and what it shows seems to stand behind it; glass, and a door that the map
shows shut, let them through. Where many beams of one direction end behind what the map shows, those
beside them that happen to end near it are of the same kind: the robot's own image behind a mirror
is as near to it as the robot, and takes the place along when the robot drives away. So all of that
direction are left out (a gate for what belongs to a landmark; Bar-Shalom, Li and Kirubarajan,
"Estimation with Applications to Tracking and Navigation", 2001).
"""

from __future__ import annotations

import math
from typing import Final

from roomba.arrays import Floats
from roomba.compilation import inner_part
from roomba.perception.matching.field_kernels import OFF_MAP, Field, Place, look

BEHIND_LANES: Final = 3
"""Rows of the work array of :func:`leave_out_behind`; each column is a beam."""
_IS_BEHIND: Final = 2
"""The row that tells which beams end behind a surface."""
_DEVIATIONS: Final = 2.0
"""Deviations of where a wall is: a beam that ends deeper behind one went through it."""
_OF_RANGE: Final = 0.02
"""Share of a range, m per m, that is added to it: far ranges are less exact."""
_DIRECTIONS: Final = 24
"""In so many parts of all beams these are looked at together, to either side of each."""
_MANY: Final = 0.25
"""Share of them that must end behind surfaces for all to be left out."""

_EDGE: Final = 1e-6
"""Cells from the last middles of the map, between which distances are known."""


@inner_part
def leave_out_behind(
    field: Field, place: Place, count: int, pose: Floats, wall_variance: float, lanes: Floats
) -> int:
    """Leave out beams that ended behind surfaces, with those beside them; return how many are left.

    ``lanes`` [BEHIND_LANES or more, n] has x and y of the ends of ``count`` beams, m, in the frame
    of the robot at ``pose`` [3]. Those that are left out are moved far off the map, where they
    count as behind it when it is called again: what was left out gets a margin.
    ``wall_variance``, m2, is that of where walls are against the map.
    """
    aside = max(1, count // _DIRECTIONS)
    beside = 2 * aside + 1
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    of_wall = _DEVIATIONS * math.sqrt(wall_variance)
    total, left = 0.0, 0
    for index in range(count):
        ahead, across = lanes[0, index], lanes[1, index]
        x, y = cosine * ahead - sine * across, sine * ahead + cosine * across
        off = _distance(field, place, pose[0] + x, pose[1] + y)
        is_behind = off < -of_wall and off < -of_wall - _OF_RANGE * math.hypot(x, y)
        lanes[_IS_BEHIND, index] = 1.0 if is_behind else 0.0
        total += lanes[_IS_BEHIND, index]
        left += ahead != OFF_MAP
    if count < beside or total <= _MANY * beside:
        return left
    behind = 0.0
    for index in range(-aside, aside + 1):
        behind += lanes[_IS_BEHIND, index % count]
    for index in range(count):
        if behind > _MANY * beside and lanes[0, index] != OFF_MAP:
            lanes[0, index] = OFF_MAP
            left -= 1
        behind += lanes[_IS_BEHIND, (index + aside + 1) % count]
        behind -= lanes[_IS_BEHIND, (index - aside) % count]
    return left


@inner_part
def _distance(field: Field, place: Place, x: float, y: float) -> float:
    """Return the distance to the nearest surface there, m; off the map it is behind its edge."""
    rows, columns = field.shape
    inside_x = min(max(x, place[0]), place[0] + (columns - 1 - _EDGE) * place[2])
    inside_y = min(max(y, place[1]), place[1] + (rows - 1 - _EDGE) * place[2])
    off, _, _ = look(field, place, inside_x, inside_y)
    distance: float = off
    if x != inside_x or y != inside_y:
        distance -= math.hypot(x - inside_x, y - inside_y)
    return distance
