"""The retry policy for a way home that is shut: when to wait, to look again, and to give up."""

from __future__ import annotations

import math

from roomba.configuration.mission import WaitingConfig


class RetryPolicy:
    """Counts how often there was no way, and tells when to wait and when to give up.

    ``gets_out``: it has waited, and looks for a way out first.
    """

    def __init__(self, config: WaitingConfig) -> None:
        """Begin with nothing tried."""
        self._config = config
        self.renew()

    def renew(self) -> None:
        """Forget what was tried, and wait no longer."""
        self._tries = self._waits = 0
        self._since = self._looked = -math.inf
        self.gets_out = self._has_begun = False

    def wait(self, now: float) -> None:
        """Begin to wait."""
        self._since, self.gets_out, self._has_begun = now, True, True
        self._looked = now
        self._waits += 1

    def is_waiting(self, now: float) -> bool:
        """Whether it still waits; not if the clock was set back."""
        return 0.0 <= now - self._since < self.length

    def take_look(self, now: float) -> bool:
        """Return whether it is time, while it waits, to look for a way; the next look is later."""
        if 0.0 <= now - self._looked < self._config.look_period:
            return False
        self._looked = now
        return True

    def end(self) -> None:
        """Wait no longer: there is a way."""
        self._since = -math.inf

    def take_end(self, now: float) -> bool:
        """Return whether a wait ended, once for each wait."""
        ended = self._has_begun and not self.is_waiting(now)
        self._has_begun = self._has_begun and not ended
        return ended

    @property
    def length(self) -> float:
        """How long this wait is at most, s."""
        config = self._config
        return config.first_wait if self._waits <= config.first_waits else config.wait

    @property
    def is_pending(self) -> bool:
        """Whether a wait began whose end was not noticed yet."""
        return self._has_begun

    def found_no_way_home(self) -> None:
        """Count one search for a way home that found none."""
        self._tries += 1

    @property
    def must_wait(self) -> bool:
        """Whether looking for a way home at once was tried often enough."""
        return self._tries > self._config.most_ways_home

    @property
    def is_over(self) -> bool:
        """Whether it tried and waited often enough to give up."""
        return self._tries > self._config.most_ways_home + self._config.most_waits
