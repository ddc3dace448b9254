"""Compiled judgement of how well a scan fits a pose: beam by beam, what the map says of it."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.perception.field_kernels import Field, Place, expected_range, look

Floats = NDArray[np.float64]

LOOKED_AT: Final = 0
AGREEING: Final = 1
SHORT: Final = 2
THROUGH: Final = 3
EVIDENCE: Final = 4
"""Places in the ``fit`` that :func:`judge` fills."""

_SLACK: Final = 0.06
_SLACK_SHARE: Final = 0.01
"""m, and share of the range: how far from the expected surface a beam may end to agree with it."""
_SPREAD: Final = 0.03
"""m; standard deviation of where beams that agree end: noise of range, pose and map."""
_CHANCE: Final = 0.03
"""Likelihood, against that of a perfect hit, of a beam that ends anywhere else."""
_BEHIND: Final = 0.01
"""The same of a beam that goes through what the map says is solid."""
_SHARE: Final = 0.1
"""What one beam counts: neighbours, and the scans of nearby places, say much the same."""


@njit(cache=True, nogil=True, error_model="numpy")
def judge(
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    pose: Floats,
    mount: Floats,
    stride: int,
    fit: Floats,
) -> None:
    """Fill ``fit`` [5] with what each ``stride``-th beam, measured at ``pose`` [3], says of it.

    How many were looked at; how many of these end where the map has a surface; how many before
    (something that the map does not know) and how many behind (through something that it knows);
    and the logarithm of their likelihood, as evidence to compare poses by.
    """
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    x = pose[0] + cosine * mount[0] - sine * mount[1]
    y = pose[1] + sine * mount[0] + cosine * mount[1]
    fit[:] = 0.0
    for index in range(0, count, stride):
        along = cosine * ends[index, 2] - sine * ends[index, 3]
        across = sine * ends[index, 2] + cosine * ends[index, 3]
        length = math.hypot(ends[index, 0] - mount[0], ends[index, 1] - mount[1])
        slack = _SLACK + _SLACK_SHARE * length
        off, _, _ = look(field, place, x + length * along, y + length * across)
        expected = expected_range(field, place, x, y, along, across, length)
        fit[LOOKED_AT] += 1.0
        if expected < length - slack:
            fit[THROUGH] += 1.0
            fit[EVIDENCE] += _SHARE * math.log(_BEHIND)
            continue
        fit[AGREEING if abs(off) <= slack else SHORT] += 1.0
        share = off / _SPREAD
        fit[EVIDENCE] += _SHARE * math.log(
            _CHANCE + (1.0 - _CHANCE) * math.exp(-0.5 * share * share)
        )
