"""Atomic file write: readers see the old file or the new one, never a part."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import time
import zipfile
import zlib
from pathlib import Path
from typing import Final

UNREADABLE: Final = (
    OSError,
    ValueError,
    TypeError,
    KeyError,
    EOFError,
    OverflowError,
    NotImplementedError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading arrays raises: the disk refuses, or the file is broken or no array."""

_MODE: Final = 0o600
_FOLDER_MODE: Final = 0o700
"""Read and written by the owner alone: maps and pictures show a home from inside."""
_LEFT_BEHIND: Final = 3600.0
"""s; an unfinished file that is older belongs to a writer that was killed."""


def make_private(folder: Path) -> None:
    """Make a folder, and those above it, for their owner alone; what is there stays as it is.

    Raises OSError when the disk refuses.
    """
    missing = [each for each in (folder, *folder.parents) if not each.exists()]
    for each in reversed(missing):
        each.mkdir(_FOLDER_MODE, exist_ok=True)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file atomically, and make the folders that it is in, as :func:`make_private` does.

    The content goes to a new file of a random name in the same folder, which then takes the place
    of ``path``; a symbolic link there is replaced, not followed. Returns once file and folder are
    on the disk. Of several writers the last one wins. Raises OSError when the disk refuses; the
    file from before stays then, and nothing else.
    """
    make_private(path.parent)
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        _remove_left_behind(folder, path.name)
        # In the same folder: a file can take another's place only within one file system.
        unfinished = unfinished_name(path.name)
        try:
            _write_new(folder, unfinished, content)
            os.replace(unfinished, path.name, src_dir_fd=folder, dst_dir_fd=folder)
        except BaseException:
            _remove(folder, unfinished)
            raise
        os.fsync(folder)
    finally:
        os.close(folder)


def write_output(path: Path, content: bytes) -> None:
    """Write what a user wants at a path, as :func:`write_whole` does, in a folder that is there.

    A file that is replaced keeps its permissions.
    A device, a pipe, and what a link such as ``/dev/stdout`` leads to, are written into: another
    program reads there, and a file in their place would be of no use to it. Raises OSError.
    """
    if path.is_symlink() or (path.exists() and not path.is_file()):
        path.write_bytes(content)
        return
    folder = path.absolute().parent
    if not folder.is_dir():  # a folder whose name is mistyped is not made
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder))
    mode = path.stat().st_mode if path.exists() else None
    write_whole(path, content)
    if mode is not None:
        path.chmod(stat.S_IMODE(mode))


def unfinished_name(name: str) -> str:
    """Return a new name for a version of a file that is not finished, in the same folder.

    One that a killed writer left behind is removed by a later one.
    """
    return f"{_prefix(name)}{secrets.token_hex(8)}"


def _prefix(name: str) -> str:
    """Return how the names of a file's unfinished versions begin."""
    return f".{name}.unfinished-"


def _write_new(folder: int, name: str, content: bytes) -> None:
    """Write a file that is not there yet, to the disk; links and files there are refused."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
    with open(os.open(name, flags, _MODE, dir_fd=folder), "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _remove_left_behind(folder: int, name: str) -> None:
    """Remove what killed writers of this file left behind."""
    oldest = time.time() - _LEFT_BEHIND
    for entry in os.listdir(folder):
        if entry.startswith(_prefix(name)):
            with contextlib.suppress(FileNotFoundError):
                if os.stat(entry, dir_fd=folder, follow_symlinks=False).st_mtime < oldest:
                    os.unlink(entry, dir_fd=folder)


def _remove(folder: int, name: str) -> None:
    with contextlib.suppress(FileNotFoundError):
        os.unlink(name, dir_fd=folder)
