"""How far a path is clear before the robot."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.rooms import room_home

from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.way_ahead import WayAhead
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.planning.path.planner import Path

CONFIG = RobotConfig()
HOME = room_home()
THING_X = 3.0
"""m; a thin thing stands there, on the path."""
LOOK_AHEAD = 0.4
BEAMS = 720


class Rig:
    """What a robot knows that looks along y = 2, and its path there."""

    def __init__(self) -> None:
        self.layer = ThingLayer(SurfaceField.of(HOME.map))
        self.obstacles = Obstacles(self.layer, CONFIG.walk, CONFIG.body, MissionConfig().driving)
        self.path = Path(np.array([(0.5, 2.0), (4.5, 2.0)]))
        self._lidar: LidarBeams = LidarModel.all_around(BEAMS, 0.1, 8.0).arrays()

    def see(self, thing_x: float | None, pose: Pose) -> None:
        """Take four scans, in which all but a thin thing on the path is far."""
        ranges = np.full(BEAMS, 6.0, np.float32)
        if thing_x is not None:
            ranges[[-2, -1, 0, 1, 2]] = thing_x - pose.x
        for _ in range(4):
            self.layer.see(ranges, self._lidar, pose)


def test_a_path_is_clear_as_far_as_it_was_looked_at() -> None:
    rig = Rig()
    ahead = WayAhead(rig.path, rig.obstacles, LOOK_AHEAD)
    assert not ahead.is_blocked(0.0)
    assert ahead.clear_to == pytest.approx(2.0 - LOOK_AHEAD)
    assert ahead.blocked_at is None
    # Where the look ended it looks on.
    assert not ahead.is_blocked(1.7)
    assert ahead.clear_to == pytest.approx(3.7 - LOOK_AHEAD)


def test_what_comes_is_noticed_and_blocks_from_look_ahead_on() -> None:
    rig = Rig()
    ahead = WayAhead(rig.path, rig.obstacles, LOOK_AHEAD)
    assert not ahead.is_blocked(1.0)
    rig.see(THING_X, Pose(1.5, 2.0))
    assert not ahead.is_blocked(1.0)
    assert ahead.blocked_at is not None
    reach = CONFIG.body.radius
    assert ahead.blocked_at == pytest.approx(THING_X - 0.5 - reach, abs=0.05)
    assert ahead.clear_to == pytest.approx(ahead.blocked_at - LOOK_AHEAD)
    assert ahead.is_blocked(ahead.clear_to + 0.01)
    assert not ahead.is_blocked(ahead.clear_to - 0.01)


def test_what_went_blocks_no_more() -> None:
    rig = Rig()
    rig.see(THING_X, Pose(1.5, 2.0))
    ahead = WayAhead(rig.path, rig.obstacles, LOOK_AHEAD)
    assert ahead.is_blocked(2.2)
    for _ in range(5):
        rig.see(None, Pose(2.2, 2.0))
    assert not ahead.is_blocked(2.2)
    assert ahead.blocked_at is None


def test_what_a_path_leads_away_from_is_not_in_its_way() -> None:
    rig = Rig()
    rig.see(0.8, Pose(0.5, 2.0))
    assert WayAhead(rig.path, rig.obstacles, LOOK_AHEAD).is_blocked(0.2)
    assert not WayAhead(rig.path, rig.obstacles, 0.01, leaves_until=0.6).is_blocked(0.2)
