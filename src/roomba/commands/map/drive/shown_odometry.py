"""What is wrong with the odometry of a drive, as its scans show: units, axes, and times.

Scans are laid on each other without any odometry, and the moves that they show are compared with
those that the odometry tells. How the lidar is mounted does not count. Only what no wheels do is
told: ways or turns of other lengths, or in other directions, most of the time.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.commands.map.drive.lidar_samples import Floats, LidarSamples, laid_on

_SELDOM, _RARER = 2.0, 2.0
"""s between two messages, as a rule, and times as much as between two scans, from which most scans
are of times of which no odometry tells."""
_STEP, _STEP_TURN = 0.3, 0.4
"""m, rad; a robot moves no farther between two scans that are laid on each other."""
_WAY, _TURN = 0.1, 0.15
"""m, rad; moves are compared that scans show to be so long, or turned so far."""
_FITS: Final = 0.7
"""Mean likelihood of points, from which scans surely lie on each other: 0.8 and more where they are
dense, 0.1 to 0.5 where they were taken a metre apart, which is farther than they are looked for."""
_LONGEST: Final = 3.0
"""s between two scans that are compared, at most: they show the same place."""
_MATCHES: Final = 250
"""Pairs of scans that are laid on each other at most."""
_LEAST: Final = 8
"""Moves from which anything is said."""
_USUAL: Final = 0.5
"""Share of the scans that fit the one before, from which anything is said."""
_SHARE, _WAY_NOISE, _TURN_NOISE = 0.5, 0.05, 0.1
"""A share of a move, m and rad, by which the odometry may tell another one and agree."""
_AGREES: Final = 0.3
"""Share of the moves that agree, from which the odometry is of use."""
_INCOHERENT: Final = 0.01
"""By so much directions are not as scans show them, as a rule: 0 of all that are, 1 of any ones."""
_CLEARER: Final = 3.0
"""Times as much as mirrored ways are not, from which ways are taken to be mirrored."""


def odometry_fault(samples: LidarSamples) -> str:
    """Return what is wrong with the odometry; "" if nothing is, or nothing is clear."""
    period = samples.odometry_period
    if period > max(_SELDOM, _RARER * samples.period):
        return f"it comes once in {period:.1f} s"
    told, mirrored, shown = _moves(samples)
    ways_told, ways = (np.hypot(moves[:, 0], moves[:, 1]) for moves in (told, shown))
    turns_told, turns = (np.abs(moves[:, 2]) for moves in (told, shown))
    is_far, is_turned = ways > _WAY, turns > _TURN
    if _disagrees(ways_told[is_far], ways[is_far], _WAY_NOISE):
        middle = np.median(ways_told[is_far]), np.median(ways[is_far])
        return "it tells ways of {:.3g} m where scans show {:.2f} m".format(*middle)
    if _disagrees(turns_told[is_turned], turns[is_turned], _TURN_NOISE):
        middle = np.median(turns_told[is_turned]), np.median(turns[is_turned])
        return "it tells turns of {:.2g} rad where scans show {:.2f} rad".format(*middle)
    if is_far.sum() >= _LEAST:
        off = _incoherence(told[is_far], shown[is_far])
        if off > max(_INCOHERENT, _CLEARER * _incoherence(mirrored[is_far], shown[is_far])):
            return "its ways fit what scans show better if they are mirrored: are x and y swapped?"
    return ""


def _moves(samples: LidarSamples) -> tuple[Floats, Floats, Floats]:
    """Return moves as odometry tells them, the same if it had x and y swapped, and as scans show
    them: each [n, 3], m and rad.
    """
    told, mirrored, shown = [], [], []
    scans = samples.scans
    first, at = 0, np.zeros(3)
    tried, fitted = min(len(scans), _MATCHES), 0
    for number in range(1, tried):
        base, sample = scans[first], scans[number]
        match = None
        if sample.stamp - base.stamp <= _LONGEST:
            points = samples.points(base), samples.points(sample)
            match = laid_on(*points, at, _STEP, _STEP_TURN, _FITS)
        if match is None:
            first, at = number, np.zeros(3)
            continue
        fitted += 1
        at = match.pose
        if math.hypot(at[0], at[1]) > _WAY or abs(at[2]) > _TURN:
            move = samples.between(base, sample)
            told.append(move)
            mirrored.append(_swapped(move, float(base.pose[2])))
            shown.append(at)
            first, at = number, np.zeros(3)
    end = len(told) if fitted > _USUAL * tried else 0
    moves = (np.array(each[:end]).reshape(-1, 3) for each in (told, mirrored, shown))
    return next(moves), next(moves), next(moves)


def _swapped(move: Floats, heading: float) -> Floats:
    """Return a move from a pose with a heading, rad, if x and y of the odometry were swapped."""
    turn = np.exp(1j * heading)
    way = complex(move[0], move[1]) * turn
    swapped = complex(way.imag, way.real) / turn
    return np.array([swapped.real, swapped.imag, move[2]])


def _disagrees(told: Floats, shown: Floats, noise: float) -> bool:
    """Whether most of enough lengths are told otherwise than they are shown."""
    agrees = np.abs(told - shown) < _SHARE * shown + noise
    return len(agrees) >= _LEAST and float(agrees.mean()) < _AGREES


def _incoherence(told: Floats, shown: Floats) -> float:
    """Return how unlike directions of moves are, 0..1, whichever way the lidar looks or hangs."""
    one, other = (np.exp(1j * np.arctan2(moves[:, 1], moves[:, 0])) for moves in (told, shown))
    return 1.0 - float(max(abs((one * other.conj()).mean()), abs((one * other).mean())))
