"""Compiled faces of walls that are free of the grid: the way to one, and what rays meet of them.

A face is straight and upright. Seen from its outside, its right end is on the right; rays that come
from the other side pass through it. Metres, map frame; double precision.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.compilation import inner_part, part
from roomba.world.engine.state.arrays import Row, Rows

_SLACK: Final = 1e-9
"""Share of a face by which it is longer at both ends, so that no ray slips between two."""


@inner_part
def way_to_face(face: Row, x: float, y: float) -> tuple[float, float]:
    """Return the shortest way from a point to a face, as a vector."""
    along_x, along_y = face.left_x - face.right_x, face.left_y - face.right_y
    to_x, to_y = face.right_x - x, face.right_y - y
    square = along_x * along_x + along_y * along_y
    share = min(max(-(to_x * along_x + to_y * along_y) / square, 0.0), 1.0)
    return to_x + share * along_x, to_y + share * along_y


@part
def ray_to_faces(
    faces: Rows, first: int, last: int, x: float, y: float, cosine: float, sine: float, left: int
) -> tuple[float, float, int]:
    """Return the way to the nearest face of a range, the cosine to its normal, and which it is.

    ``left`` is a face that the ray has just met and does not meet again. (inf, 1, -1) for none.
    """
    nearest, facing, met = math.inf, 1.0, -1
    for index in range(first, last):
        face = faces[index]
        along_x, along_y = face.left_x - face.right_x, face.left_y - face.right_y
        # How fast the ray comes nearer to the line, times the face's length.
        speed = cosine * along_y - sine * along_x
        if speed <= 0.0 or index == left:
            continue
        to_x, to_y = face.right_x - x, face.right_y - y
        way = (to_x * along_y - to_y * along_x) / speed
        if not 0.0 <= way < nearest:
            continue
        share = (to_x * sine - to_y * cosine) / speed
        if -_SLACK <= share <= 1.0 + _SLACK:
            length = math.hypot(along_x, along_y)
            nearest, facing, met = way, speed / length, index
    return nearest, facing, met


@inner_part
def mirrored(face: Row, cosine: float, sine: float) -> tuple[float, float]:
    """Return the direction of a ray after a mirror has sent it on."""
    along_x, along_y = face.left_x - face.right_x, face.left_y - face.right_y
    square = along_x * along_x + along_y * along_y
    twice = 2.0 * (cosine * along_x + sine * along_y) / square
    return twice * along_x - cosine, twice * along_y - sine
