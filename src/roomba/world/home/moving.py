"""Unrolls the scripts of what moves into tracks over a whole day.

A track is float64 [rows, 5]: time, s; x and y, m, and theta, rad, in the map frame; present, 1 or
0. Times begin at 0 and never decrease. From row to row the thing goes evenly, turning the shorter
way round, and is present as the earlier row says; after the last row it stays as that one says.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.files.home_layer import DAY
from roomba.geometry import Pose, wrap_angle
from roomba.world.home.home import MovingThing, Script

TIME, X, Y, THETA, PRESENT = range(5)
"""Columns of a track."""

Track = NDArray[np.float64]
_Row = tuple[float, float, float, float, float]


def tracks_of(things: Iterable[MovingThing], random: np.random.Generator) -> list[Track]:
    """Return each thing's track of a day; random delays of its occurrences are drawn in order."""
    return [_track(thing, random) for thing in things]


def pose_at(track: Track, time: float) -> tuple[float, float, float, bool]:
    """Return (x, y, theta, present) at ``time``, s; theta in (-pi, pi].

    Plain and slow: the simulator's compiled code is tested against this function.
    """
    last = max(0, int(np.searchsorted(track[:, TIME], time, side="right")) - 1)
    start, x, y, theta, present = track[last].tolist()
    if last + 1 < len(track) and time > start:
        end, next_x, next_y, next_theta, _ = track[last + 1].tolist()
        share = (time - start) / (end - start)
        x += share * (next_x - x)
        y += share * (next_y - y)
        theta += share * wrap_angle(next_theta - theta)
    return x, y, wrap_angle(theta), bool(present)


def _track(thing: MovingThing, random: np.random.Generator) -> Track:
    rows = [_row(0.0, thing.pose, thing.is_present)]
    pose = thing.pose
    for start in _starts(thing.script, random):
        for move in thing.script.moves:
            if move.takes > 0.0:
                rows.append(_row(start + move.begins, pose, move.is_present))
            rows.append(_row(start + move.ends, move.pose, move.is_present))
            pose = move.pose
    track = np.array(_without_repetitions(rows), np.float64)
    # The sums of starts and times are rounded, which must not turn time back.
    track[:, TIME] = np.maximum.accumulate(track[:, TIME])
    return track


def _starts(script: Script, random: np.random.Generator) -> list[float]:
    """Return when each occurrence of a script starts, s: its period's start plus a random delay."""
    if not script.moves or script.moves[-1].ends > DAY:
        return []
    first, last = script.moves[0].begins, script.moves[-1].ends
    count = 1 if script.period <= 0.0 else 1 + int((DAY - last) // script.period)
    planned = script.period * np.arange(count)
    spare = DAY - last - planned
    if script.period > 0.0:
        spare = np.minimum(spare, script.period - (last - first))
    put_off = np.clip(spare, 0.0, script.jitter) * random.random(count)
    return [float(start) for start in planned + put_off]


def _row(time: float, pose: Pose, is_present: bool) -> _Row:
    return time, pose.x, pose.y, pose.theta, float(is_present)


def _without_repetitions(rows: Sequence[_Row]) -> list[_Row]:
    return [row for index, row in enumerate(rows) if index == 0 or row != rows[index - 1]]
