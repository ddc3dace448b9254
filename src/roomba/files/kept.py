"""Files that the robot keeps: sealed with version and checksum, and the last good one beside.

The seal is one line, ``# kept VERSION sha256 DIGEST``, where other programs take no notice of it:
the second line of a PGM picture, behind the end of a ZIP archive (numpy's arrays), else the first
line, which is a comment in YAML. The digest is that of all other bytes. A file without a seal was
written before there were seals, or by another program; it is read as it is.

Before a file is replaced, it becomes the generation before, ``NAME.before``, if it is whole. A file
that turns out to be damaged is set aside as ``NAME.damaged``, and the one before is read.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeVar

from roomba.errors import RoombaError
from roomba.files.atomic import UNREADABLE, write_whole
from roomba.files.bounded import MOST_BYTES, read_bytes
from roomba.files.damaged import set_aside

_SEAL: Final = re.compile(rb"# kept (\d{1,9}) sha256 ([0-9a-f]{64})\n")
_LONGEST_SEAL: Final = 128
_PGM: Final = b"P5\n"
_ZIP: Final = b"PK\x03\x04"
_BEFORE: Final = ".before"

Content = TypeVar("Content")


class SealError(RoombaError):
    """A file whose seal and content do not belong together, or that a newer program wrote."""


class KeptFileError(RoombaError):
    """A kept file that cannot be used, and no generation before it that can."""


def sealed(content: bytes, version: int = 1) -> bytes:
    """Return a file's content with its seal; content that has one is sealed anew."""
    content, _ = _parted(content)
    line = f"# kept {version} sha256 {hashlib.sha256(content).hexdigest()}\n".encode()
    at = _place(content)
    return content[:at] + line + content[at:]


def unsealed(content: bytes, version: int = 1) -> bytes:
    """Return a file's content without its seal.

    Raises SealError if it is not what was sealed, or of a newer version than ``version``.
    """
    content, seal = _parted(content)
    if seal is None:
        return content
    its_version, digest = int(seal.group(1)), seal.group(2).decode()
    if hashlib.sha256(content).hexdigest() != digest:
        raise SealError(
            "expected what its checksum says, got something else: it is damaged, or was edited; "
            "if you edited it, remove its line '# kept'"
        )
    if its_version > version:
        raise SealError(
            f"expected version {version} or older, got {its_version}, which a newer program wrote"
        )
    return content


def before_of(path: Path) -> Path:
    """Return where the generation before a kept file is."""
    return path.with_name(path.name + _BEFORE)


def write_kept(path: Path, content: bytes, version: int = 1, *, most: int = MOST_BYTES) -> None:
    """Write a file that the robot keeps, atomically.

    The one from before is kept beside it, unless it is damaged. Raises OSError, and writes nothing,
    when the disk refuses, and for more than the ``most`` bytes that are read again.
    """
    whole = sealed(content, version)
    if len(whole) > most:
        raise OSError(errno.EFBIG, f"expected at most {most} bytes, got {len(whole)}", str(path))
    if _is_whole(path, most):
        _link(path, before_of(path), most)
    write_whole(path, whole)


def read_kept(
    path: Path,
    parse: Callable[[bytes], Content],
    tell: Callable[[str], object],
    *,
    version: int = 1,
    most: int = MOST_BYTES,
) -> Content | None:
    """Return what ``parse`` makes of a kept file's content; None if nothing was kept.

    Of a file that is damaged, or of which ``parse`` raises RoombaError or one of UNREADABLE, the
    generation before is used, and ``tell`` is told so in a sentence; the damaged one is set aside.
    Raises KeptFileError, which names the file and the reason, if that one cannot be used either.
    """
    try:
        return parse(unsealed(read_bytes(path, most), version))
    except FileNotFoundError:
        return None
    except (*UNREADABLE, RoombaError) as error:
        trouble = f"{path}: {_reason(error)}; {set_aside(path)}"
    found = _generation_before(path, parse, trouble, version, most)
    with contextlib.suppress(OSError):
        # The next reader must not find none.
        _link(before_of(path), path, most)
    tell(f"{trouble}; the one from before is used")
    return found


def remove_kept(path: Path) -> None:
    """Forget a kept file and the one before it; raises OSError when the disk refuses."""
    before_of(path).unlink(missing_ok=True)
    path.unlink(missing_ok=True)


def _generation_before(
    path: Path, parse: Callable[[bytes], Content], trouble: str, version: int, most: int
) -> Content:
    before = before_of(path)
    try:
        return parse(unsealed(read_bytes(before, most), version))
    except FileNotFoundError:
        raise KeptFileError(trouble) from None
    except (*UNREADABLE, RoombaError) as error:
        raise KeptFileError(
            f"{trouble}; neither can {before.name} be used: {_reason(error)}; {set_aside(before)}"
        ) from error


def _parted(content: bytes) -> tuple[bytes, re.Match[bytes] | None]:
    """Return a file's content without its seal, and the seal; None without one."""
    # In all of its places: the bytes that tell which one it is may be those that are damaged.
    last = content.rfind(b"# kept ", max(0, len(content) - _LONGEST_SEAL))
    for at in (0, len(_PGM), last):
        seal = _SEAL.match(content, at) if at >= 0 else None
        if seal is not None and (at <= len(_PGM) or seal.end() == len(content)):
            return content[: seal.start()] + content[seal.end() :], seal
    return content, None


def _place(content: bytes) -> int:
    """Return where the seal stands in what is to be sealed."""
    if content.startswith(_ZIP):
        # An archive that is cut short is none: its table of contents is at its end.
        return len(content)
    return len(_PGM) if content.startswith(_PGM) else 0


def _is_whole(path: Path, most: int) -> bool:
    """Whether a file is as it was sealed; one without a seal counts while there is none before."""
    try:
        content, seal = _parted(read_bytes(path, most))
    except OSError:
        return False
    if seal is None:
        return bool(content) and not before_of(path).exists()
    return hashlib.sha256(content).hexdigest() == seal.group(2).decode()


def _link(path: Path, other: Path, most: int) -> None:
    """Let ``other`` be the same file; the content is not written again."""
    new = other.with_name(f".{other.name}-{secrets.token_hex(8)}")
    try:
        os.link(path, new, follow_symlinks=False)
        os.replace(new, other)
    except OSError:
        # A file system without hard links.
        with contextlib.suppress(FileNotFoundError):
            new.unlink()
        write_whole(other, read_bytes(path, most))


def _reason(error: BaseException) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error).splitlines()[0] if str(error) else repr(error)
