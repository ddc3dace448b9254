"""Wrapping of angles for kernels and arrays; :func:`roomba.geometry.wrap_angle` is for numbers.

All three return the same bits for the same angle, and NaN of what is not finite.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from roomba.geometry import TWO_PI, wrap_angle

wrapped: Final[Callable[[float], float]] = register_jitable(wrap_angle)
""":func:`roomba.geometry.wrap_angle`, for compiled callers as well."""


def wrap_angles(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the same directions in (-pi, pi], rad, in an array of the same shape."""
    if ((angles > -math.pi) & (angles <= math.pi)).all():
        return angles.copy()
    turns = np.where(np.abs(angles) > TWO_PI, np.fmod(angles, TWO_PI), angles)
    turns = np.where(turns > math.pi, turns - TWO_PI, turns)
    return np.where(turns > -math.pi, turns, turns + TWO_PI)
