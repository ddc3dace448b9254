"""Reads files of bounded size: no pipe, no device and no huge file can hang or end the program."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

MOST_BYTES: Final = 100_000_000
"""Most bytes of a file that is read whole; the picture of the largest map has a fifth of that."""

_FLAGS: Final = os.O_RDONLY | sum(
    getattr(os, name, 0) for name in ("O_NONBLOCK", "O_CLOEXEC", "O_BINARY")
)
"""Without the first flag, opening a pipe waits for a writer; Windows has only the last flag."""


def read_bytes(path: Path, most: int = MOST_BYTES) -> bytes:
    """Return what a file holds; raises OSError if there is none, it is larger, a pipe or a device.

    ``/dev/null`` is an empty file.
    """
    descriptor = os.open(path, _FLAGS)
    with open(descriptor, "rb") as file:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode) and path != Path(os.devnull):
            kind = _KINDS.get(stat.S_IFMT(found.st_mode), "something else")
            raise OSError(errno.EINVAL, f"expected a regular file, got {kind}", str(path))
        size = found.st_size
        # A file of /proc says 0, and a file that grows says too little.
        if size <= most:
            content = file.read(most + 1)
            if len(content) <= most:
                return content
            size = len(content)
    raise OSError(errno.EFBIG, f"expected at most {most} bytes, got {size}", str(path))


def read_text(path: Path, most: int = MOST_BYTES) -> str:
    """Return the text of a file in UTF-8, without the mark that some editors put before it.

    Raises OSError as above, and UnicodeDecodeError.
    """
    return read_bytes(path, most).decode("utf-8-sig")


_KINDS: Final = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFDIR: "a folder",
    stat.S_IFSOCK: "a socket",
}
