"""Frames of LDROBOT's lidars: checked, found among garbled bytes, and gathered into scans."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.drivers.lidars.ld19 import POINTS, SIZE, Ld19Frames, crc8, frame_of
from roomba.emulators.lidars.ld19 import frame
from roomba.robot.readings import ScanReading

LD19 = SimulatedRobotConfig().with_lidar("ld19").lidar
LDS_02 = SimulatedRobotConfig().with_lidar("lds_02").lidar
CRC_OF_MANUAL = 0x50
EXAMPLE = bytes.fromhex(
    "542c6808ab7ee000e4dc00e2d900e5d500e3d300e4d000e9cd00e4ca00e2c700e9c500e5c200e5c000e5be823a1a50"
)
"""The frame that the development manual of the LD19 explains."""
WALL = 2.0


def square(beams: int) -> NDArray[np.float32]:
    """Ranges, clockwise, from the middle of a square room with walls 2 m away."""
    angles = np.arange(beams) * 2.0 * np.pi / beams
    ranges = WALL / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    return np.asarray(ranges, np.float32)


def turns(count: float, beams: int, rate: float, begin: float = 0.0) -> list[tuple[float, bytes]]:
    """Frames with the times at which they are sent, s."""
    ranges, sent = square(beams), []
    for first in range(0, round(count * beams), POINTS):
        places = np.arange(first, first + POINTS) % beams
        time = begin + (first + POINTS - 1) / beams / rate
        made = frame(places * 360.0 / beams, ranges[places], time, 360.0 * rate)
        sent.append((time, made))
    return sent


def scans_of(
    sent: list[tuple[float, bytes]], config: LidarConfig = LD19, late: float = 0.0
) -> list[ScanReading]:
    reader = Ld19Frames(config)
    return [scan for time, data in sent for scan in reader.take(data, time + late)]


def test_the_frame_of_the_manual_is_understood() -> None:
    assert len(EXAMPLE) == SIZE
    assert crc8(EXAMPLE[:-1]) == CRC_OF_MANUAL == EXAMPLE[-1]
    told = frame_of(EXAMPLE)
    assert told is not None
    assert (told.speed, told.first) == (2152, pytest.approx(324.27))
    assert told.ranges[0] == pytest.approx(0.224)
    assert told.ranges[-1] == pytest.approx(0.192)
    assert told.first + 11 * told.step == pytest.approx(334.70)
    assert told.time == 6714


@pytest.mark.parametrize("place", range(SIZE))
def test_a_garbled_byte_makes_no_frame(place: int) -> None:
    spoilt = EXAMPLE[:place] + bytes([EXAMPLE[place] ^ 0x10]) + EXAMPLE[place + 1 :]
    assert frame_of(spoilt) is None


@pytest.mark.parametrize(("config", "rate"), [(LD19, 10.0), (LDS_02, 5.0)])
def test_a_turn_is_a_scan_with_the_time_of_its_first_beam(config: LidarConfig, rate: float) -> None:
    scans = scans_of(turns(4.5, config.beams, rate, begin=7.0), config)
    assert len(scans) in (3, 4)
    ends = []
    for scan in scans[1:]:
        whole = scan.ranges[np.isfinite(scan.ranges)]
        assert len(whole) > 0.97 * config.beams
        view = scan.lidar.view(scan.ranges)
        ends.append(np.abs(view.ends[:, :2]).max(axis=1))
        assert (scan.stamp - 7.0) * rate == pytest.approx(round((scan.stamp - 7.0) * rate), abs=0.1)
        assert scan.lidar.sweep == pytest.approx(1.0 / rate, rel=0.02)
    assert np.concatenate(ends) == pytest.approx(WALL, abs=0.03)


def test_the_left_is_left() -> None:
    """Clockwise angles grow to the right."""
    sent = []
    for time, data in turns(2.5, 450, 10.0):
        told = frame_of(data)
        assert told is not None
        angles = told.first + told.step * np.arange(POINTS)
        ranges = np.where((angles > 80.0) & (angles < 100.0), 1.0, 3.0).astype(np.float32)
        sent.append((time, frame(angles, ranges, time, 3600.0)))
    scan = scans_of(sent)[-1]
    ends = scan.lidar.view(scan.ranges).ends
    near = ends[np.hypot(ends[:, 0], ends[:, 1]) < 2.0]
    assert len(near) > 20
    assert (near[:, 1] < -0.9).all()


def test_ten_thousand_random_bytes_make_no_scan_and_hide_none() -> None:
    reader, random = Ld19Frames(LD19), np.random.default_rng(4)
    assert reader.take(random.bytes(10_000), 0.0) == []
    scans = [s for time, data in turns(3.5, 450, 10.0, 1.0) for s in reader.take(data, time)]
    assert len(scans) >= 2


def test_half_frames_and_spoilt_ones_cost_no_more_than_their_turns() -> None:
    random = np.random.default_rng(5)
    sent = turns(40.0, 450, 10.0)
    for place in random.choice(len(sent), 20, replace=False):
        time, data = sent[place]
        cut = int(random.integers(1, SIZE))
        sent[place] = time, data[:cut] if place % 2 else data[:cut] + b"\xff" + data[cut + 1 :]
    scans = scans_of(sent)
    assert len(scans) >= 30
    for scan in scans:
        ends = scan.lidar.view(scan.ranges).ends
        assert np.abs(ends[:, :2]).max(axis=1) == pytest.approx(WALL, abs=0.03)


def test_a_turn_with_a_large_gap_is_none() -> None:
    sent = turns(3.0, 450, 10.0)
    kept = [each for each in sent if not 0.11 < each[0] < 0.13]
    assert len(scans_of(kept)) == len(scans_of(sent)) - 1


def test_after_two_seconds_of_silence_it_goes_on() -> None:
    scans = scans_of(turns(2.5, 450, 10.0) + turns(2.5, 450, 10.0, begin=2.25))
    assert len(scans) >= 2
    assert max(scan.lidar.sweep for scan in scans) < 0.11


def test_bytes_that_wait_on_the_way_change_no_stamp() -> None:
    sent, random = turns(20.0, 450, 10.0), np.random.default_rng(6)
    arrivals = np.maximum.accumulate([time + random.exponential(0.01) for time, _ in sent])
    waited = [(float(at), data) for at, (_, data) in zip(arrivals, sent, strict=True)]
    stamps = [scan.stamp for scan in scans_of(waited)][8:]
    off = [abs(stamp * 10.0 - round(stamp * 10.0)) / 10.0 for stamp in stamps]
    assert max(off) < 0.004


def test_no_echo_is_no_range() -> None:
    ranges = np.full(POINTS, np.inf, np.float32)
    told = frame_of(frame(np.arange(POINTS) * 0.8, ranges, 0.0, 3600.0))
    assert told is not None
    assert all(map(math.isinf, told.ranges))
