"""When the sweeps of a lidar were measured that are told on asking, without a time.

A robot tells its newest whole sweep, which may have ended just now or a turn ago. Asked more often
than it turns, the sweep that is another one than before ended between the two questions; and sweeps
end a turn apart, so what was learned of one narrows down the next. Asked more seldom, nothing is
learned: it ended some time within the last turn.
"""

from __future__ import annotations

import math
from typing import Final

_DRIFT: Final = 0.005
"""Share of the time that passed by which the turns may be other than they are told."""

_TURNS_AS_NEWEST: Final = 1.4
"""Turns since the end of a sweep until it cannot be the newest one any more."""

_Bounds = tuple[float, float]


class SweepClock:
    """Bounds of when the newest sweep ended, s."""

    def __init__(self) -> None:
        """Know nothing."""
        self._asked = -math.inf
        self._bounds: _Bounds = (-math.inf, math.inf)

    def ended(self, asked: float, turn: float, *, is_other: bool) -> float | None:
        """Return when the sweep ended that was told when asked at a time, s; None: it was told.

        ``turn`` is how long a sweep takes, s. ``is_other`` says that it is not as the one that was
        told before; one that looks the same is another one once that one is too old.
        """
        before, self._asked = self._asked, asked
        newest = asked - turn, asked
        if is_other:
            return self._taken((max(before, newest[0]), asked), turn)
        if asked - _middle(self._bounds) > _TURNS_AS_NEWEST * turn:
            return self._taken(newest, turn)
        return None

    def _taken(self, seen: _Bounds, turn: float) -> float:
        """Return when a sweep ended that did so within ``seen``; learn by it, if that tells."""
        expected = self._expected(seen, turn)
        both = [_common(seen, each) for each in expected] or [seen]
        most = max(both, key=_width)
        # Where two sweeps may be meant this tells nothing of when either of them ended.
        self._bounds = expected[both.index(most)] if len(both) > 1 else most
        return _middle(most)

    def _expected(self, seen: _Bounds, turn: float) -> list[_Bounds]:
        """Return within what sweeps ended that may have done so within ``seen``, by earlier ones.

        Nothing where the earlier ones tell no more than ``seen`` does.
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
