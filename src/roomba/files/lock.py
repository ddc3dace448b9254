"""Lock files: one program at a time holds one, while it does what no other may do meanwhile."""

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

    Raises TimeoutError if another program or thread holds it for ``within`` s of wall time, OSError
    when the disk refuses.
    """
    flags = os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW
    with open(os.open(path, flags, _MODE), "r+b") as lock:
        end = time.monotonic() + within
        while not try_to_lock(lock.fileno()):
            if time.monotonic() >= end:
                raise TimeoutError(
                    f"expected {path.name} to be free within {within:g} s, another program holds "
                    "it; let that one go on, or end it"
                )
            time.sleep(_PAUSE)
        yield


def try_to_lock(descriptor: int) -> bool:
    """Take the lock of an open file without waiting; return whether it was free.

    It is held until the file is closed.
    """
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
