"""Finds faults of a drive's odometry by comparing it with scans: units, axes, and times.

Scans are matched without odometry, and the moves that they show are compared with the odometry's.
It does not matter how the lidar is mounted, nor where, up to 1 m from the robot's middle. Only what
no wheels do is reported: most ways or turns have other lengths, or other directions.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples, laid_on

_SELDOM: Final = 2.0
"""s; with a longer usual spacing of odometry, most scans are of times without odometry."""
_RARER: Final = 2.0
"""Times the spacing of scans; if scans are as rare as odometry, each scan has its odometry."""
_STEP, _STEP_TURN = 0.3, 0.4
"""m, rad; the farthest that a robot moves between two matched scans."""
_WAY, _TURN = 0.1, 0.15
"""m, rad; moves are compared that are by scans at least so long, or turn so far."""
_STRAIGHT: Final = 0.05
"""rad; directions are compared of moves that turn less."""
_ARM: Final = 1.0
"""m; the farthest that a lidar is from the robot's middle."""
_FITS: Final = 0.7
"""Mean likelihood above which two scans surely match: it is 0.8 and more where scans are dense, and
0.1 to 0.5 where they were taken a metre apart, which is farther than matches are looked for."""
_LONGEST: Final = 3.0
"""s; scans that are farther apart may show another place."""
_MATCHES: Final = 250
"""The most pairs of scans that are matched."""
_LEAST: Final = 8
"""Moves that are needed before anything is reported."""
_USUAL: Final = 0.5
"""Share of the scans that must match the one before, or nothing is reported."""
_SHARE, _WAY_NOISE, _TURN_NOISE = 0.5, 0.05, 0.1
"""Share of a move, m and rad, by which the odometry's move may differ and still agree."""
_AGREES: Final = 0.3
"""Share of moves that must agree, or the odometry is of no use."""
_INCOHERENT: Final = 0.01
"""Usual incoherence of good odometry: 0 if all directions agree with scans, 1 at random."""
_CLEARER: Final = 3.0
"""Ways count as mirrored if their incoherence is so many times that of the mirrored ways."""


class _Moves(NamedTuple):
    """Moves of the robot, each [n, 3], x, y, m, and turn, rad.

    They are by odometry, by odometry with x and y swapped, and by scans, which show the lidar's
    moves.
    """

    told: Floats
    mirrored: Floats
    shown: Floats

    def where(self, which: NDArray[np.bool_]) -> _Moves:
        """Return a selection of the moves."""
        return _Moves(*(moves[which] for moves in self))


def odometry_fault(samples: LidarSamples) -> str:
    """Return what is wrong with the odometry; "" if nothing is, or it is not clear."""
    period = samples.odometry_period
    if period > max(_SELDOM, _RARER * samples.period):
        return f"it comes once in {period:.1f} s"
    if samples.never_changes and samples.count > 1:
        return "it never changes"
    moves = _moves(samples)
    turned = np.abs(moves.shown[:, 2])
    ways = moves.where(_lengths(moves.shown) > _WAY)
    straight = moves.where((_lengths(moves.shown) > _WAY) & (turned < _STRAIGHT))
    turns = moves.where(turned > _TURN)
    return _wrong_ways(ways) or _wrong_turns(turns) or _mirrored_ways(straight)


def shown_headings(samples: LidarSamples) -> list[float]:
    """Return the robot's headings at the scans, rad, by matching scans without odometry.

    The first heading is 0. A scan that does not match the one before counts as no turn.
    """
    headings = [0.0] if samples.scans else []
    for one, other in pairwise(samples.scans):
        points = samples.points(one), samples.points(other)
        match = laid_on(*points, np.zeros(3), _STEP, _STEP_TURN, _FITS)
        headings.append(headings[-1] + (0.0 if match is None else float(match.pose[2])))
    return headings


def _wrong_ways(moves: _Moves) -> str:
    told, shown = _lengths(moves.told), _lengths(moves.shown)
    # In a turn, a lidar off the robot's middle moves another way than the middle.
    if not _disagrees(told, shown, _WAY_NOISE + _ARM * np.abs(moves.shown[:, 2])):
        return ""
    return f"it tells ways of {np.median(told):.3g} m where scans show {np.median(shown):.2f} m"


def _wrong_turns(moves: _Moves) -> str:
    told, shown = (np.abs(each[:, 2]) for each in (moves.told, moves.shown))
    if not _disagrees(told, shown, _TURN_NOISE):
        return ""
    return f"it tells turns of {np.median(told):.2f} rad where scans show {np.median(shown):.2f}"


def _mirrored_ways(moves: _Moves) -> str:
    if len(moves.told) < _LEAST:
        return ""
    off, mirrored_off = (_incoherence(each, moves.shown) for each in (moves.told, moves.mirrored))
    if off <= max(_INCOHERENT, _CLEARER * mirrored_off):
        return ""
    return "its ways fit what scans show better if they are mirrored: are x and y swapped?"


def _moves(samples: LidarSamples) -> _Moves:
    """Return moves by surely matching scans; none if most scans do not match."""
    rows: list[tuple[Floats, Floats, Floats]] = []
    scans = samples.scans[:_MATCHES]
    first, at, fitted = 0, np.zeros(3), 0
    for number in range(1, len(scans)):
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
            told = samples.between(base, sample)
            rows.append((told, _swapped(told, float(base.pose[2])), at))
            first, at = number, np.zeros(3)
    if fitted < _USUAL * (len(scans) - 1):
        rows = []
    return _Moves(*np.array(rows).reshape(-1, 3, 3).transpose(1, 0, 2))


def _lengths(moves: Floats) -> Floats:
    return np.asarray(np.hypot(moves[:, 0], moves[:, 1]))


def _swapped(move: Floats, heading: float) -> Floats:
    """Return a move, made at a heading, rad, as if x and y of the odometry were swapped."""
    turn = np.exp(1j * heading)
    way = complex(move[0], move[1]) * turn
    swapped = complex(way.imag, way.real) / turn
    return np.array([swapped.real, swapped.imag, move[2]])


def _disagrees(told: Floats, shown: Floats, noise: Floats | float) -> bool:
    """Whether most lengths by odometry differ from those by scans, with enough of them."""
    agrees = np.abs(told - shown) < _SHARE * shown + noise
    return len(agrees) >= _LEAST and float(agrees.mean()) < _AGREES


def _incoherence(told: Floats, shown: Floats) -> float:
    """Return how much directions of moves differ, 0..1, apart from how the lidar is mounted."""
    one, other = (np.exp(1j * np.arctan2(moves[:, 1], moves[:, 0])) for moves in (told, shown))
    return 1.0 - float(max(abs((one * other.conj()).mean()), abs((one * other).mean())))
