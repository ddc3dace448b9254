"""A line that is opened anew after it was gone."""

from __future__ import annotations

from collections.abc import Callable

from roomba.drivers.line import Line


class ReopenedLine:
    """A :class:`roomba.drivers.line.Line` that can be opened again, to the same robot."""

    def __init__(self, opened: Callable[[], Line]) -> None:
        """Open the line by ``opened``; raises LineError if ``opened`` does."""
        self._opened, self._line = opened, opened()

    def reopen(self) -> None:
        """Close the line and open it again; raises LineError as long as it is gone."""
        self._line.close()
        self._line = self._opened()

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        self._line.write(data)

    def read(self, seconds: float) -> bytes:
        """Return what comes within ``seconds``."""
        return self._line.read(seconds)

    def discard(self) -> None:
        """Forget what came and was not read."""
        self._line.discard()

    def close(self) -> None:
        """Let go of it."""
        self._line.close()
