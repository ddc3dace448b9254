"""Compiled beams of a sweep in bundles: from where each is measured, where it points, its chance.

None of this has branches, so that the compiler works on eight beams together.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.compilation import inner_part
from roomba.trigonometry import sine_cosine
from roomba.world.engine.state.arrays import Row
from roomba.world.engine.state.random_kernels import hashed

BUNDLE: Final = 16
"""Beams of a bundle."""

BEAMS: Final = np.dtype(
    [
        ("x", "f8", (BUNDLE,)),  # where each is measured, m, map frame
        ("y", "f8", (BUNDLE,)),
        ("angle", "f8", (BUNDLE,)),  # where it points, rad
        ("cosine", "f8", (BUNDLE,)),
        ("sine", "f8", (BUNDLE,)),
        ("first", "u4", (BUNDLE,)),  # its random bits
        ("second", "u4", (BUNDLE,)),
        ("third", "u4", (BUNDLE,)),
        ("way", "f8", (BUNDLE,)),  # to the nearest solid cell: cells on the way there, then m
        ("facing", "f8", (BUNDLE,)),  # cosine of the angle to the normal of what it meets
        ("cell_x", "f8", (BUNDLE,)),  # where each is measured, cells
        ("cell_y", "f8", (BUNDLE,)),
        ("column", "f8", (BUNDLE,)),  # the cell where it is: whole numbers
        ("row", "f8", (BUNDLE,)),
        ("per_column", "f8", (BUNDLE,)),  # way for a cell along an axis
        ("per_row", "f8", (BUNDLE,)),
        ("side", "f8", (BUNDLE,)),  # of the free square ahead, cells
        ("place", "i4", (BUNDLE,)),  # where that stands in the squares of its quadrant
        ("quadrant", "i4", (BUNDLE,)),
    ],
    align=True,
)
"""A bundle, one row. The compiler knows where each number stands, and that no two are the same."""

_STRAIGHT: Final = 1e-9
"""rad; a step that turns by less counts as straight: the middle of its arc is too far away."""
_UNIT_16: Final = 1.0 / (1 << 16)


@inner_part
def draw(beams: Row, key: np.uint32, first: int) -> None:
    """Give the beams of a bundle, from the one of number ``first`` on, their random bits."""
    for number in range(BUNDLE):
        bits = hashed(np.uint32(key + np.uint32(first + number) * np.uint32(0x9E3779B9)))
        beams.first[number] = bits
        bits = hashed(np.uint32(bits ^ np.uint32(0x85EBCA6B)))
        beams.second[number] = bits
        beams.third[number] = hashed(np.uint32(bits ^ np.uint32(0xC2B2AE35)))


@inner_part
def aim(
    beams: Row,
    times: tuple[float, float],
    dt: float,
    numbers: Row,
    first: int,
    start: tuple[float, float, float],
    way: tuple[float, float, float],
) -> None:
    """Find from where each beam of a bundle is measured, and where it points.

    ``times`` are when the sweep and the step began, s; in the step, of ``dt`` s, the lidar goes
    from ``start`` by ``way``, each x and y, m, and theta, rad.
    """
    first_x, first_y, first_theta = start
    chord_x, chord_y, turn = way
    spoke_x, spoke_y = spoke_of(chord_x, chord_y, turn)
    is_arc = abs(turn) > _STRAIGHT
    increment, step = numbers.time_increment, numbers.beam_step
    first_angle, rounding = numbers.first_angle, numbers.angle_rounding
    for number in range(BUNDLE):
        beam = float(first + number)
        share = min(max((times[0] + beam * increment - times[1]) / dt, 0.0), 1.0)
        sine, cosine = sine_cosine(share * turn)
        ahead, aside = cosine - 1.0, sine
        way_x = ahead * spoke_x - aside * spoke_y if is_arc else share * chord_x
        way_y = aside * spoke_x + ahead * spoke_y if is_arc else share * chord_y
        beams.x[number], beams.y[number] = first_x + way_x, first_y + way_y
        part = float(beams.second[number] & np.uint32(65535)) * _UNIT_16 - 0.5
        angle = first_theta + share * turn + first_angle + beam * step + rounding * part
        beams.angle[number] = angle
        beams.sine[number], beams.cosine[number] = sine_cosine(angle)


@inner_part
def spoke_of(chord_x: float, chord_y: float, turn: float) -> tuple[float, float]:
    """Return the vector from the middle of an arc, which turns by ``turn``, rad, to its start.

    As complex numbers: the spoke times ``exp(i turn)``, less the spoke, is the chord.
    """
    ahead, aside = math.cos(turn) - 1.0, math.sin(turn)
    square = ahead * ahead + aside * aside
    return (
        (chord_x * ahead + chord_y * aside) / square,
        (chord_y * ahead - chord_x * aside) / square,
    )
