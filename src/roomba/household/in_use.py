"""Whether two programs keep one household: what is edited in one would be lost in the other."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path
from typing import Final

from roomba.files.atomic import make_private
from roomba.household.folder import Tell

_NAME: Final = "in_use"
"""Of the file: the process whose household it is."""
_LONGEST: Final = 20
"""Bytes of a process id."""


class InUse:
    """The mark in a household's folder that a program keeps it; it goes with the program."""

    def __init__(self, folder: Path, tell: Tell) -> None:
        """Touch nothing yet."""
        self._folder, self._tell = folder, tell
        self._lock: int | None = None

    def begin(self) -> None:
        """Mark the household as this program's; another program that keeps it is told."""
        with contextlib.suppress(OSError):  # of a disk that refuses all else tells
            make_private(self._folder)
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW
            self._lock = os.open(self._folder / _NAME, flags, 0o600)
            self._mark(self._lock)

    def end(self) -> None:
        """Let another program have it."""
        lock, self._lock = self._lock, None
        if lock is not None:
            os.close(lock)

    def _mark(self, lock: int) -> None:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            other = os.read(lock, _LONGEST).decode("ascii", "replace").strip()
            self._tell(
                f"process {other} keeps this household as well ({self._folder}): plans begin in "
                "both, and what is edited in one can be lost in the other; end one of them, or "
                "set ROOMBA_HOUSEHOLD to a folder of its own"
            )
            return
        os.ftruncate(lock, 0)
        os.write(lock, f"{os.getpid()}\n".encode())
