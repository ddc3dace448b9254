"""A file that grows line by line: each is on the disk once it is written, and has a checksum.

A line is a checksum, a blank and JSON. What a writer that was killed left of a line is skipped by
readers, as are lines that were damaged.
"""

from __future__ import annotations

import json
import os
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from roomba.files.atomic import write_whole
from roomba.files.bounded import read_bytes
from roomba.files.plain_json import load_json

_MODE: Final = 0o600
_MOST_BYTES: Final = 1_000_000_000


def append_line(path: Path, values: dict[str, Any]) -> None:
    """Append plain values; raises OSError when the disk refuses, ValueError for NaN and the like.

    One writer at a time.
    """
    line = _line(values)
    flags = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC | os.O_NOFOLLOW
    with open(os.open(path, flags, _MODE), "r+b", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        # End a line that was cut short, so that the new line stands by itself.
        is_cut = size > 0 and os.pread(file.fileno(), 1, size - 1) != b"\n"
        file.write((b"\n" if is_cut else b"") + line)
        os.fsync(file.fileno())


def write_lines(path: Path, lines: Iterable[dict[str, Any]]) -> None:
    """Begin a journal with lines, atomically; raises as :func:`append_line`."""
    write_whole(path, b"".join(map(_line, lines)))


def read_lines(path: Path) -> list[dict[str, Any]]:
    """Return the values of all whole lines; none without a file. Raises OSError."""
    try:
        content = read_bytes(path, _MOST_BYTES)
    except FileNotFoundError:
        return []
    lines = (_values_of(line) for line in content.split(b"\n"))
    return [values for values in lines if values is not None]


def _line(values: dict[str, Any]) -> bytes:
    text = json.dumps(values, allow_nan=False).encode()
    return b"%08x %s\n" % (zlib.crc32(text), text)


def _values_of(line: bytes) -> dict[str, Any] | None:
    checksum, _, text = line.partition(b" ")
    if checksum != b"%08x" % zlib.crc32(text):
        return None
    try:
        values = load_json(text.decode("utf-8"))
    except ValueError:
        return None
    return values if isinstance(values, dict) else None
