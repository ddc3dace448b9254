"""Refused messages of a node: counted by topic, and summed up for the log."""

from __future__ import annotations

import math
import threading
from collections import Counter
from typing import Final

LINE_PERIOD: Final = 1.0
"""s between two lines of the log, at least."""
_RECENT: Final = 10.0
"""s; for so long a refusal counts as recent."""


class Refusals:
    """Counts what is refused; several threads may note and ask. Times are in s of one clock."""

    def __init__(self) -> None:
        """Begin with nothing refused."""
        self._lock = threading.Lock()
        self._counts: Counter[str] = Counter()
        self._untold: Counter[str] = Counter()
        self._newest = ("", "")
        self._noted = self._told = -math.inf

    def note(self, now: float, topic: str, reason: str) -> None:
        """Count a message of a topic that was refused, and why it was."""
        with self._lock:
            self._counts[topic] += 1
            self._untold[topic] += 1
            self._newest, self._noted = (topic, reason), now

    @property
    def counts(self) -> dict[str, int]:
        """How many messages were refused, by topic."""
        with self._lock:
            return dict(self._counts)

    @property
    def newest(self) -> str:
        """On which topic the last one was refused, and why; empty before one was."""
        topic, reason = self._newest
        return f"{topic} refused: {reason}" if topic else ""

    def is_recent(self, now: float) -> bool:
        """Whether something was refused in the last ten seconds."""
        return now - self._noted < _RECENT

    def take_line(self, now: float) -> str:
        """Return a line about refusals since the last line; empty if none is due."""
        with self._lock:
            if not self._untold or now - self._told < LINE_PERIOD:
                return ""
            untold, self._untold, self._told = self._untold, Counter(), now
            topic, line = self._newest[0], self.newest
        untold[topic] -= 1
        more = ", ".join(f"{count} on {name}" for name, count in sorted((+untold).items()))
        return f"{line}; {untold.total()} more refused: {more}" if more else line
