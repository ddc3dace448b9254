"""A file that one program at a time holds, while it does what no other may do meanwhile."""

from __future__ import annotations

import contextlib
import fcntl
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

_MODE: Final = 0o600
_PAUSE: Final = 0.01
"""s of wall time between two tries."""


@contextlib.contextmanager
def locked(path: Path, within: float) -> Iterator[None]:
    """Hold the lock of a file, which is made if it is not there; threads exclude each other, too.

    Raises TimeoutError if others hold it for ``within`` s of wall time, OSError when the disk
    refuses.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW
    with open(os.open(path, flags, _MODE), "r+b") as lock:
        end = time.monotonic() + within
        while not _try_to_take(lock.fileno()):
            if time.monotonic() >= end:
                raise TimeoutError(
                    f"expected {path.name} to be free within {within:g} s, another program holds "
                    "it; let that one go on, or end it"
                )
            time.sleep(_PAUSE)
        yield


def _try_to_take(lock: int) -> bool:
    """Take a lock; return whether it was free."""
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
