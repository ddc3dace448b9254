"""Points of an RPLIDAR A1, found among garbled bytes, and gathered into scans."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.drivers.lidars.rplidar import ANSWER, SCAN, STOP, RplidarPoints
from roomba.robot.readings import ScanReading

A1 = SimulatedRobotConfig().with_lidar("rplidar_a1").lidar
RATE = 5.5
"""Turns a second."""
WALL = 1.5


class Recorded:
    """A line that keeps what was written."""

    def __init__(self) -> None:
        self.written = b""

    def write(self, data: bytes) -> None:
        self.written += data

    def read(self, seconds: float) -> bytes:
        return b""

    def discard(self) -> None:
        self.written += b"|"

    def close(self) -> None:
        pass


def point(angle: float, distance: float, is_first: bool) -> bytes:
    """As the protocol of Slamtec has it: angle in degrees, range in m."""
    flags = 15 << 2 | (1 if is_first else 2)
    return struct.pack("<BHH", flags, round(angle * 64) << 1 | 1, round(distance * 4000))


def turns(count: float) -> list[tuple[float, bytes]]:
    sent = []
    for place in range(round(count * 360)):
        angle = float(place % 360)
        radians = np.radians(angle)
        distance = WALL / max(abs(np.cos(radians)), abs(np.sin(radians)))
        sent.append((place / 360 / RATE, point(angle, distance, angle == 0.0)))
    return sent


def scans_of(sent: list[tuple[float, bytes]], before: bytes = ANSWER) -> list[ScanReading]:
    reader = RplidarPoints(A1)
    scans = reader.take(before, 0.0)
    return scans + [scan for time, data in sent for scan in reader.take(data, time)]


def test_it_is_asked_to_measure() -> None:
    line = Recorded()
    RplidarPoints(A1).begin(line)
    assert line.written == STOP + b"|" + SCAN


def test_a_turn_is_a_scan() -> None:
    scans = scans_of(turns(4.5))
    assert len(scans) == 3
    for scan in scans:
        ends = scan.lidar.view(scan.ranges).ends
        assert len(ends) == 360
        assert np.abs(ends[:, :2]).max(axis=1) == pytest.approx(WALL, abs=0.03)
        assert scan.lidar.sweep == pytest.approx(1.0 / RATE, rel=0.02)


def test_random_bytes_make_no_scan_and_hide_none() -> None:
    random = np.random.default_rng(7)
    assert scans_of([], random.bytes(10_000)) == []
    assert len(scans_of(turns(4.5), random.bytes(10_000) + ANSWER)) == 3


def test_lost_bytes_cost_few_turns_and_make_hardly_a_wrong_point() -> None:
    random = np.random.default_rng(7)
    sent = turns(200.0)
    for place in random.choice(len(sent), 150, replace=False):
        time, data = sent[place]
        sent[place] = time, data[: int(random.integers(0, 5))]
    scans, wrong = scans_of(sent), 0
    for scan in scans:
        ends = scan.lidar.view(scan.ranges).ends
        wrong += int((np.abs(np.abs(ends[:, :2]).max(axis=1) - WALL) > 0.05).sum())
    assert len(scans) > 165
    assert wrong <= 5
