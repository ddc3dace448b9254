"""A lidar on a line: read again and again, opened anew when it was unplugged."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final, Protocol

from roomba.drivers.line import Line, LineError
from roomba.robot.readings import ScanReading

_LONGEST_WITHOUT_SCAN: Final = 1.0
"""s without a scan, after which ``trouble`` says so."""
_REOPEN_PERIOD: Final = 1.0
"""s between two attempts to open the line."""
_LOOK_PERIOD: Final = 0.05
"""s between two checks of whether the thread is to end."""
_LONGEST_ENDING: Final = 2.0
"""s, for its thread to end."""


class LidarLanguage(Protocol):
    """How a lidar speaks: :class:`roomba.drivers.lidars.ld19.Ld19Frames` and others."""

    def begin(self, line: Line) -> None:
        """Let it measure; raises LineError."""

    def take(self, data: bytes, arrived: float) -> list[ScanReading]:
        """Return the scans that ``data`` completes; ``arrived``, s, is when ``data`` came."""


class LidarReader:
    """Keeps the newest scan. ``trouble`` says what is wrong, "" if nothing.

    Between :meth:`start` and :meth:`stop` a thread of its own calls :meth:`serve` again and again.
    """

    def __init__(
        self, opened: Callable[[], Line], language: LidarLanguage, now: Callable[[], float]
    ) -> None:
        """Read the line that ``opened`` returns; ``opened`` raises LineError where there is none.

        ``now`` is the robot's clock, s, which never goes back.
        """
        self._opened, self._language, self._now = opened, language, now
        self._line: Line | None = None
        self._lock = threading.Lock()
        self._newest: ScanReading | None = None
        self._came_at = self._tried_at = now() - _REOPEN_PERIOD
        self.trouble = "not asked yet"
        self._is_over = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Read from now on; does nothing if it reads already."""
        if self._thread is None:
            self._is_over.clear()
            self._thread = threading.Thread(target=self._read_on, name="lidar", daemon=True)
            self._thread.start()

    def stop(self) -> None:
        """Read no more, and let go of the line."""
        self._is_over.set()
        if self._thread is not None:
            self._thread.join(_LONGEST_ENDING)
            self._thread = None
        self._let_go()

    def serve(self, seconds: float) -> None:
        """Take what comes within ``seconds``; a line that is gone is opened anew, once a second."""
        try:
            line = self._line or self._begin()
            if line is None:
                self._is_over.wait(seconds)
                return
            data = line.read(seconds)
            now = self._now()
            for scan in self._language.take(data, now):
                with self._lock:
                    self._newest = scan
                self._came_at, self.trouble = now, ""
            if now - self._came_at > _LONGEST_WITHOUT_SCAN:
                self.trouble = (
                    f"expected scans of the lidar, got none for {now - self._came_at:.0f} s. "
                    "Does it turn, and is it the right kind and rate?"
                )
        except LineError as error:
            self.trouble = str(error)
            self._let_go()

    def newest(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""
        with self._lock:
            return self._newest

    def _read_on(self) -> None:
        while not self._is_over.is_set():
            self.serve(_LOOK_PERIOD)

    def _let_go(self) -> None:
        line, self._line = self._line, None
        if line is not None:
            line.close()

    def _begin(self) -> Line | None:
        now = self._now()
        if now - self._tried_at < _REOPEN_PERIOD:
            return None
        self._tried_at = now
        self._line = self._opened()
        self._language.begin(self._line)
        self._came_at = now
        return self._line
