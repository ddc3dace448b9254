"""A map by odometry alone: true where odometry is, and wrong where it is."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.commands.map.blind_map import BlindMap
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED
from roomba.perception.matching.scan_view import LidarModel

CONFIG = RobotConfig()
ANGLES = np.arange(360) * 2.0 * math.pi / 360.0
LIDAR = LidarModel(ANGLES, 0.15, 12.0)
SWEEP = 0.2
"""s that a lidar takes which turns."""
START = Pose(1.0, 1.0, 0.0)


def _ranges(at: Pose, turned: float = 0.0) -> NDArray[np.float32]:
    """What is seen in a room of 4 x 2 m whose corner is the origin.

    From the first beam to the last the robot has ``turned``, rad.
    """
    angles = at.theta + ANGLES + np.linspace(0.0, turned, 360)
    cosine, sine = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore"):
        x = np.where(cosine > 0.0, (4.0 - at.x) / cosine, -at.x / cosine)
        y = np.where(sine > 0.0, (2.0 - at.y) / sine, -at.y / sine)
    return np.minimum(x, y).astype(np.float32)


def _drive(turned: float = 0.0) -> BlindMap:
    """Go 2 m along the room; the odometry tells of a turn beside."""
    blind = BlindMap(MappingConfig(), CONFIG.localization, CONFIG.gyro, START)
    for tick in range(201):
        way, now = 0.01 * tick, 0.05 * tick
        blind.move(now, Pose(way, 0.0, turned * tick / 200.0))
        blind.see(now, _ranges(Pose(START.x + way, START.y, 0.0)), LIDAR)
    return blind


def test_before_the_first_scan_there_is_no_map() -> None:
    blind = BlindMap(MappingConfig(), CONFIG.localization, CONFIG.gyro, START)
    blind.move(0.0, Pose())
    with pytest.raises(ValueError, match="at least one scan"):
        blind.occupancy()


def test_true_odometry_draws_the_room() -> None:
    blind = _drive()
    assert blind.pose.x == pytest.approx(3.0)
    occupancy = blind.occupancy()
    frame, values = occupancy.frame, occupancy.values
    assert values[frame.cell_of(2.0, 1.0)] == FREE
    for x, y in ((4.02, 1.0), (-0.02, 1.0), (2.0, 2.02), (2.0, -0.02)):
        assert values[frame.cell_of(x, y)] == OCCUPIED
    area = np.count_nonzero(values == FREE) * frame.resolution**2
    assert area == pytest.approx(8.0, abs=0.4)


def test_wrong_odometry_draws_walls_where_there_are_none() -> None:
    area = np.count_nonzero(_drive(0.3).occupancy().values == FREE) * 0.05**2
    assert area > 8.6


def test_of_a_lidar_that_turns_each_beam_is_drawn_from_where_it_was_measured() -> None:
    blind = BlindMap(MappingConfig(), CONFIG.localization, CONFIG.gyro, START)
    lidar = LidarModel(ANGLES, 0.15, 12.0, time_increment=SWEEP / 359.0)
    blind.move(0.0, Pose())
    for scan in range(40):
        stamp, theta = SWEEP * scan, SWEEP * scan
        blind.move(stamp + SWEEP, Pose(0.0, 0.0, theta + SWEEP))
        blind.see(stamp, _ranges(Pose(START.x, START.y, theta), SWEEP), lidar)
    occupancy = blind.occupancy()
    x, y = occupancy.frame.centres(*np.nonzero(occupancy.values == OCCUPIED))
    off = np.maximum(np.abs(x - 2.0) - 2.0, np.abs(y - 1.0) - 1.0)
    assert len(off) > 0.8 * 12.0 / occupancy.frame.resolution
    assert np.abs(off).max() < 1.5 * occupancy.frame.resolution


def test_a_robot_that_stands_draws_once(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[float] = []
    monkeypatch.setattr(
        "roomba.commands.map.blind_map.OccupancyCounts.draw",
        lambda *given: drawn.append(given[3][0]),
    )
    blind = BlindMap(MappingConfig(), CONFIG.localization, CONFIG.gyro, START)
    for tick in range(40):
        # It goes 0.10 m, less than a keyframe wants; then 0.10 m more.
        blind.move(0.05 * tick, Pose(0.005 * tick))
        blind.see(0.05 * tick, _ranges(START), LIDAR)
    assert drawn == pytest.approx([1.0, 1.15], abs=0.006)


def test_a_scan_of_long_ago_is_left_out() -> None:
    blind = BlindMap(MappingConfig(), CONFIG.localization, CONFIG.gyro, START)
    blind.move(10.0, Pose())
    blind.see(1.0, _ranges(START), LIDAR)
    with pytest.raises(ValueError, match="at least one scan"):
        blind.occupancy()
