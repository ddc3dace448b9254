"""What is wrong with the gyro of a drive, as its scans show: how far it says that the robot turned.

A gyro counts more than wheels do, so that one which stands still, is mirrored, measures about
another axis or in degrees bends the map. Only what no good gyro does is told: turns that are others
than those of scans and of odometry, which agree, most of the time.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_mount import shown_moves

_TURN: Final = 0.2
"""rad; turns are compared that scans show to be so large."""
_LEAST: Final = 8
"""Turns from which anything is said."""
_SELDOM: Final = 0.3
"""s between two samples; of a time in which they are rarer a gyro tells no turn."""
_SHARE, _NOISE, _BIAS = 0.5, 0.1, 0.05
"""Share of a turn, rad, and rad/s, by which another turn may be told and agree."""
_MOST: Final = 0.7
"""Share of the turns that agree, or do not, if anything is said."""


class _Turns(NamedTuple):
    """Turns of the robot, rad, each [n], and how long they took, s."""

    by_gyro: Floats
    by_odometry: Floats
    by_scans: Floats
    spent: Floats

    def agreeing(self, told: Floats) -> float:
        """Return the share of turns as ``told`` that scans show as well."""
        allowed = _SHARE * np.abs(self.by_scans) + _NOISE + _BIAS * self.spent
        return float(np.mean(np.abs(told - self.by_scans) < allowed))


def gyro_fault(samples: LidarSamples) -> str:
    """Return what is wrong with the gyro; "" if nothing is, or nothing is clear."""
    turns = _turns(samples)
    if len(turns.spent) < _LEAST or turns.agreeing(turns.by_odometry) < _MOST:
        return ""
    if turns.agreeing(turns.by_gyro) > 1.0 - _MOST:
        return ""
    if turns.agreeing(-turns.by_gyro) > _MOST:
        return "it turns the other way than scans and odometry, as one that hangs upside down"
    told, shown = (float(np.median(np.abs(each))) for each in (turns.by_gyro, turns.by_scans))
    return f"it tells turns of {told:.2g} rad where scans and odometry show {shown:.2f}"


def _turns(samples: LidarSamples) -> _Turns:
    """Return the turns of which scans, odometry and gyro tell."""
    rows = []
    for move in shown_moves(samples):
        by_gyro = _turned(samples.turnings, move.begin, move.end)
        if by_gyro is not None and abs(move.shown[2]) > _TURN:
            rows.append((by_gyro, move.told[2], move.shown[2], move.end - move.begin))
    return _Turns(*np.array(rows).reshape(-1, 4).T)


def _turned(turnings: Floats, begin: float, end: float) -> float | None:
    """Return how far a gyro turned between two times, rad; None if it tells too seldom."""
    stamps, speeds = turnings.T
    first = int(np.searchsorted(stamps, begin, "right")) - 1
    last = int(np.searchsorted(stamps, end, "left"))
    if first < 0 or last >= len(stamps) or np.diff(stamps[first : last + 1]).max() > _SELDOM:
        return None
    times = np.concatenate(([begin], stamps[first + 1 : last], [end]))
    told = np.interp(times, stamps[first : last + 1], speeds[first : last + 1])
    return float(0.5 * (told[1:] + told[:-1]) @ np.diff(times))
