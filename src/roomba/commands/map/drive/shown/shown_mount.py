"""How a lidar is mounted, as its scans show: how they move against what the odometry says.

Scans are laid on each other without any odometry. A lidar that is taken to hang the other way round
shows all turns in the opposite direction; one that looks another way shows the robot moving another
way. Where it is on the robot counts as well (as in Censi et al., "Simultaneous calibration of
odometry and sensor parameters for mobile robots", 2013), but is not told: it is less sure.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples, Sample, laid_on

_WAY, _TURN = 0.3, 0.3
"""m, rad; two scans are compared between which the robot moved so far, or turned."""
_MOST_WAY, _MOST_TURN = 1.0, 0.8
"""m, rad; no more than that, or they show other places."""
_MORE_WAY, _MORE_TURN = 0.2, 0.15
"""m, rad; by which the robot may have moved more than the odometry says."""
_PAIRS: Final = 60
"""Pairs of scans that are compared at most."""
_LEAST_PAIRS: Final = 5
_LEAST_TURNED: Final = 0.1
"""rad2; sum of squared turns between compared scans, from which anything is said."""
_LEAST_MOVED: Final = 0.2
"""m2; the same of ways."""
_AGREE: Final = 0.1
"""Share of the squared turns, and of the ways, that may be left to agree."""
_NOISE: Final = 0.03
"""m; by which scans tell a move wrong, at least."""
_ASIDE: Final = 0.3
"""m; so far a lidar is off the robot's middle as a rule. Of a robot that goes round in a circle
alone, where it is and which way it looks are hardly to be told apart."""
_CLEAR: Final = 4.0
"""Standard errors by which a lidar that looks aside must fit better than one that looks ahead."""
_YAWS: Final = np.linspace(-math.pi, math.pi, 721)
"""rad; ways to look that are compared, half a degree apart."""


class ShownMove(NamedTuple):
    """A move from the stamp ``begin`` to ``end``, s.

    The odometry has it as ``told``, and scans alone as ``shown``, both [3]: ahead, left, turned.
    """

    begin: float
    end: float
    told: Floats
    shown: Floats


class ShownMount(NamedTuple):
    """What scans show of a lidar against how it was taken to be mounted.

    It ``is_turned_over``, upside down instead of upright or the other way round, and looks ``yaw``,
    rad, farther to the left than it was taken to, or than it would if it were turned over about the
    robot's long axis; 0 where that is not clear.
    """

    is_turned_over: bool
    yaw: float


def shown_mount(samples: LidarSamples) -> ShownMount | None:
    """Return what is clear; None if nothing is."""
    found = shown_moves(samples)
    if len(found) < _LEAST_PAIRS:
        return None
    moves = np.array([(move.told, move.shown) for move in found])
    by_odometry, by_scans = moves[:, 0], moves[:, 1]
    turned = float((by_odometry[:, 2] ** 2).sum())
    alike, opposite = (
        float(((by_scans[:, 2] - sign * by_odometry[:, 2]) ** 2).sum()) for sign in (1.0, -1.0)
    )
    is_turned_over = opposite < alike
    if turned < _LEAST_TURNED or min(alike, opposite) > _AGREE * max(alike, opposite):
        return None
    if is_turned_over:
        by_scans = by_scans * (1.0, -1.0, -1.0)
    return ShownMount(is_turned_over, _yaw(by_odometry, by_scans))


def shown_moves(samples: LidarSamples) -> list[ShownMove]:
    """Return moves by the odometry and by scans alone, in the order of time."""
    chosen: list[Sample] = []
    for sample in samples.scans:
        if chosen:
            x, y, turn = samples.between(chosen[-1], sample).tolist()
        if not chosen or math.hypot(x, y) > _WAY or abs(turn) > _TURN:
            chosen.append(sample)
        if len(chosen) > _PAIRS:
            break
    moves = []
    for before, sample in pairwise(chosen):
        told = samples.between(before, sample)
        way, turn = math.hypot(told[0], told[1]), abs(float(told[2]))
        if way > _MOST_WAY or turn > _MOST_TURN:
            continue
        place, points = samples.points(before), samples.points(sample)
        match = laid_on(place, points, np.zeros(3), way + _MORE_WAY, turn + _MORE_TURN)
        if match is not None:
            moves.append(ShownMove(before.stamp, sample.stamp, told, match.pose))
    return moves


def _yaw(by_odometry: Floats, by_scans: Floats) -> float:
    """Return how far to the left the odometry sees what scans show as ahead, rad; 0: not clear.

    What both say of a move differs by that turn, and by what the lidar, which is not where the
    robot's middle is, moves on an arc when the robot turns: where it is follows by least squares.
    """
    x, y, turns = by_scans[:, 0], by_scans[:, 1], by_odometry[:, 2]
    told = np.concatenate((by_odometry[:, 0], by_odometry[:, 1]))
    cosine, sine = 1.0 - np.cos(turns), np.sin(turns)
    arcs = np.vstack((np.column_stack((cosine, sine)), np.column_stack((-sine, cosine))))
    rows = np.vstack((arcs, np.eye(2) * (_NOISE / _ASIDE)))
    along, across = np.cos(_YAWS)[:, None], np.sin(_YAWS)[:, None]
    shown = np.hstack((along * x - across * y, across * x + along * y))
    missing = np.hstack((told - shown, np.zeros((len(_YAWS), 2)))).T
    places = np.linalg.lstsq(rows, missing, rcond=None)[0]
    off = ((missing - rows @ places) ** 2).sum(axis=0)
    best, ahead = int(off.argmin()), len(_YAWS) // 2
    moved = float(told @ told)
    if moved < _LEAST_MOVED or off[best] > _AGREE * moved:
        return 0.0
    variance = max(float(off[best]) / len(rows), _NOISE**2)
    is_clear = off[ahead] - off[best] > _CLEAR**2 * variance
    return float(_YAWS[best]) if is_clear else 0.0
