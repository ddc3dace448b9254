"""Sine, cosine and arc tangent without branches, so that a compiler can vectorize them.

They agree with the C library's to 5e-16.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.compilation import inner_part

_PER_QUARTER: Final = 2.0 / math.pi
_QUARTER: Final = 1.57079632673412561417
_QUARTER_REST: Final = 6.07710050650619224932e-11
"""A right angle, rad, is the sum of both parts; multiples of the first are exact up to 2^20."""
_SINE: Final = (
    -1.66666666666666324348e-01,
    8.33333333332248946124e-03,
    -1.98412698298579493134e-04,
    2.75573137070700676789e-06,
    -2.50507602534068634195e-08,
    1.58969099521155010221e-10,
)
_COSINE: Final = (
    4.16666666666666019037e-02,
    -1.38888888888741095749e-03,
    2.48015872894767294178e-05,
    -2.75573143513906633035e-07,
    2.08757232129817482790e-09,
    -1.13596475577881948265e-11,
)
"""Coefficients, by powers of the squared angle, to 1/8 turn (fdlibm, Sun Microsystems 1993)."""
_ATAN_ABOVE: Final = (
    -8.750608600031904122785e-01,
    -1.615753718733365076637e01,
    -7.500855792314704667340e01,
    -1.228866684490136173410e02,
    -6.485021904942025371773e01,
)
_ATAN_BELOW: Final = (
    2.485846490142306297962e01,
    1.650270098316988542046e02,
    4.328810604912902668951e02,
    4.853903996359136964868e02,
    1.945506571482613964425e02,
)
"""Coefficients of both polynomials of a fraction, for ratios to 0.66 (Cephes, Moshier 1989)."""
_ATAN_MOST: Final = 0.66


@inner_part
def sine_cosine(angle: float) -> tuple[float, float]:
    """Return sine and cosine of an angle, rad, of 1000 turns at most."""
    quarters = np.int32(angle * _PER_QUARTER + (0.5 if angle >= 0.0 else -0.5))
    turned = float(quarters)
    rest = angle - turned * _QUARTER - turned * _QUARTER_REST
    square = rest * rest
    s, c = _SINE, _COSINE
    odd = s[1] + square * (s[2] + square * (s[3] + square * (s[4] + square * s[5])))
    even = c[1] + square * (c[2] + square * (c[3] + square * (c[4] + square * c[5])))
    sine = rest + square * rest * (s[0] + square * odd)
    cosine = 1.0 - (0.5 * square - square * square * (c[0] + square * even))
    is_across = (quarters & 1) != 0
    along, across = (sine, cosine) if is_across else (cosine, sine)
    return (
        -across if (quarters & 2) != 0 else across,
        -along if ((quarters + 1) & 2) != 0 else along,
    )


@inner_part
def direction_of(y: float, x: float) -> float:
    """Return the angle of a direction, rad, 0 of none: ``math.atan2`` but for the sign of zero."""
    aside, ahead = abs(y), abs(x)
    is_steep = aside > ahead
    longer = aside if is_steep else ahead
    ratio = (ahead if is_steep else aside) / (longer if longer > 0.0 else 1.0)
    is_far = ratio > _ATAN_MOST
    rest = (ratio - 1.0) / (ratio + 1.0) if is_far else ratio
    square = rest * rest
    p, q = _ATAN_ABOVE, _ATAN_BELOW
    above = (((p[0] * square + p[1]) * square + p[2]) * square + p[3]) * square + p[4]
    below = ((((square + q[0]) * square + q[1]) * square + q[2]) * square + q[3]) * square + q[4]
    angle = rest + rest * (square * above / below)
    angle = 0.25 * math.pi + angle if is_far else angle
    angle = 0.5 * math.pi - angle if is_steep else angle
    angle = math.pi - angle if x < 0.0 else angle
    return -angle if y < 0.0 else angle
