"""The numbers of iRobot's Open Interface: commands, modes, and packets with their sizes.

Source: iRobot Create 2 Open Interface specification (2018), and libcreate's ``types.h``. Numbers
of two bytes have the high one first.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Final


class Opcode(IntEnum):
    """The first byte of a command."""

    RESET = 7
    """As if the battery was taken out and put back."""
    START = 128
    """Into passive mode; the first command of all."""
    BAUD = 129
    CONTROL = 130
    """As SAFE."""
    SAFE = 131
    FULL = 132
    POWER = 133
    SPOT = 134
    CLEAN = 135
    MAX = 136
    DRIVE = 137
    MOTORS = 138
    LEDS = 139
    SONG = 140
    PLAY = 141
    SENSORS = 142
    SEEK_DOCK = 143
    PWM_MOTORS = 144
    DRIVE_DIRECT = 145
    DRIVE_PWM = 146
    STREAM = 148
    QUERY_LIST = 149
    TOGGLE_STREAM = 150
    SCHEDULING_LEDS = 162
    DIGIT_LEDS_RAW = 163
    DIGIT_LEDS_ASCII = 164
    BUTTONS = 165
    SCHEDULE = 167
    SET_DAY_TIME = 168
    STOP = 173
    """Into off mode: no streams, and no answers until START."""


class OpenMode(IntEnum):
    """How much of what it is told the robot does; packet 35."""

    OFF = 0
    PASSIVE = 1
    """It tells what it senses, and charges; no motor obeys."""
    SAFE = 2
    """Motors obey until a wheel drops, a cliff is ahead, or a charger has power."""
    FULL = 3
    """Motors obey at cliffs, with dropped wheels and on a charger, too."""


class Packet(IntEnum):
    """What the robot tells; packets 32 and 33, of older robots, are not used here."""

    BUMPS_AND_DROPS = 7
    WALL = 8
    CLIFF_LEFT = 9
    CLIFF_FRONT_LEFT = 10
    CLIFF_FRONT_RIGHT = 11
    CLIFF_RIGHT = 12
    VIRTUAL_WALL = 13
    OVERCURRENTS = 14
    DIRT = 15
    UNUSED_16 = 16
    INFRARED_OMNI = 17
    BUTTONS = 18
    DISTANCE = 19
    ANGLE = 20
    CHARGING_STATE = 21
    VOLTAGE = 22
    CURRENT = 23
    TEMPERATURE = 24
    CHARGE = 25
    CAPACITY = 26
    WALL_SIGNAL = 27
    CLIFF_LEFT_SIGNAL = 28
    CLIFF_FRONT_LEFT_SIGNAL = 29
    CLIFF_FRONT_RIGHT_SIGNAL = 30
    CLIFF_RIGHT_SIGNAL = 31
    UNUSED_32 = 32
    UNUSED_33 = 33
    CHARGING_SOURCES = 34
    MODE = 35
    SONG_NUMBER = 36
    SONG_PLAYING = 37
    STREAM_PACKETS = 38
    REQUESTED_VELOCITY = 39
    REQUESTED_RADIUS = 40
    REQUESTED_RIGHT = 41
    REQUESTED_LEFT = 42
    LEFT_ENCODER = 43
    RIGHT_ENCODER = 44
    LIGHT_BUMPER = 45
    LIGHT_LEFT = 46
    LIGHT_FRONT_LEFT = 47
    LIGHT_CENTER_LEFT = 48
    LIGHT_CENTER_RIGHT = 49
    LIGHT_FRONT_RIGHT = 50
    LIGHT_RIGHT = 51
    INFRARED_LEFT = 52
    INFRARED_RIGHT = 53
    LEFT_MOTOR_CURRENT = 54
    RIGHT_MOTOR_CURRENT = 55
    MAIN_BRUSH_CURRENT = 56
    SIDE_BRUSH_CURRENT = 57
    STASIS = 58


_SIGNED: Final = {24: "b"} | dict.fromkeys((19, 20, 23, *range(39, 43), *range(54, 58)), "h")
_WIDE: Final = dict.fromkeys((22, 25, 26, *range(27, 32), 33, 43, 44, *range(46, 52)), "H")
FORMATS: Final[Mapping[int, str]] = MappingProxyType(
    {int(packet): (_SIGNED | _WIDE).get(int(packet), "B") for packet in Packet}
)
"""Each packet's format, as in :mod:`struct`: one byte or two, with a sign or without."""
GROUPS: Final[Mapping[int, range]] = MappingProxyType(
    {
        group: range(first, last + 1)
        for group, first, last in (
            (0, 7, 26),
            (1, 7, 16),
            (2, 17, 20),
            (3, 21, 26),
            (4, 27, 34),
            (5, 35, 42),
            (6, 7, 42),
            (100, 7, 58),
            (101, 43, 58),
            (106, 46, 51),
            (107, 54, 58),
        )
    }
)
"""Groups of packets that are asked for by one number."""
BAUDS: Final = (300, 600, 1200, 2400, 4800, 9600, 14400, 19200, 28800, 38400, 57600, 115200)
"""Baud rates; the place of each is its code in the command BAUD."""
HEADER: Final = 19
"""The first byte of each frame of a stream."""
STREAM_PERIOD: Final = 0.015
"""s between two frames of a stream; the robot reads its sensors as often."""
FASTEST: Final = 500
"""mm/s, of a wheel."""
ENCODER_SPAN: Final = 1 << 16
"""Counts, after which the encoders begin anew."""


def is_known(packet: int) -> bool:
    """Whether there is a packet or group of that number."""
    return packet in FORMATS or packet in GROUPS


def packets_of(number: int) -> Iterable[int]:
    """Return the packets of a group, or the packet itself."""
    return GROUPS.get(number, (number,))


def format_of(number: int) -> struct.Struct:
    """Return how a packet or a group is laid out; raises KeyError for another number."""
    return struct.Struct(">" + "".join(FORMATS[packet] for packet in packets_of(number)))


def checked(frame: bytes) -> bytes:
    """Return a frame with its checksum, which makes the sum of all bytes 0 modulo 256."""
    return frame + bytes([-sum(frame) & 0xFF])
