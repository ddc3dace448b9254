"""What a driver says to a Create 2, as bytes."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Final

from roomba.drivers.create2.open_interface import FASTEST, Opcode, OpenMode
from roomba.geometry import Twist

PADDING: Final = bytes(4)
"""Zeros before a command: one that lost a byte takes them for its data, else they say nothing."""
_MOST_DUTY: Final = 127
_SIDE_SHARE: Final = 0.6
"""Of the main brush's duty, that of the side brush: at all of it crumbs fly away."""
_INTO: Final = {
    OpenMode.OFF: Opcode.STOP,
    OpenMode.PASSIVE: Opcode.START,
    OpenMode.SAFE: Opcode.SAFE,
    OpenMode.FULL: Opcode.FULL,
}
_SONG: Final = 0
_NOTES: Final = (72, 12, 76, 12, 79, 12, 84, 24)
"""Pitch (MIDI) and length (1/64 s) by turns."""
SONG_TIME: Final = sum(_NOTES[1::2]) / 64.0
"""s"""


def into(mode: OpenMode) -> bytes:
    """Return the command that changes the mode."""
    return bytes([_INTO[mode]])


def drive(twist: Twist, track: float) -> bytes:
    """Return the wheels' speeds for ``twist``; ``track`` is how far they are apart, m.

    Too fast a twist is driven slower, along the same curve. Raises ValueError for one that is not
    finite.
    """
    if not twist.is_finite:
        raise ValueError(f"expected a finite twist, got {twist}")
    half = 0.5 * track * twist.angular
    right, left = 1e3 * (twist.linear + half), 1e3 * (twist.linear - half)
    scale = min(1.0, FASTEST / max(abs(right), abs(left), 1.0))
    return struct.pack(">Bhh", Opcode.DRIVE_DIRECT, round(scale * right), round(scale * left))


def power(brush: float, fan: float) -> bytes:
    """Return the command for brushes and fan, duties 0..1."""
    main, vacuum = (round(_MOST_DUTY * max(0.0, min(1.0, duty))) for duty in (brush, fan))
    return struct.pack("BbbB", Opcode.PWM_MOTORS, main, round(_SIDE_SHARE * main), vacuum)


def stream(packets: Sequence[int]) -> bytes:
    """Return the command after which these packets are told all 15 ms."""
    return bytes([Opcode.STREAM, len(packets), *packets])


def silence() -> bytes:
    """Return the command that ends the stream."""
    return bytes([Opcode.TOGGLE_STREAM, 0])


def song() -> bytes:
    """Return the command that teaches it the song by which it is found."""
    return bytes([Opcode.SONG, _SONG, len(_NOTES) // 2, *_NOTES])


def play() -> bytes:
    """Return the command that plays it."""
    return bytes([Opcode.PLAY, _SONG])
