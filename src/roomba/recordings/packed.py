"""Files that are packed by gzip, xz or bzip2."""

from __future__ import annotations

import bz2
import gzip
import lzma
import shutil
import tempfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO, Final, TypeAlias, cast

from roomba.recordings.readings import LogError

_SUFFIXES: Final = (".gz", ".xz", ".bz2")
_Opener: TypeAlias = Callable[[Path], BinaryIO]
_BROKEN: Final = (EOFError, OSError, lzma.LZMAError, zlib.error)


class Unpacked:
    """A file as it is when it is not packed; ``path`` is valid until it is closed."""

    def __init__(self, given: Path) -> None:
        """Unpack into a temporary folder what is packed; raises LogError."""
        self.path = given
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        opener = _opener(given)
        if opener is None:
            return
        self._folder = tempfile.TemporaryDirectory(prefix="roomba_log_")
        self.path = Path(self._folder.name) / plain_name(given)
        try:
            with opener(given) as packed, self.path.open("wb") as plain:
                shutil.copyfileobj(packed, plain, 1 << 20)
        except _BROKEN as error:
            self.close()
            raise LogError(
                f"{given}: expected a whole packed file, it cannot be unpacked: {error}; copy it "
                "again"
            ) from None

    def take_copy(self) -> None:
        """Let ``path`` be a file that may be changed, a temporary copy; raises OSError."""
        if self._folder is not None:
            return
        self._folder = tempfile.TemporaryDirectory(prefix="roomba_log_")
        copy = Path(self._folder.name) / self.path.name
        shutil.copyfile(self.path, copy)
        self.path = copy

    def close(self) -> None:
        """Remove what was unpacked, or copied."""
        if self._folder is not None:
            self._folder.cleanup()


def head_of(path: Path, size: int) -> bytes:
    """Return the first bytes of what a file holds, packed or not; raises LogError."""
    try:
        with (_opener(path) or _open_plain)(path) as file:
            return file.read(size)
    except _BROKEN as error:
        raise LogError(f"{path}: cannot be read: {error}") from None


def refuse_pipe(path: Path) -> None:
    """Raise LogError for a pipe or a device: a recording is read more than once."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise LogError(f"{path}: expected a file, got a pipe or a device; copy it into a file")


def plain_name(path: Path) -> str:
    """Return a file's name without the suffix of a packer."""
    return path.stem if path.suffix.lower() in _SUFFIXES else path.name


def _opener(path: Path) -> _Opener | None:
    """Return what opens a packed file; None for others. Raises LogError."""
    if path.is_dir():
        return None
    refuse_pipe(path)
    try:
        with path.open("rb") as file:
            head = file.read(max(map(len, _OPENERS)))
    except FileNotFoundError:
        raise LogError(f"{path}: no such file; expected a bag or a log") from None
    except OSError as error:
        raise LogError(f"{path}: cannot be read: {error.strerror}") from None
    return next((opener for magic, opener in _OPENERS.items() if head.startswith(magic)), None)


def _open_gzip(path: Path) -> BinaryIO:
    return cast(BinaryIO, gzip.open(path, "rb"))


def _open_xz(path: Path) -> BinaryIO:
    return cast(BinaryIO, lzma.open(path, "rb"))


def _open_bzip2(path: Path) -> BinaryIO:
    return cast(BinaryIO, bz2.open(path, "rb"))


def _open_plain(path: Path) -> BinaryIO:
    return path.open("rb")


_OPENERS: Final[dict[bytes, _Opener]] = {
    b"\x1f\x8b": _open_gzip,
    b"\xfd7zXZ\x00": _open_xz,
    b"BZh": _open_bzip2,
}
"""What opens a packed file, by how it begins."""
