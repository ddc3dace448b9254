"""The clock of a robot on a line: it stands while the robot cannot be reached."""

from __future__ import annotations

import threading
from collections.abc import Callable


class BodyClock:
    """Seconds since it was made; for any thread.

    A brain times its errands by it: what the robot could not do while its line was gone is not
    taken for being stuck.
    """

    def __init__(self, wall: Callable[[], float]) -> None:
        """Go on with ``wall``, s, a clock that never goes back."""
        self._wall, self._began = wall, wall()
        self._stood_at: float | None = None
        self._lock = threading.Lock()

    def __call__(self) -> float:
        """Return the time, s."""
        with self._lock:
            return self._now()

    def stand(self) -> None:
        """Stand still until it goes on."""
        with self._lock:
            if self._stood_at is None:
                self._stood_at = self._now()

    def go_on(self) -> None:
        """Go on from the time at which it stands."""
        with self._lock:
            if self._stood_at is not None:
                self._began = self._wall() - self._stood_at
                self._stood_at = None

    def _now(self) -> float:
        return self._wall() - self._began if self._stood_at is None else self._stood_at
