"""When the sweeps of a lidar were measured that are told on asking, without a time.

A robot tells its newest whole sweep, which may have ended just now or a turn ago. Asked more often
than it turns, the sweep that is another one than before ended between the two questions; and sweeps
end a turn apart, so what was learned of one narrows down the next.
"""

from __future__ import annotations

import math
from typing import Final

_DRIFT: Final = 0.005
"""Share of the time that passed by which the turns may be other than they are told."""

_SAME: Final = 1.5
"""Turns since the end of a sweep until it cannot be the newest one any more."""


class SweepClock:
    """Bounds of when the newest sweep ended, s."""

    def __init__(self) -> None:
        """Know nothing."""
        self._asked = -math.inf
        self._bounds = (-math.inf, math.inf)

    def ended(self, asked: float, turn: float, *, is_other: bool) -> float | None:
        """Return when the sweep ended that was told when asked at a time, s; None: it was told.

        ``turn`` is how long a sweep takes, s. ``is_other`` says that it is not as the one that was
        told before; one that looks the same is another one once that one is too old.
        """
        before, self._asked = self._asked, asked
        newest = asked - turn, asked
        if is_other:
            self._bounds = self._narrowed((max(before, newest[0]), asked), turn)
        elif asked - self._middle() > _SAME * turn:
            self._bounds = self._narrowed(newest, turn)
        else:
            return None
        return self._middle()

    def _narrowed(self, seen: tuple[float, float], turn: float) -> tuple[float, float]:
        """Return when a sweep ended that did so within ``seen``, by those some turns before it."""
        low, high = self._bounds
        if not math.isfinite(low):
            return seen
        turns = math.floor((seen[1] - self._middle()) / turn)
        for later in (turns * turn, (turns + 1) * turn):
            expected = low + later * (1.0 - _DRIFT), high + later * (1.0 + _DRIFT)
            both = max(seen[0], expected[0]), min(seen[1], expected[1])
            if both[0] <= both[1]:
                return both
        return seen

    def _middle(self) -> float:
        return 0.5 * (self._bounds[0] + self._bounds[1])
