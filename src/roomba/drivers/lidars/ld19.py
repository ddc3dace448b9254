"""Frames of LDROBOT's lidars: LD06, LD19 (230400 baud), and LD08, which is LDS-02 (115200).

47 bytes: 0x54, 0x2C, speed (degrees/s), first angle (0.01 degrees), twelve times range (mm) and
intensity, last angle, time (ms, of 30000), CRC-8. Numbers of two bytes have the low one first.
Sources: LD19 development manual; ROBOTIS ld08_driver for LDS-02.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import Final

from roomba.configuration.sensors import LidarConfig
from roomba.drivers.lidars.device_clock import DeviceClock
from roomba.drivers.lidars.turns import TurnCollector
from roomba.drivers.line import Line
from roomba.robot.readings import ScanReading

HEAD: Final = b"\x54\x2c"
POINTS: Final = 12
POINT: Final = struct.Struct("<HB")
START: Final = struct.Struct("<2sHH")
END: Final = struct.Struct("<HHB")
SIZE: Final = START.size + POINTS * POINT.size + END.size
LAP: Final = 30_000
"""ms, after which the frames' time begins anew."""
_POLYNOMIAL: Final = 0x4D
_FULL_TURN: Final = 36_000
"""0.01 degrees"""
_WIDEST_FRAME: Final = 30.0
"""degrees from a frame's first point to its last; at 4 turns a second it is some 4."""


def _crc_of(value: int) -> int:
    for _ in range(8):
        value = (value << 1) ^ (_POLYNOMIAL if value & 0x80 else 0)
    return value & 0xFF


_CRC: Final = bytes(_crc_of(value) for value in range(256))


def crc8(data: bytes) -> int:
    """Return the check of bytes: polynomial 0x4D, begun with 0."""
    crc = 0
    for byte in data:
        crc = _CRC[crc ^ byte]
    return crc


@dataclass(frozen=True, slots=True)
class LidarFrame:
    """Twelve points: angles in degrees, clockwise, ranges in m (inf: no echo), ``time`` in ms."""

    speed: int
    first: float
    step: float
    ranges: tuple[float, ...]
    time: int


def frame_of(data: bytes) -> LidarFrame | None:
    """Return the frame in SIZE bytes; None if they are not a valid frame."""
    if data[:2] != HEAD or crc8(data[:-1]) != data[-1]:
        return None
    _head, speed, first = START.unpack_from(data)
    last, time, _crc = END.unpack_from(data, SIZE - END.size)
    span = ((last - first) % _FULL_TURN) / 100.0
    if first > _FULL_TURN or last > _FULL_TURN or span > _WIDEST_FRAME:
        return None
    points = POINT.iter_unpack(data[START.size : SIZE - END.size])
    ranges = tuple(1e-3 * distance if distance else math.inf for distance, _ in points)
    return LidarFrame(speed, first / 100.0, span / (POINTS - 1), ranges, time)


class Ld19Frames:
    """Makes scans of bytes; what is no frame is passed over, byte by byte."""

    def __init__(self, config: LidarConfig, facing: float = 0.0) -> None:
        """Read the lidar of ``config``, turned by ``facing``, rad, in the robot."""
        self._turns = TurnCollector(config, facing)
        self._clock = DeviceClock(LAP)
        self._came = b""

    def begin(self, line: Line) -> None:
        """Forget what came; this lidar turns and sends without being told."""
        line.discard()
        self._came = b""

    def take(self, data: bytes, arrived: float) -> list[ScanReading]:
        """Return the scans that are whole by now; ``arrived``, s, is when ``data`` came."""
        self._came += data
        scans: list[ScanReading] = []
        while True:
            start = self._came.find(HEAD)
            # The first byte of a head may be the last that came.
            self._came = self._came[start:] if start >= 0 else self._came[-1:]
            if len(self._came) < SIZE:
                return scans
            frame = frame_of(self._came[:SIZE])
            if frame is None:
                self._came = self._came[1:]
                continue
            self._came = self._came[SIZE:]
            scans += self._scans_of(frame, arrived)

    def _scans_of(self, frame: LidarFrame, arrived: float) -> list[ScanReading]:
        measured = self._clock.host_time(frame.time, arrived)
        between = frame.step / frame.speed if frame.speed > 0 else 0.0
        made = []
        for place, distance in enumerate(frame.ranges):
            angle = (frame.first + place * frame.step) % 360.0
            when = measured - (POINTS - 1 - place) * between
            made.append(self._turns.add(angle, distance, when))
        return [scan for scan in made if scan is not None]
