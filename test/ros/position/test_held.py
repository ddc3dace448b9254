"""While a map is finished in the background, no message may change it."""

from __future__ import annotations

from typing import cast

import numpy as np

from roomba.configuration.nodes import NodesConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.perception.localization.localizer import Localizer
from roomba.perception.matching.scan_view import LidarModel
from roomba.robot.place import PlaceKeeper
from roomba.robot.readings import Readings, ScanReading
from roomba_ros.localization.topics import LocalizationTopics


class Followed:
    """A keeper of the place that writes down what it is passed."""

    def __init__(self) -> None:
        self.passed: list[Readings] = []

    def follow(self, readings: Readings) -> None:
        self.passed.append(readings)


def test_a_map_that_is_finished_hears_of_no_scan_and_no_touch() -> None:
    topics, keeper = LocalizationTopics(RobotConfig(), NodesConfig()), Followed()
    lidar = LidarModel.all_around(8, 0.1, 5.0)
    scan = ScanReading(1.0, np.ones(8, np.float32), lidar)
    heard = Readings(1.0, Pose(0.1), scan=scan, bumper_left=True, bumper_right=True)
    for is_held in (False, True):
        topics.is_mapping_held = is_held
        topics._follow(cast("PlaceKeeper", keeper), cast("Localizer", None), heard)
    assert keeper.passed[0] is heard
    held = keeper.passed[1]
    assert (held.time, held.odometry) == (heard.time, heard.odometry), "its place goes on"
    assert held.scan is None
    assert not held.bumps
