"""A simulated world that goes on in real time, while made-up robots are asked about it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

STEP: Final = 0.0125
"""s of the world in a step; requests are answered between two steps."""
_LATE: Final = 0.1
"""s; on a machine that is later than this the world runs slower."""


class LivingWorld:
    """Steps the world in real time; ``lock`` is held in a step, and by all that look at it."""

    def __init__(
        self, step: Callable[[], object], speed: float = 1.0, period: float = STEP
    ) -> None:
        """``step`` lets ``period`` s pass; the world runs ``speed`` times as fast as real time."""
        self.lock = threading.Lock()
        self._step, self._pause = step, period / speed
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._live, name="made-up world", daemon=True)

    def start(self) -> None:
        """Let the world go on."""
        self._thread.start()

    def end(self) -> None:
        """Let the world stand."""
        self._is_over.set()
        self._thread.join(2.0)

    def _live(self) -> None:
        following = time.monotonic()
        while not self._is_over.is_set():
            with self.lock:
                self._step()
            following += self._pause
            late = time.monotonic() - following
            if late > _LATE:
                following += late
            self._is_over.wait(max(0.0, -late))
