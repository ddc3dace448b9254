"""How a program that serves a page is told to end."""

from __future__ import annotations

import signal
import time
from typing import Final

from roomba.commands.process_end import ending_signals

_PATIENCE: Final = 10.0
"""s that an end may take: a robot is given back, its map and its history are kept."""


class ToldToEnd:
    """SIGINT, SIGTERM and SIGHUP are remembered, and the first of them raises KeyboardInterrupt.

    The others do not: they would interrupt the end that the first one began, and with it how a
    robot is given back. One that comes ``patience`` s later ends the process as it would without
    this: such an end hangs.

    Python drops an exception that a signal raises while an object is being deleted: a program
    that only waited for it would then serve for ever.
    """

    def __init__(self, patience: float = _PATIENCE) -> None:
        """Listen from now on; shells have their background jobs ignore SIGINT."""
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
