"""Files that the robot keeps: sealed with version and checksum, and the last good one beside.

The seal is one line, ``# kept VERSION sha256 DIGEST``, where other programs take no notice of it:
the second line of a PGM picture, behind the end of a ZIP archive (numpy's arrays), else the first
line, which is a comment in YAML. The digest is that of all other bytes. A file without a seal was
written before there were seals, or by another program; it is read as it is.

Before a file is replaced, it becomes the generation before, ``NAME.before``, if it is whole. A file
that turns out to be damaged is set aside as ``NAME.damaged``, and the one before takes its place.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeVar

from roomba.errors import RoombaError
from roomba.files.atomic import UNREADABLE, unfinished_name, write_whole
from roomba.files.bounded import MOST_BYTES, read_bytes
from roomba.files.damaged import aside_of, is_no_file, set_aside

_SEAL: Final = re.compile(rb"# kept (\d{1,9}) sha256 ([0-9a-f]{64})\n")
_LONGEST_SEAL: Final = 128
_PGM: Final = b"P5\n"
_ZIP: Final = b"PK\x03\x04"
_BEFORE: Final = ".before"

Content = TypeVar("Content")


class SealError(RoombaError):
    """A file whose seal and content do not belong together."""


class NewerFileError(SealError):
    """A file that a newer program wrote."""


class KeptFileError(RoombaError):
    """A kept file that cannot be used, and no generation before it that can."""


class UnreadFileError(KeptFileError):
    """A kept file that may be whole: the disk refuses it, or it is for a newer program.

    Nothing was done to it; the next :func:`write_kept` sets it aside.
    """


class _DamagedError(Exception):
    """What is wrong with a file that was read, or that is no file."""


def sealed(content: bytes, version: int = 1) -> bytes:
    """Return a file's content with its seal; content that has one is sealed anew."""
    content, _ = _parted(content)
    line = f"# kept {version} sha256 {hashlib.sha256(content).hexdigest()}\n".encode()
    at = _place(content)
    return content[:at] + line + content[at:]


def unsealed(content: bytes, version: int = 1) -> bytes:
    """Return a file's content without its seal.

    Raises SealError if it is not what was sealed, and its kind NewerFileError if it is of a newer
    version than ``version``.
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
        raise NewerFileError(
            f"expected version {version} or older, got {its_version}, which a newer program wrote"
        )
    return content


def before_of(path: Path) -> Path:
    """Return where the generation before a kept file is."""
    return path.with_name(path.name + _BEFORE)


def write_kept(path: Path, content: bytes, version: int = 1, *, most: int = MOST_BYTES) -> None:
    """Write a file that the robot keeps, atomically.

    The one from before is kept beside it, unless it is damaged; what cannot be read, or is of a
    newer program, is set aside. Raises OSError, and writes nothing, when the disk refuses, and for
    more than the ``most`` bytes that are read again.
    """
    whole = sealed(content, version)
    if len(whole) > most:
        raise OSError(errno.EFBIG, f"expected at most {most} bytes, got {len(whole)}", str(path))
    _keep_now(path, version, most)
    write_whole(path, whole)


def _keep_now(path: Path, version: int, most: int) -> None:
    """Keep the file that is at a path now, before another file takes its place."""
    try:
        content, seal = _parted(read_bytes(path, most))
    except FileNotFoundError:
        return
    except OSError:
        set_aside(path)
        return
    if seal is not None and int(seal.group(1)) > version:
        set_aside(path)
    elif _is_whole(content, seal, before_of(path)):
        _link(path, before_of(path), path.name, most)


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
    Raises KeptFileError, which names the file and the reason, if that one cannot be used either,
    and its kind UnreadFileError, touching nothing, where the file may be whole all the same.
    """
    try:
        return _content(path, parse, version, most)
    except FileNotFoundError:
        return None
    except _DamagedError as damage:
        found = _generation_before(path, parse, str(damage), version, most)
        tell(f"{path}: {damage}; {_put_back(path, most)}; the one from before is used")
        return found


def remove_kept(path: Path) -> None:
    """Forget a kept file and the one before it; raises OSError when the disk refuses."""
    before_of(path).unlink(missing_ok=True)
    path.unlink(missing_ok=True)


def _content(path: Path, parse: Callable[[bytes], Content], version: int, most: int) -> Content:
    """Return what a file holds; raises FileNotFoundError, UnreadFileError and _DamagedError."""
    try:
        content = read_bytes(path, most)
    except FileNotFoundError:
        raise
    except OSError as error:
        if is_no_file(error):
            raise _DamagedError(_reason(error)) from error
        raise UnreadFileError(
            f"{path}: expected a file that can be read: {_to_do(error)}"
        ) from error
    try:
        return parse(unsealed(content, version))
    except NewerFileError as error:
        raise UnreadFileError(f"{path}: {error}; start that one, or move the file away") from error
    except (*UNREADABLE, RoombaError) as error:
        raise _DamagedError(_reason(error)) from error


def _generation_before(
    path: Path, parse: Callable[[bytes], Content], damage: str, version: int, most: int
) -> Content:
    """Return the content before that of a damaged file; if it is unusable, set both files aside."""
    before = before_of(path)
    try:
        return _content(before, parse, version, most)
    except FileNotFoundError:
        raise KeptFileError(f"{path}: {damage}; {set_aside(path)}") from None
    except _DamagedError as error:
        raise KeptFileError(
            f"{path}: {damage}; {set_aside(path)}; neither can {before.name} be used: {error}; "
            f"{set_aside(before)}"
        ) from error


def _put_back(path: Path, most: int) -> str:
    """Put the generation before in a damaged file's place; return what became of the latter.

    A reader that comes between the two steps still finds the damaged file, and never none.
    """
    aside = aside_of(path)
    try:
        if path.is_file():
            _link(path, aside, path.name, most)
        else:
            path.replace(aside)
    except OSError as cause:
        return f"it cannot be set aside: {cause}"
    try:
        _link(before_of(path), path, path.name, most)
    except OSError as cause:
        return f"{aside.name} is a copy of it, and it stays: {cause}"
    return f"it is set aside as {aside.name}"


def _parted(content: bytes) -> tuple[bytes, re.Match[bytes] | None]:
    """Return a file's content without its seal, and the seal; None without one."""
    # Look in all places of a seal: the bytes that tell the right one may be damaged.
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


def _is_whole(content: bytes, seal: re.Match[bytes] | None, before: Path) -> bool:
    """Whether a file is as it was sealed; without a seal it counts if none is before it."""
    if seal is None:
        return bool(content) and not before.exists()
    return hashlib.sha256(content).hexdigest() == seal.group(2).decode()


def _link(path: Path, other: Path, name: str, most: int) -> None:
    """Make ``other`` the same file as ``path``, without writing its content again.

    What a killed program leaves behind is removed when the file ``name`` is written.
    """
    new = other.with_name(unfinished_name(name))
    try:
        os.link(path, new, follow_symlinks=False)
        try:
            os.replace(new, other)
        finally:
            # Where the two are one file already, nothing is replaced.
            new.unlink(missing_ok=True)
    except OSError:
        # A file system without hard links.
        write_whole(other, read_bytes(path, most))


def _to_do(error: OSError) -> str:
    """Return why the disk refuses a file, and what a person can do."""
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"{_reason(error)}; give it to the user of this program (chown), or move it away"
    return f"{_reason(error)}; it is left as it is, try again"


def _reason(error: BaseException) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error).splitlines()[0] if str(error) else repr(error)
