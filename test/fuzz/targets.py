"""What is fuzzed: each reader of bytes that others wrote, with one input that is whole."""

from __future__ import annotations

import functools
import io
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from fixtures.file_kinds import KINDS, Kind
from fixtures.said import Said
from rosgraph.network import ROSHandshakeException, encode_ros_handshake_header

from roomba.files.arrays import array_of
from roomba.files.atomic import UNREADABLE
from roomba_ros.runtime.connections import header_of


class Target(NamedTuple):
    """A reader, inputs that are whole, and what it may raise."""

    read: Callable[[bytes], object]
    whole: Callable[[], bytes]
    errors: tuple[type[BaseException], ...]


def _target_of(kind: Kind, folder: Path) -> Target:
    path = folder / kind.name

    def read(content: bytes) -> object:
        for left in folder.iterdir():
            left.unlink()
        path.write_bytes(content)
        return kind.read(path)

    errors = kind.errors if isinstance(kind.errors, tuple) else (kind.errors,)
    return Target(read, kind.whole, errors)


def _array_file() -> bytes:
    file = io.BytesIO()
    np.save(file, np.arange(12.0).reshape(3, 4))
    return file.getvalue()


def _header(content: bytes) -> object:
    connection: Any = Said(content)
    return header_of(connection)


_OWN: Final[dict[str, Target]] = {
    "array.npy": Target(array_of, _array_file, UNREADABLE),
    "tcpros": Target(
        _header,
        functools.partial(
            encode_ros_handshake_header,
            {"callerid": "/a", "topic": "/odom", "md5sum": "*", "type": "nav_msgs/Odometry"},
        ),
        (OSError, ValueError, ROSHandshakeException),
    ),
}
NAMES: Final = (*(kind.name for kind in KINDS), *_OWN)


def target_of(name: str, folder: Path) -> Target:
    """Return a target by its name; files are written in a folder of its own."""
    own = _OWN.get(name)
    if own is not None:
        return own
    return _target_of(next(kind for kind in KINDS if kind.name == name), folder)
