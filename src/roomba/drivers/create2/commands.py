"""What a driver says to a Create 2, as bytes."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Final

from roomba.drivers.create2.open_interface import FASTEST, Opcode, OpenMode
from roomba.geometry import Twist

PADDING: Final = bytes(4)
"""Zeros before a command: they complete an earlier one that lost bytes, and else do nothing."""
_MOST_DUTY: Final = 127
_SIDE_SHARE: Final = 0.6
"""The side brush's duty as a share of the main brush's: at the full duty it flings crumbs away."""
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
    """Return the command that drives ``twist``; ``track`` is how far the wheels are apart, m.

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
    """Return the command that lets the robot stream these packets every 15 ms."""
    return bytes([Opcode.STREAM, len(packets), *packets])


def silence() -> bytes:
    """Return the command that ends the stream."""
    return bytes([Opcode.TOGGLE_STREAM, 0])


def song() -> bytes:
    """Return the command that teaches the robot the song by which a person finds it."""
    return bytes([Opcode.SONG, _SONG, len(_NOTES) // 2, *_NOTES])


def play() -> bytes:
    """Return the command that plays the song."""
    return bytes([Opcode.PLAY, _SONG])
