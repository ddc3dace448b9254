"""Compiled: beams that end behind surfaces of the map after a match say nothing of the pose.

A mirror reflects beams, and what it shows seems to stand behind it; glass lets beams through, and
so does an open door that the map shows shut. Where many beams of one direction end behind what the
map shows, the beams beside them that happen to end near the surface are wrong in the same way. The
robot's own image, for example, is as far behind a mirror as the robot is before it, and would take
the pose along when the robot drives away. So all beams of such a direction are left out (a gate for
what belongs to a landmark; Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to
Tracking and Navigation", 2001).
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
"""Standard deviations of a wall's place: a beam that ends farther behind a wall went through it."""
_OF_RANGE: Final = 0.02
"""Share of the range, m per m, that is added to that depth: far ranges are less exact."""
_DIRECTIONS: Final = 24
"""Parts of all beams; each beam is judged with as many neighbours on either side as a part has."""
_MANY: Final = 0.25
"""Share of these that must end behind surfaces for the beam to be left out."""

_EDGE: Final = 1e-6
"""In cells; margin to the last cell's middle, as distances are known only between middles."""


@inner_part
def leave_out_behind(
    field: Field, place: Place, count: int, pose: Floats, wall_variance: float, lanes: Floats
) -> int:
    """Leave out beams that ended behind surfaces, with those beside them; return how many are left.

    ``lanes`` [BEHIND_LANES or more, n] has x and y of the ends of ``count`` beams, m, in the frame
    of the robot at ``pose`` [3]. Beams that are left out are moved far off the map. There they
    count as behind a surface at the next call, which so leaves out a margin beside them.
    ``wall_variance``, m2, is that of the walls' true places against the map.
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
    """Return the distance to the nearest surface, m; off the map, less the way from its edge."""
    rows, columns = field.shape
    inside_x = min(max(x, place[0]), place[0] + (columns - 1 - _EDGE) * place[2])
    inside_y = min(max(y, place[1]), place[1] + (rows - 1 - _EDGE) * place[2])
    off, _, _ = look(field, place, inside_x, inside_y)
    distance: float = off
    if x != inside_x or y != inside_y:
        distance -= math.hypot(x - inside_x, y - inside_y)
    return distance
