"""A line to a robot: bytes out, bytes in."""

from __future__ import annotations

import errno
import os
import termios
from typing import Final, Protocol

import serial

from roomba.errors import RoombaError
from roomba.vocabulary import Hindrance

_UNPLUGGED: Final = (serial.SerialException, OSError, termios.error, TypeError)
"""What pyserial raises when a device was unplugged; TypeError when another thread closed it."""
_NO_PINS: Final = (errno.ENOTTY, errno.EINVAL)
"""What a device without such pins answers."""
_EXCLUSIVE: Final = True if os.name == "posix" else None
"""Two programs on one line would take each other's bytes, and both would drive."""
_PIECE: Final = 4096
"""Bytes that are read at once at most."""


class LineError(RoombaError):
    """The line is gone, or the robot at its other end does not answer, or not as it must."""

    trouble = "the robot cannot be reached"
    """What a person is told first."""
    remedy = "Plug its line in and switch it on"
    hindrance = Hindrance.UNREACHABLE


class Line(Protocol):
    """What a driver needs of a line; each call raises LineError when the line is gone."""

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""

    def read(self, seconds: float) -> bytes:
        """Return what comes within ``seconds``, as soon as something does; b"" if nothing."""

    def discard(self) -> None:
        """Forget what came and was not read."""

    def close(self) -> None:
        """Let go of the line."""


class SerialLine:
    """A serial port, a USB device that looks like one, or a pseudo terminal."""

    def __init__(self, port: str, baud: int) -> None:
        """Open it; raises LineError with what to do."""
        try:
            self._serial = serial.Serial(
                port, baud, timeout=0.0, write_timeout=1.0, exclusive=_EXCLUSIVE
            )
        except (serial.SerialException, ValueError) as error:
            if getattr(error, "errno", None) == errno.EAGAIN:
                raise LineError(
                    f"expected a robot on {port}, got a line that another program has open; end "
                    "that one first"
                ) from error
            raise LineError(
                f"expected a robot on {port}, got: {error}. Is it plugged in and switched on, and "
                "may you open it (group dialout)?"
            ) from error

    def write(self, data: bytes) -> None:
        """Send all of ``data``."""
        try:
            self._serial.write(data)
        except _UNPLUGGED as error:
            raise LineError(f"the line is gone: {error}") from error

    def read(self, seconds: float) -> bytes:
        """Return what comes within ``seconds``."""
        try:
            self._serial.timeout = seconds
            first = self._serial.read(1)
            return bytes(first + self._serial.read(min(self._serial.in_waiting, _PIECE)))
        except _UNPLUGGED as error:
            raise LineError(f"the line is gone: {error}") from error

    def pull(self, *, is_low: bool) -> bool:
        """Pull the pins RTS and DTR low, or let them go; return whether it has any.

        A TTL adapter pulls a pin low while its line is set. A pseudo terminal has no pins.
        """
        try:
            self._serial.rts = self._serial.dtr = is_low
        except _UNPLUGGED as error:
            if getattr(error, "errno", None) in _NO_PINS:
                return False
            raise LineError(f"the line is gone: {error}") from error
        return True

    def discard(self) -> None:
        """Forget what came and was not read."""
        try:
            self._serial.reset_input_buffer()
        except _UNPLUGGED as error:
            raise LineError(f"the line is gone: {error}") from error

    def close(self) -> None:
        """Let go of the port."""
        self._serial.close()
