"""Questions and answers on a Neato's line: one command at a time, each answer ends with 0x1A."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from roomba.drivers.line import Line, LineError

END: Final = b"\x1a"
_LONGEST_ANSWER: Final = 65_536
"""Bytes; a scan has some 6,000."""
_MOST_LATE_PIECES: Final = 8
"""Pieces that are read after the deadline: enough for all that a line holds while none is read."""


class SilenceError(LineError):
    """The line is there, and no whole answer came in time."""


class Conversation:
    """Asks over a line. For one thread only: two would take each other's answers."""

    def __init__(
        self,
        line: Line,
        now: Callable[[], float],
        patience: float = 0.0,
        per_byte: float = 0.0,
    ) -> None:
        """Ask over ``line``; ``now`` is a clock that never goes back, s.

        ``patience`` is how much longer answers may take than on a wire, s. On a line that sends on
        only whole answers, ``per_byte`` is what each byte took before the first one came, s.
        """
        self._line, self._now = line, now
        self._patience, self._per_byte = patience, per_byte
        self._heard_at = now()
        self._took = 0.0

    @property
    def took(self) -> float:
        """How long the newest question took until its answer was whole, or was given up, s."""
        return self._took

    @property
    def is_bridged(self) -> bool:
        """Whether the robot answers through a bridge, which sends on whole answers."""
        return self._per_byte > 0.0

    @property
    def since_heard(self) -> float:
        """How long ago the newest answer began to come, s."""
        return self._now() - self._heard_at

    def ask(self, command: str, within: float) -> list[str]:
        """Return the lines of the answer, without the echo of the command.

        What an earlier question left on the line is forgotten; an answer that echoes another
        command is passed over. Raises SilenceError when nothing whole came ``within`` s, and
        LineError when the line is gone.
        """
        began = self._now()
        try:
            return self._answer(command, within)
        finally:
            self._took = self._now() - began

    def _answer(self, command: str, within: float) -> list[str]:
        end = self._now() + within + self._patience
        self._line.discard()
        self._line.write(command.encode("ascii") + b"\n")
        came, late = b"", 0
        while True:
            answer, separator, rest = came.partition(END)
            if separator:
                came = rest
                lines = answer.decode("ascii", "replace").splitlines()
                if lines and lines[0].strip().lower() == command.lower():
                    return [line.strip() for line in lines[1:] if line.strip()]
                continue
            left = end - self._now()
            # What came while this program was held up is read although it is late.
            late += left <= 0.0
            piece = self._line.read(max(0.0, left))
            if (not piece and late) or late > _MOST_LATE_PIECES or len(came) > _LONGEST_ANSWER:
                raise SilenceError(
                    f"expected an answer to {command!r} within {within:g} s, got "
                    f"{len(came)} bytes without an end"
                )
            if not came:
                self._heard_at = self._now() - self._per_byte * len(piece)
            came += piece

    def close(self) -> None:
        """Let go of the line."""
        self._line.close()
