"""What an RPLIDAR A1 tells in its standard mode, on 115200 baud: five bytes for each point.

Quality with a bit for the first point of a turn and its opposite, angle (1/64 degree) with a bit
that is set, range (1/4 mm). Source: Slamtec RPLIDAR interface protocol, revision 1.1.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.configuration.sensors import LidarConfig
from roomba.drivers.lidars.turns import TurnCollector
from roomba.drivers.line import Line
from roomba.robot.readings import ScanReading

STOP: Final = b"\xa5\x25"
SCAN: Final = b"\xa5\x20"
ANSWER: Final = b"\xa5\x5a\x05\x00\x00\x40\x81"
"""The lidar's answer to SCAN, before the first point."""
_POINT_SIZE: Final = 5
_PER_DEGREE: Final = 64.0
_PER_METRE: Final = 4000.0
_POINTS_IN_A_ROW: Final = 3
"""Points that must follow each other for the first of them to count: bytes may be lost."""


class RplidarPoints:
    """Makes scans of bytes; what is no point is passed over, byte by byte."""

    def __init__(self, config: LidarConfig, facing: float = 0.0) -> None:
        """Read the lidar of ``config``, turned by ``facing``, rad, in the robot."""
        self._turns = TurnCollector(config, facing)
        self._came = b""

    def begin(self, line: Line) -> None:
        """Let it measure. On the usual USB adapter its motor turns while DTR is off."""
        line.write(STOP)
        line.read(0.05)
        line.discard()
        line.write(SCAN)
        self._came = b""

    def take(self, data: bytes, arrived: float) -> list[ScanReading]:
        """Return the scans that are whole by now; ``arrived``, s, is when ``data`` came."""
        self._came += data
        if ANSWER in self._came:
            self._came = self._came.partition(ANSWER)[2]
        scans: list[ScanReading] = []
        while len(self._came) >= _POINTS_IN_A_ROW * _POINT_SIZE:
            followed = range(0, _POINTS_IN_A_ROW * _POINT_SIZE, _POINT_SIZE)
            if not all(_is_point(self._came[place : place + _POINT_SIZE]) for place in followed):
                self._came = self._came[1:]
                continue
            scan = self._turns.add(*_point_of(self._came[:_POINT_SIZE]), arrived)
            self._came = self._came[_POINT_SIZE:]
            if scan is not None:
                scans.append(scan)
        return scans


def _is_point(data: bytes) -> bool:
    first, angle = data[0], data[1] | data[2] << 8
    return (first ^ first >> 1) & 1 == 1 and angle & 1 == 1 and (angle >> 1) < 360 * _PER_DEGREE


def _point_of(data: bytes) -> tuple[float, float]:
    """Return the angle, degrees, and the range, m, inf without an echo."""
    distance = data[3] | data[4] << 8
    angle = ((data[1] | data[2] << 8) >> 1) / _PER_DEGREE
    return angle, distance / _PER_METRE if distance else math.inf
