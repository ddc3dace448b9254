"""A process's signs of life, for the supervisor that watches it."""

from __future__ import annotations

import contextlib
import os
import time
from typing import Final

_PERIOD: Final = 0.2
"""s of wall time between two signs."""


class Heart:
    """Writes a byte into a pipe now and then, as long as :meth:`beat` is called."""

    def __init__(self) -> None:
        """Begin without a pipe."""
        self._pipe, self._has_begun = -1, False
        self._beaten = 0.0

    def use(self, pipe: int) -> None:
        """Take the pipe, which does not block."""
        self._pipe = pipe

    def begin(self) -> None:
        """Send signs of life from now on; a process that is still starting need not."""
        self._has_begun = True

    def beat(self) -> None:
        """Send a sign of life; call it in the main loop, so that a hanging loop sends none."""
        now = time.monotonic()
        if self._pipe < 0 or not self._has_begun or now - self._beaten < _PERIOD:
            return
        self._beaten = now
        # A full pipe holds signs enough, and without a reader none are needed.
        with contextlib.suppress(OSError):
            os.write(self._pipe, b".")


HEART: Final = Heart()
"""The heart of this process."""
