"""Remembers signals that tell a program with a page to end."""

from __future__ import annotations

import signal
import time
from typing import Final

from roomba.commands.process_end import ending_signals

_PATIENCE: Final = 10.0
"""s that an end may take: it gives a robot back, and saves its map and its history."""


class ToldToEnd:
    """Remembers SIGINT, SIGTERM and SIGHUP; the first one raises KeyboardInterrupt.

    Later signals raise nothing: they would interrupt the end that the first one began, such as how
    a robot is given back. If that end hangs, a signal ``patience`` s after the first ends the
    process.

    Python drops an exception that a signal raises while an object is being deleted. A program that
    only waited for the exception would then serve for ever, so ``is_told`` is set as well.
    """

    def __init__(self, patience: float = _PATIENCE) -> None:
        """Listen from now on, also to SIGINT, which shells let background jobs ignore."""
        self.is_told = False
        """Whether a signal came."""
        self._patience, self._told_at = patience, 0.0
        for number in ending_signals():
            signal.signal(number, self._interrupt)

    def _interrupt(self, number: int, _: object) -> None:
        now = time.monotonic()
        if not self.is_told:
            self.is_told, self._told_at = True, now
            raise KeyboardInterrupt
        if now - self._told_at >= self._patience:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
