"""How a program that serves a page is told to end."""

from __future__ import annotations

import signal


class ToldToEnd:
    """SIGINT and SIGTERM raise KeyboardInterrupt, and are remembered.

    Python drops an exception that a signal raises while an object is being deleted: a program
    that only waited for it would then serve for ever.
    """

    def __init__(self) -> None:
        """Listen from now on; shells have their background jobs ignore SIGINT."""
        self.is_told = False
        """Whether a signal came."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._interrupt)

    def _interrupt(self, *_: object) -> None:
        self.is_told = True
        raise KeyboardInterrupt
