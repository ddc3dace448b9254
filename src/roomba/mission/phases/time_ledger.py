"""The time ledger: what the time of a clean goes into."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.time_spent import TimeSpent
from roomba.vocabulary import Phase

_STANDS: Final = 0.1
"""Share of the top speed; a robot that is slower counts as turning on the spot."""
_OF_PHASE: Final = {
    Phase.UNDOCKING: "station",
    Phase.RETURNING: "station",
    Phase.DOCKING: "station",
    Phase.EMPTYING: "station",
    Phase.CHARGING: "charging",
    Phase.BIN_FULL: "waiting",
    Phase.PAUSED: "waiting",
    Phase.ERROR: "waiting",
    Phase.EMERGENCY: "waiting",
}
"""What a phase's time is counted as; that of cleaning and exploring is looked at closer."""
_COUNTED: Final = ("straight", "slowed", "turning", "again", "station", "charging", "waiting")


class TimeLedger:
    """Told what passed; it adds up, in s, and knows no clock."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self.begin()

    def begin(self) -> None:
        """Count anew."""
        self._spent = dict.fromkeys(_COUNTED, 0.0)
        self._fastest = 0.0

    def note(
        self,
        phase: Phase,
        ways: NDArray[np.float64],
        each: float,
        limit: float,
        *,
        is_again: bool,
        stands: bool,
    ) -> None:
        """Take ticks of ``each`` s on which ``ways``, float64 [n], m, were driven.

        ``limit`` is the top speed, m/s. ``is_again``: in a later round; ``stands``: it waits.
        """
        passed = each * len(ways)
        if phase in (Phase.DOCKED, Phase.IDLE):
            return
        if stands or phase in _OF_PHASE:
            self._spent["waiting" if stands else _OF_PHASE[phase]] += passed
            return
        self._fastest = max(self._fastest, limit)
        if is_again:
            self._spent["again"] += passed
            return
        at_speed = np.minimum(ways / limit, each)
        lost = each - at_speed
        turns = ways < _STANDS * limit * each
        self._spent["straight"] += float(at_speed.sum())
        self._spent["turning"] += float(lost[turns].sum())
        self._spent["slowed"] += float(lost[~turns].sum())

    def spent(self, area: float, tool_width: float) -> TimeSpent:
        """Return what the time went into; ``area`` became clean in it, m2, each pass counted."""
        swept_in_a_second = tool_width * self._fastest
        least = area / swept_in_a_second if swept_in_a_second > 0.0 else 0.0
        return TimeSpent(least, **self._spent)

    def values(self) -> dict[str, float]:
        """Return all that must be remembered to go on, as plain values."""
        return {**self._spent, "fastest": self._fastest}

    def restore(self, values: Mapping[str, float]) -> None:
        """Go on from such values; times that are missing count as 0."""
        self._spent = {name: values.get(name, 0.0) for name in _COUNTED}
        self._fastest = values.get("fastest", 0.0)
