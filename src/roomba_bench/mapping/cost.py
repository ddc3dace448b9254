"""The cost of mapping: the share of a core while driving, and the speed of a whole exploration."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.mapper import Mapper
from roomba_bench.coverage.clean import home_named
from roomba_bench.ours_sim import ROBOT


@dataclass(frozen=True, eq=False)
class Heard:
    """The readings of a tick: ``ranges`` is None where there was no new scan."""

    stamp: float
    odometry: Pose
    turning: float | None
    ranges: NDArray[np.float32] | None


@dataclass(frozen=True, eq=False)
class Recorded:
    """The readings of a whole exploration, to be mapped again."""

    heard: list[Heard]
    lidar: LidarModel
    start: Pose


class _Listener(HeadlessMission):
    """Records what the mapper hears, with all scans instead of every other one."""

    def begin(self) -> None:
        self.heard: list[Heard] = []
        self._heard_scans = -1
        self._hear()

    def tick(self) -> None:
        super().tick()
        self._hear()

    def _hear(self) -> None:
        seen = self.seen
        ranges = None if seen.scans == self._heard_scans else self.simulator.ranges.copy()
        self._heard_scans = seen.scans
        self.heard.append(Heard(seen.time, seen.odometry, seen.angular_velocity, ranges))


def speed(home: str, seed: int, folder: str = "") -> float:
    """Return how many s of robot time an exploration simulates in a second of one core.

    ``folder`` is of map_server maps, or "" for a shipped home.
    """
    robot = HeadlessMission(home_named(home, folder), ROBOT, seed=seed, known=MappingConfig())
    began = time.process_time()
    record = robot.explore()
    return record.result.duration / (time.process_time() - began)


def recorded(home: str, seed: int) -> Recorded:
    """Explore a home, and return its readings."""
    robot = _Listener(home_named(home), ROBOT, seed=seed, known=MappingConfig(), longest_burst=0)
    robot.begin()
    robot.explore()
    return Recorded(robot.heard, robot.lidar, robot.simulator.start)


def share_of_core(drive: Recorded) -> float:
    """Return the share of a core that mapping took while it drove, all drawing included, 0..1."""
    mapper = Mapper(MappingConfig(), ROBOT.localization, ROBOT.gyro, drive.start)
    shown, began = drive.heard[0].stamp, time.process_time()
    for each in drive.heard:
        mapper.move(each.stamp, each.odometry, each.turning)
        if each.ranges is not None:
            mapper.see(each.stamp, each.ranges, drive.lidar)
        if mapper.version and each.stamp - shown >= ROBOT.timing.map_period:
            shown = each.stamp
            mapper.occupancy()
    spent = time.process_time() - began
    return spent / (drive.heard[-1].stamp - drive.heard[0].stamp)
