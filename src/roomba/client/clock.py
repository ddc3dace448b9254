"""The interface of the clock by which callers wait, so that tests can step it."""

from __future__ import annotations

from typing import Protocol


class Clock(Protocol):
    """Wall time in seconds; the module ``time`` is one."""

    def monotonic(self) -> float:
        """Return seconds since some fixed moment."""

    def sleep(self, seconds: float, /) -> None:
        """Let seconds pass."""
