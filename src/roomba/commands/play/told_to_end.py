"""How a program that serves a page is told to end."""

from __future__ import annotations

import signal
from typing import Final

_ENDING: Final = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class ToldToEnd:
    """SIGINT, SIGTERM and SIGHUP raise KeyboardInterrupt, and are remembered.

    Python drops an exception that a signal raises while an object is being deleted: a program
    that only waited for it would then serve for ever.
    """

    def __init__(self) -> None:
        """Listen from now on; shells have their background jobs ignore SIGINT.

        SIGHUP stays ignored where it is, as nohup wants it.
        """
        self.is_told = False
        """Whether a signal came."""
        for number in _ENDING:
            if number is not signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._interrupt)

    def _interrupt(self, *_: object) -> None:
        self.is_told = True
        raise KeyboardInterrupt
