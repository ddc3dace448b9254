"""Finds out how a lidar is mounted by comparing its motion with the odometry.

The lidar's motion follows from matching its scans, without odometry. A lidar that hangs the other
way round turns in the opposite direction; one that looks another way moves another way. Where it is
on the robot has an effect as well (as in Censi et al., "Simultaneous calibration of odometry and
sensor parameters for mobile robots", 2013), but is not reported: it is less certain.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples, Sample, laid_on

_WAY, _TURN = 0.3, 0.3
"""m, rad; two scans are compared when the robot moved at least so far, or turned so much."""
_MOST_WAY, _MOST_TURN = 1.0, 0.8
"""m, rad; scans that are farther apart show other places."""
_MORE_WAY, _MORE_TURN = 0.2, 0.15
"""m, rad; the most by which the robot may have moved farther than odometry says."""
_PAIRS: Final = 60
"""The most pairs of scans that are compared."""
_LEAST_PAIRS: Final = 5
_LEAST_TURNED: Final = 0.1
"""rad2; sum of squared turns between compared scans that is needed to report anything."""
_LEAST_MOVED: Final = 0.2
"""m2; the same for the distances moved."""
_AGREE: Final = 0.1
"""The largest residual that counts as agreement, as a share of squared turns, or of squared
ways."""
_NOISE: Final = 0.03
"""m; the least error of a move by scans."""
_ASIDE: Final = 0.3
"""m; usual distance of a lidar from the robot's middle. If a robot only drives in a circle, that
distance and the lidar's direction can hardly be told apart."""
_CLEAR: Final = 4.0
"""Standard errors by which a sideways direction must fit better than looking ahead."""
_YAWS: Final = np.linspace(-math.pi, math.pi, 721)
"""rad; ways to look that are compared, half a degree apart."""


class ShownMove(NamedTuple):
    """A move from the stamp ``begin`` to ``end``, s.

    ``told`` is the move by odometry, ``shown`` by scans alone, both [3]: ahead, left, turned.
    """

    begin: float
    end: float
    told: Floats
    shown: Floats


class ShownMount(NamedTuple):
    """How the lidar is mounted by its scans, relative to the mount that was assumed.

    If it ``is_turned_over``, it hangs upside down instead of upright, or the other way round. It
    looks ``yaw``, rad, farther to the left than was assumed, or, if turned over, than the assumed
    mount turned over about the robot's long axis; 0 where that is not clear.
    """

    is_turned_over: bool
    yaw: float


def shown_mount(samples: LidarSamples) -> ShownMount | None:
    """Return the mount as far as it is clear; None if nothing is."""
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
    """Return the angle to the left, rad, between scans' and odometry's ahead; 0: not clear.

    A move by odometry and by scans differs by that angle, and by the arc of a lidar that is not in
    the robot's middle when the robot turns. Where the lidar is follows by least squares.
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
