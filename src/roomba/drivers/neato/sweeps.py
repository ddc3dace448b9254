"""The times of a lidar's sweeps, which the robot tells on request and without a time.

The robot tells its newest whole sweep, which may have ended just now or a turn ago. When it is
asked more often than the lidar turns, a sweep that differs from the one before ended between the
two questions. Sweeps end a turn apart, so the bounds of one narrow down those of the next. When it
is asked more seldom, all that is known is that the sweep ended within the last turn.
"""

from __future__ import annotations

import math
from typing import Final

_DRIFT: Final = 0.005
"""Share of the passed time by which the lidar may turn faster or slower than it tells."""

_TURNS_AS_NEWEST: Final = 1.4
"""Turns after its end when a sweep cannot be the newest one any more."""

_Bounds = tuple[float, float]


class SweepClock:
    """Bounds of when the newest sweep ended, s."""

    def __init__(self) -> None:
        """Know nothing."""
        self._asked = -math.inf
        self._bounds: _Bounds = (-math.inf, math.inf)

    def ended(self, asked: float, turn: float, *, is_other: bool) -> float | None:
        """Return when the sweep that was told at ``asked``, s, ended; None if it was told before.

        ``turn`` is how long a sweep takes, s. ``is_other`` says that it differs from the one that
        was told before. An equal one counts as new once the one before is too old to be the newest.
        """
        before, self._asked = self._asked, asked
        newest = asked - turn, asked
        if is_other:
            return self._taken((max(before, newest[0]), asked), turn)
        if asked - _middle(self._bounds) > _TURNS_AS_NEWEST * turn:
            return self._taken(newest, turn)
        return None

    def _taken(self, seen: _Bounds, turn: float) -> float:
        """Return when a sweep ended that did so within ``seen``, and keep the bounds of that."""
        expected = self._expected(seen, turn)
        both = [_common(seen, each) for each in expected] or [seen]
        most = max(both, key=_width)
        # Where two sweeps may be meant, ``seen`` tells nothing of when either of them ended.
        self._bounds = expected[both.index(most)] if len(both) > 1 else most
        return _middle(most)

    def _expected(self, seen: _Bounds, turn: float) -> list[_Bounds]:
        """Return the ends, predicted by earlier sweeps, that may lie within ``seen``, as bounds.

        Empty where the bounds of the earlier ones are as wide as a turn: they predict nothing.
        """
        low, high = self._bounds
        if not high - low < turn:
            return []
        turns = math.floor((seen[1] - _middle(self._bounds)) / turn)
        later = [(turns + more) * turn for more in (-1, 0, 1)]
        ends = [(low + each * (1.0 - _DRIFT), high + each * (1.0 + _DRIFT)) for each in later]
        return [each for each in ends if _width(_common(seen, each)) >= 0.0]


def _common(one: _Bounds, other: _Bounds) -> _Bounds:
    return max(one[0], other[0]), min(one[1], other[1])


def _width(bounds: _Bounds) -> float:
    return bounds[1] - bounds[0]


def _middle(bounds: _Bounds) -> float:
    return 0.5 * (bounds[0] + bounds[1])
