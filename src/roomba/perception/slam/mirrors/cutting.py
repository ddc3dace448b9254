"""Beams that a mirror reflected, cut off where they met the mirror."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats, Floats32
from roomba.perception.slam.submaps.pose_graph import relative_to

_BESIDE: Final = 0.1
"""m; a beam that passes so near beside a mirror's end may have met it, as poses are not exact."""


def cut_at(
    mirrors: Floats, pose: Floats, lidar: Floats, points: Floats32, open_ways: Floats32
) -> tuple[Floats32, Floats32]:
    """Return a scan's ``points``, [n, 4], and ``open_ways``, [m, 2], with nothing behind mirrors.

    ``open_ways`` are the ends of the scan's open ways; both are in the robot's frame. ``mirrors``
    are the two ends of each, float64 [k, 2, 2], m, map frame; ``pose``, [3], is the robot's in that
    frame, and ``lidar`` x and y in the robot's. A beam that passes a mirror is cut off on it, and
    its point faces the lidar. A beam that passes just beside a mirror is left out, for it may have
    met it. If there is no such beam the given arrays are returned.
    """
    if not len(mirrors):
        return points, open_ways
    seen = relative_to(pose[None], _with_headings(mirrors))[:, :2].reshape(-1, 2, 2)
    return _cut(seen, lidar, points), _cut(seen, lidar, open_ways)


def _with_headings(mirrors: Floats) -> Floats:
    """Return the ends of mirrors as poses, float64 [2 k, 3]."""
    return np.column_stack((mirrors.reshape(-1, 2), np.zeros(2 * len(mirrors))))


def _cut(mirrors: Floats, lidar: Floats, ends: Floats32) -> Floats32:
    """Return beams' ends, [n, 2] or with normals [n, 4], with none behind a mirror."""
    beams = ends[:, :2] - lidar
    first, is_doubtful = np.ones(len(ends)), np.zeros(len(ends), np.bool_)
    after = ends
    for start, end in mirrors:
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        normal = np.array([-along[1], along[0]])
        away = float((start - lidar) @ normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = away / (beams @ normal)
            there = lidar + share[:, None] * beams
            place = (there - start) @ along
        passes = (share > 0.0) & (share < first)
        met = passes & (place >= 0.0) & (place <= length)
        is_doubtful |= passes & ~met & (place > -_BESIDE) & (place < length + _BESIDE)
        if met.any():
            first[met] = share[met]
            after = after.copy() if after is ends else after
            after[met, :2] = there[met]
            after[met, 2:] = (-np.sign(away) * normal)[: ends.shape[1] - 2]
    left_out = is_doubtful & (first == 1.0)
    return after[~left_out] if left_out.any() else after
