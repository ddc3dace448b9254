"""Follows a point ahead on the path; turns on the spot where there is much to turn."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


class Progress:
    """The path that is followed, and how far along it the robot has come, m."""

    path: list[tuple[float, float]] | None = None
    along = 0.0


def drive(
    pose: tuple[float, float, float], path: list[tuple[float, float]], speed: float
) -> tuple[float, float]:
    points = np.array(path)
    lengths = np.hypot(*np.diff(points, axis=0).T)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    if path is not Progress.path:
        Progress.path, Progress.along = path, 0.0
    x, y, theta = pose

    def at(along: float) -> NDArray[np.float64]:
        return np.array([np.interp(along, ends, column) for column in points.T])

    near = np.arange(Progress.along, Progress.along + 0.15, 0.005)
    near = near[near <= ends[-1]] if (near <= ends[-1]).any() else np.array([ends[-1]])
    away = [float(np.hypot(*(at(along) - (x, y)))) for along in near]
    along = float(near[int(np.argmin(away))])
    Progress.along = along
    left = math.hypot(points[-1, 0] - x, points[-1, 1] - y)
    if along > ends[-1] - 0.03 and left < 0.03:
        return 0.0, 0.0
    ahead = at(min(along + 0.08, float(ends[-1])))
    turn = math.atan2(ahead[1] - y, ahead[0] - x) - theta
    turn = (turn + math.pi) % (2.0 * math.pi) - math.pi
    slow = max(0.0, 1.0 - abs(turn) / 0.5)
    return max(min(speed, 1.5 * left) * slow, 0.02 if slow > 0.0 else 0.0), 2.5 * turn
