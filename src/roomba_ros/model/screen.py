"""A screen without a monitor: Xvfb, which writes its picture into a file."""

from __future__ import annotations

import contextlib
import os
import select
import shutil
import struct
import subprocess
import tempfile
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError

_START: Final = 20.0
"""s of wall time in which it is there."""
_HEADER: Final = struct.Struct(">25I")
"""The header of X's window dump: sizes of header and picture, and how a pixel is stored."""
_COLOUR: Final = 12
"""Bytes of an entry of the dump's table of colours."""


class VirtualScreen:
    """An X display for programs with windows, as a context that ends it."""

    def __init__(self, width: int, height: int) -> None:
        """Start it, ``width`` by ``height`` pixels; raises RoombaError."""
        program = shutil.which("Xvfb")
        if program is None:
            raise RoombaError("expected the program Xvfb, there is none: apt-get install xvfb")
        self._folder = tempfile.TemporaryDirectory(prefix="roomba_screen_")
        reading, writing = os.pipe()
        self._process = subprocess.Popen(
            [
                *(program, "-displayfd", str(writing), "-screen", "0", f"{width}x{height}x24"),
                *("-fbdir", self._folder.name, "-nolisten", "tcp"),
            ],
            pass_fds=[writing],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(writing)
        with os.fdopen(reading, "rb") as told:
            ready, _, _ = select.select([told], [], [], _START)
            number = told.readline().strip().decode() if ready else ""
        if not number:
            self.close()
            raise RoombaError(f"expected Xvfb to tell its display within {_START:g} s, it did not")
        self.display = f":{number}"
        """Its name, for the variable DISPLAY."""

    def __enter__(self) -> VirtualScreen:
        """Return it."""
        return self

    def __exit__(self, *_: object) -> None:
        """End it."""
        self.close()

    def close(self) -> None:
        """End it; programs on it lose their windows."""
        self._process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self._process.kill()
        self._process.wait()
        self._folder.cleanup()

    def picture(self) -> NDArray[np.uint8]:
        """Return what is on it, uint8 [height, width, 3] RGB."""
        return decoded((Path(self._folder.name) / "Xvfb_screen0").read_bytes())


def decoded(dump: bytes) -> NDArray[np.uint8]:
    """Return the picture of a window dump of 32 bits a pixel, as RGB; raises RoombaError."""
    if len(dump) < _HEADER.size:
        raise RoombaError(f"expected a window dump, got {len(dump)} bytes")
    header = _HEADER.unpack_from(dump)
    size, _, _, _, width, height, _, order = header[:8]
    bits, line, colours = header[11], header[12], header[19]
    begin = size + _COLOUR * colours
    if bits != 32 or len(dump) < begin + line * height:
        raise RoombaError(f"expected a window dump of 32 bits a pixel, got one of {bits}")
    pixels = np.frombuffer(dump, np.uint8, line * height, begin).reshape(height, line // 4, 4)
    # Blue comes first where the least significant byte does.
    rgb = pixels[:, :width, 2::-1] if order == 0 else pixels[:, :width, 1:]
    return np.ascontiguousarray(rgb)
