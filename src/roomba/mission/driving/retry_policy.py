"""The retry policy for a way home that is shut: when to wait, to look again, and to give up."""

from __future__ import annotations

import math
from typing import Final

_MOST_WAYS_HOME: Final = 5
"""Attempts to find a way home before it begins to wait."""
_FIRST_WAITS: Final = 2
_FIRST_WAIT: Final = 10.0
_WAIT: Final = 30.0
"""s; so long it waits, where no way leads on, before it looks for one again: people pass sooner
than doors are opened."""
_LOOK: Final = 2.0
"""s; period of looking whether the way is clear."""
_MOST_WAITS: Final = 41
"""The most waits, twenty minutes in all; then it gives up."""


class RetryPolicy:
    """Counts how often there was no way, and tells when to wait and when to give up.

    ``gets_out``: it has waited, and looks for a way out first.
    """

    def __init__(self) -> None:
        """Begin with nothing tried."""
        self._tries = self._waits = 0
        self._since = self._looked = -math.inf
        self.gets_out = self._has_begun = False

    def renew(self) -> None:
        """Count the ways home anew."""
        self._tries = self._waits = 0

    def wait(self, now: float) -> None:
        """Begin to wait."""
        self._since, self.gets_out, self._has_begun = now, True, True
        self._looked = now
        self._waits += 1

    def is_waiting(self, now: float) -> bool:
        """Whether it still waits; not if the clock was set back."""
        wait = _FIRST_WAIT if self._waits <= _FIRST_WAITS else _WAIT
        return 0.0 <= now - self._since < wait

    def looks_again(self, now: float) -> bool:
        """Whether it is time, while it waits, to look whether there is a way by now."""
        if 0.0 <= now - self._looked < _LOOK:
            return False
        self._looked = now
        return True

    def end(self) -> None:
        """Wait no longer: there is a way."""
        self._since = -math.inf

    def has_ended(self, now: float) -> bool:
        """Whether a wait ended since this was asked last."""
        ended = self._has_begun and not self.is_waiting(now)
        self._has_begun = self._has_begun and not ended
        return ended

    @property
    def is_pending(self) -> bool:
        """Whether a wait began whose end was not noticed yet."""
        return self._has_begun

    def found_no_way_home(self) -> None:
        """Count it."""
        self._tries += 1

    @property
    def must_wait(self) -> bool:
        """Whether looking for a way home at once was tried often enough."""
        return self._tries > _MOST_WAYS_HOME

    @property
    def is_over(self) -> bool:
        """Whether it waited long enough."""
        return self._tries > _MOST_WAYS_HOME + _MOST_WAITS
