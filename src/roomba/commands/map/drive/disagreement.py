"""Times of a drive in which odometry and the map tell of different ways.

Wheels may slip. Scans may mislead as well: in a bare corridor, something that moves along with the
robot looks as if the robot stood. Nothing shows which of both was right, so the people who look at
the map must judge.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats

_COMPARED_OVER: Final = 3.0
"""s over which both distances are compared: for a moment odometry is often off."""
_FAR: Final = 0.5
_SHARE: Final = 0.4
"""m, and share of the longer distance, by which both must differ: wheels slip by less."""
_MOST_TOLD: Final = 3
"""The most times that are listed one by one."""


class Disagreement(NamedTuple):
    """From ``begin`` to ``end``, s since the drive began: the way on the map, and by odometry
    alone, m.
    """

    begin: float
    end: float
    by_map: float
    by_odometry: float


def disagreements(on_map: Floats, by_odometry: Floats) -> list[Disagreement]:
    """Return when the two disagree, in the order of time.

    Both are rows of t (s), x, y (m), theta; a scan that only one of them has does not count.
    """
    _, ours, theirs = np.intersect1d(on_map[:, 0], by_odometry[:, 0], return_indices=True)
    if len(ours) < 2:
        return []
    places = on_map[ours, 1:3], by_odometry[theirs, 1:3]
    stamps = on_map[ours, 0] - by_odometry[0, 0]
    lasts = np.searchsorted(stamps, stamps + _COMPARED_OVER)
    firsts = np.flatnonzero(lasts < len(stamps))
    lasts = lasts[firsts]
    mapped, reckoned = (np.hypot(*(place[lasts] - place[firsts]).T) for place in places)
    differs = np.abs(mapped - reckoned) >= np.maximum(_FAR, _SHARE * np.maximum(mapped, reckoned))
    return [
        Disagreement(
            *stamps[[first, last]].tolist(),
            *(_way_of(place[_apart_in(stamps, first, last)]) for place in places),
        )
        for first, last in _joined(firsts[differs].tolist(), lasts[differs].tolist())
    ]


def told_disagreements(found: Sequence[Disagreement]) -> list[str]:
    """Return in words when the map and odometry disagree: a note, or none."""
    if not found:
        return []
    longest = sorted(sorted(found, key=_apart, reverse=True)[:_MOST_TOLD])
    times = [
        f"{each.begin:.0f} to {each.end:.0f} s ({each.by_map:.1f} m on the map, "
        f"{each.by_odometry:.1f} m by odometry)"
        for each in longest
    ]
    more = len(found) - len(longest)
    return [
        f"scans and odometry disagree about the way from {', from '.join(times)}"
        + (f", and {more} times more" if more else "")
        + ": it is drawn as scans show it, and may be too short or too long there"
    ]


def _apart_in(stamps: Floats, first: int, last: int) -> list[int]:
    """Return rows from first to last, spaced by the time over which distances are compared."""
    rows = [first]
    while rows[-1] < last:
        next_one = int(np.searchsorted(stamps, stamps[rows[-1]] + _COMPARED_OVER))
        rows.append(min(max(next_one, rows[-1] + 1), last))
    return rows


def _way_of(places: Floats) -> float:
    """Return the distance along places, m; with close places, their jitter would add up."""
    return float(np.hypot(*np.diff(places, axis=0).T).sum())


def _apart(found: Disagreement) -> float:
    return abs(found.by_map - found.by_odometry)


def _joined(firsts: list[int], lasts: list[int]) -> list[tuple[int, int]]:
    """Return stretches in order; those that overlap are joined."""
    joined: list[tuple[int, int]] = []
    for first, last in zip(firsts, lasts, strict=True):
        if joined and first <= joined[-1][1]:
            joined[-1] = joined[-1][0], last
        else:
            joined.append((first, last))
    return joined
