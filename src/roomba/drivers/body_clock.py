"""The clock of a robot on a line: it stands while the robot cannot be reached."""

from __future__ import annotations

import threading
from collections.abc import Callable


class BodyClock:
    """Seconds since the clock was made, less those for which it stood; safe for any thread.

    The brain times its errands by this clock. It stands while the line is gone, so that the brain
    does not take a robot that cannot be reached for one that is stuck.
    """

    def __init__(self, wall: Callable[[], float]) -> None:
        """Run with ``wall``, s, a clock that never goes back."""
        self._wall, self._began = wall, wall()
        self._stood_at: float | None = None
        self._lock = threading.Lock()

    def __call__(self) -> float:
        """Return the time, s."""
        with self._lock:
            return self._now()

    def stand(self) -> None:
        """Stop the clock until :meth:`go_on`."""
        with self._lock:
            if self._stood_at is None:
                self._stood_at = self._now()

    def go_on(self) -> None:
        """Let the clock run on from the time at which it was stopped."""
        with self._lock:
            if self._stood_at is not None:
                self._began = self._wall() - self._stood_at
                self._stood_at = None

    def _now(self) -> float:
        return self._wall() - self._began if self._stood_at is None else self._stood_at
