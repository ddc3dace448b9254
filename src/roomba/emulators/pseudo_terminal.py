"""A serial line made up: a pseudo terminal with the timing of a real line."""

from __future__ import annotations

import contextlib
import os
import pty
import select
import termios
import time
import tty
from pathlib import Path
from typing import Final

from roomba.errors import RoombaError

_BITS: Final = 10
"""Of a byte on a serial line: start, eight, stop."""
_PIECE: Final = 256
"""Bytes."""
_RATES: Final = {
    getattr(termios, name): int(name[1:])
    for name in dir(termios)
    if name.startswith("B") and name[1:].isdigit()
}
"""Baud by the system's code."""
_LINES: Final = Path("/dev/pts")
"""Where the system has its pseudo terminals."""


class PseudoTerminal:
    """The robot's end of a line; ``name`` is the device that a program opens at the other end.

    Raises RoombaError where ``link``, a name to find it by, is taken. A link to a line that is gone
    does not count as taken: an emulator that was killed left it.
    """

    def __init__(
        self, link: Path | None = None, baud: int | None = None, speed: float = 1.0
    ) -> None:
        """``baud`` bits a second go over the line; None: as over USB, at once.

        A rate that is set later counts ``speed`` times: the line runs so much faster than real
        time.
        """
        if link is not None:
            _require_free(link)
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave, termios.TCSANOW)
        os.set_blocking(self._master, False)
        self._ends: tuple[int, ...] = self._master, self._slave
        self.name, self._baud, self._link = os.ttyname(self._slave), baud, link
        self._speed = speed
        if link is not None:
            try:
                link.unlink(missing_ok=True)
                link.symlink_to(self.name)
            except OSError as error:
                raise RoombaError(f"{link}: cannot be made a link: {error.strerror}") from error

    def read(self, seconds: float) -> bytes:
        """Return what a program sent, as soon as something is there; b"" after ``seconds``."""
        readable, _, _ = select.select([self._master], [], [], max(0.0, seconds))
        if not readable:
            return b""
        try:
            return os.read(self._master, _PIECE)
        except (BlockingIOError, OSError):
            return b""

    def write(self, data: bytes) -> None:
        """Send bytes as quickly as the line takes them; what no program reads is lost."""
        began, sent = time.monotonic(), 0
        while sent < len(data):
            piece = data[sent : sent + _PIECE]
            try:
                sent += os.write(self._master, piece)
            except BlockingIOError:
                return
            if self._baud is not None:
                ends = began + sent * _BITS / self._baud
                time.sleep(max(0.0, ends - time.monotonic()))

    def set_rate(self, baud: int) -> bool:
        """Send at ``baud``; return whether the program at the other end does, too.

        A line that is as quick as USB has no rate.
        """
        if self._baud is None:
            return True
        self._baud = round(baud * self._speed)
        _in, _out, _control, _local, _sent, code, _characters = termios.tcgetattr(self._slave)
        return _RATES.get(code) == baud

    def close(self) -> None:
        """Unplug it; a second call closes nothing: its files' numbers may be others' by then."""
        ends, self._ends = self._ends, ()
        for end in ends:
            with contextlib.suppress(OSError):
                os.close(end)
        if self._link is not None and self._leads_here(self._link):
            self._link.unlink()

    def _leads_here(self, link: Path) -> bool:
        """Whether it is still the link to this line: another program may have taken the name."""
        return link.is_symlink() and os.readlink(link) == self.name


def _require_free(link: Path) -> None:
    if os.path.lexists(link) and not _is_left_behind(link):
        there = f"a link to {os.readlink(link)}" if link.is_symlink() else "a file"
        raise RoombaError(
            f"expected a new name for the line, got {link}: {there} is there; end the program that "
            "made it, remove it, or choose another name"
        )


def _is_left_behind(link: Path) -> bool:
    """Whether it leads to a pseudo terminal that is gone, as after a kill."""
    is_link_to_line = link.is_symlink() and Path(os.readlink(link)).parent == _LINES
    return is_link_to_line and not link.exists()
