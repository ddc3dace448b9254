"""A thread that sends a made-up lidar's bytes onto its line, since a line takes its time."""

from __future__ import annotations

import queue
import threading
from typing import Final

from roomba.emulators.pseudo_terminal import PseudoTerminal

_MOST: Final = 40
"""Pieces that wait at most; further ones are lost, as on a line that nothing reads."""
_LOOK: Final = 0.1
"""s between two checks of whether the thread is to end."""


class LidarSender:
    """Sends pieces in their order until :meth:`end`."""

    def __init__(self, line: PseudoTerminal) -> None:
        """Send on ``line``."""
        self._line = line
        self._waiting: queue.Queue[bytes] = queue.Queue(_MOST)
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._send, name="made-up lidar", daemon=True)

    def start(self) -> None:
        """Send from now on."""
        self._thread.start()

    def end(self) -> None:
        """Send no more."""
        self._is_over.set()
        self._thread.join(2.0)

    def put(self, data: bytes) -> None:
        """Take what is to be sent; returns at once."""
        if data and not self._waiting.full():
            self._waiting.put_nowait(data)

    def _send(self) -> None:
        while not self._is_over.is_set():
            try:
                data = self._waiting.get(timeout=_LOOK)
            except queue.Empty:
                continue
            self._line.write(data)
