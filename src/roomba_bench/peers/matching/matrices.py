"""Poses in the plane as the matrices that registering programs take and give."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def matrix_of(pose: Sequence[float] | Floats) -> Floats:
    """Return a pose x, y, theta, m and rad, as float64 [4, 4]; it lies on the floor."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    matrix = np.eye(4)
    matrix[:2] = [[cosine, -sine, 0.0, pose[0]], [sine, cosine, 0.0, pose[1]]]
    return matrix


def pose_of(matrix: Floats) -> tuple[float, float, float]:
    """Return x, y, theta, m and rad, of a matrix [4, 4]; what leaves the floor is left out."""
    return matrix[0, 3], matrix[1, 3], math.atan2(matrix[1, 0], matrix[0, 0])
