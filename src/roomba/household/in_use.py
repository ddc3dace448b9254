"""The mark that tells of two programs on one household, where edits of one can be lost."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path
from typing import Final

from roomba.files.atomic import make_private
from roomba.files.lock import try_to_lock
from roomba.household.folder import Tell

_NAME: Final = "in_use"
"""The file's name; it has the id of the process that keeps the household."""
_LONGEST: Final = 20
"""Bytes of a process id."""


class InUse:
    """The mark in a household's folder that a program keeps it; the mark ends with the program."""

    def __init__(self, folder: Path, tell: Tell) -> None:
        """Touch nothing yet."""
        self._folder, self._tell = folder, tell
        self._lock: int | None = None
        self._owner = 0
        """The id of the process that set the mark, perhaps before this one was forked; 0: none."""

    def begin(self) -> None:
        """Mark the household as this program's; if another program keeps it, that is told."""
        with contextlib.suppress(OSError):  # everything else tells of a disk that refuses
            make_private(self._folder)
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW
            self._lock = os.open(self._folder / _NAME, flags, 0o600)
            if not self._mark(self._lock):
                self._tell_other(self._lock)

    def look(self) -> None:
        """Take the mark over from a program that ended meanwhile."""
        if self._lock is not None and not self._owner:
            with contextlib.suppress(OSError):
                self._mark(self._lock)

    def end(self) -> None:
        """Release the mark, so that another program can have it."""
        lock, self._lock = self._lock, None
        if lock is not None:
            # A child of this process may have the file open as well.
            if self._owner == os.getpid():
                fcntl.flock(lock, fcntl.LOCK_UN)
            os.close(lock)
        self._owner = 0

    def _mark(self, lock: int) -> bool:
        """Write this process into the file unless another has it; return whether it did."""
        if not try_to_lock(lock):
            return False
        self._owner = os.getpid()
        os.ftruncate(lock, 0)
        os.pwrite(lock, f"{self._owner}\n".encode(), 0)
        return True

    def _tell_other(self, lock: int) -> None:
        other = os.pread(lock, _LONGEST, 0).decode("ascii", "replace").strip()
        self._tell(
            f"process {other or 'of another program'} keeps this household as well "
            f"({self._folder}): plans begin in both, and what is edited in one can be lost in the "
            "other; end one of them, or set ROOMBA_HOUSEHOLD to a folder of its own"
        )
