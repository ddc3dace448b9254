"""Beams that are hidden by a thing on the robot: a bracket, a screen, what it carries.

The lidar sees such a thing at the same bearings and ranges wherever the robot is. By these beams
scans fit each other best if the robot is taken to stand, so they must not count. Along a corridor
the walls beside the robot stay as far away, too, but not when it turns. So scans of different
headings are compared, and only where other beams show that the robot did turn.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats, Mask
from roomba.recordings.readings import LidarScan

_TURNED: Final = 0.5
"""rad between two scans that are compared: a wall that was met squarely is then 14 % farther."""
_SAME: Final = (0.04, 0.03)
"""m, and share of the range, by which two ranges of one thing differ at most: noise of lidars."""
_FARTHEST: Final = 2.0
"""m; what goes with a robot is nearer."""
_SHOWS_TURN: Final = 0.15
"""Share of the beams that must show another range in a scan of a robot that turned. If nearly all
show the same, it stood, and odometry is wrong."""
_COMPARISONS: Final = 6
"""Comparisons, of at least 3 rad of turns, that are needed."""
_MOSTLY: Final = 0.9
"""Share of them in which a fixed beam shows the same."""


def fixed_beams(ranges: NDArray[np.float32], headings: Floats) -> Mask:
    """Return which beams, [beams], are hidden by a thing on the robot.

    ``ranges`` is [scans, beams], m, in the order of time, and ``headings`` [scans], rad, not
    wrapped, are those by odometry. What is not finite met nothing.
    """
    beams = ranges.shape[1]
    compared, same = np.zeros(beams, np.int64), np.zeros(beams, np.int64)
    before = 0
    for number in range(1, len(ranges)):
        if abs(headings[number] - headings[before]) < _TURNED:
            continue
        one, other = ranges[before], ranges[number]
        before = number
        has_met = np.isfinite(one) & np.isfinite(other) & (one > 0.0) & (other > 0.0)
        one, other = np.where(has_met, one, 0.0), np.where(has_met, other, 0.0)
        is_same = has_met & (np.abs(one - other) < _SAME[0] + _SAME[1] * one)
        if np.count_nonzero(has_met & ~is_same) < _SHOWS_TURN * np.count_nonzero(has_met):
            continue
        compared += has_met
        same += is_same & (one < _FARTHEST)
    return np.asarray((compared >= _COMPARISONS) & (same >= _MOSTLY * compared))


class UnhiddenScans:
    """Makes scans in which the fixed beams tell nothing, as if they met something too near."""

    def __init__(self, fixed: Mask) -> None:
        """Take the ``fixed`` beams, [beams]; a scan of another number of beams stays as it is."""
        self._fixed = fixed

    def of(self, scan: LidarScan) -> LidarScan:
        """Return a scan with -inf at the fixed beams, which is REP 117's value for too near."""
        if len(scan.ranges) != len(self._fixed):
            return scan
        return LidarScan(np.where(self._fixed, np.float32(-np.inf), scan.ranges), scan.lidar)
