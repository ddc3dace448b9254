"""Finds faults of a drive's gyro by comparing its turns with those that scans show.

A gyro counts more than wheels do. So a gyro that stands still, is mirrored, measures about another
axis or in degrees bends the map. Only what no good gyro does is reported: most of its turns differ
from those on which scans and odometry agree.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_mount import shown_moves

_TURN: Final = 0.2
"""rad; only turns that scans show to be at least so large are compared."""
_LEAST: Final = 8
"""Turns that are needed before anything is reported."""
_SELDOM: Final = 0.3
"""s between two samples; where samples are rarer, the gyro shows no turn."""
_SHARE, _NOISE, _BIAS = 0.5, 0.1, 0.05
"""Share of a turn, rad, and rad/s, by which the gyro's turn may differ and still agree."""
_MOST: Final = 0.7
"""Share of the turns that must agree, or differ, before anything is reported."""


class _Turns(NamedTuple):
    """Turns of the robot, rad, each [n], and how long they took, s."""

    by_gyro: Floats
    by_odometry: Floats
    by_scans: Floats
    spent: Floats

    def agreeing(self, told: Floats) -> float:
        """Return the share of the turns ``told`` that agree with those of scans."""
        allowed = _SHARE * np.abs(self.by_scans) + _NOISE + _BIAS * self.spent
        return float(np.mean(np.abs(told - self.by_scans) < allowed))


def gyro_fault(samples: LidarSamples) -> str:
    """Return what is wrong with the gyro; "" if nothing is, or it is not clear."""
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
    """Return turns with their measurements by scans, odometry and gyro."""
    rows = []
    for move in shown_moves(samples):
        by_gyro = _turned(samples.turnings, move.begin, move.end)
        if by_gyro is not None and abs(move.shown[2]) > _TURN:
            rows.append((by_gyro, move.told[2], move.shown[2], move.end - move.begin))
    return _Turns(*np.array(rows).reshape(-1, 4).T)


def _turned(turnings: Floats, begin: float, end: float) -> float | None:
    """Return how far the gyro turned between two times, rad; None with too few samples."""
    stamps, speeds = turnings.T
    first = int(np.searchsorted(stamps, begin, "right")) - 1
    last = int(np.searchsorted(stamps, end, "left"))
    if first < 0 or last >= len(stamps) or np.diff(stamps[first : last + 1]).max() > _SELDOM:
        return None
    times = np.concatenate(([begin], stamps[first + 1 : last], [end]))
    told = np.interp(times, stamps[first : last + 1], speeds[first : last + 1])
    return float(0.5 * (told[1:] + told[:-1]) @ np.diff(times))
