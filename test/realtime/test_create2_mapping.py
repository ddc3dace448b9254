"""The brain maps a home with a Create 2 and an LD19 at the ends of their lines, in real time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fixtures.robots.create2_rig import Create2Rig
from fixtures.robots.mapped import wrong_cells
from fixtures.waiting import wait_until

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import load_robot_config
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.slam.mapper import Mapper
from roomba.robot.brain import Brain

TICK = 0.05
"""s"""
STRAY = 30
"""Cells of a map of some thousand that may be wrong; a doubled wall has hundreds."""


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Create2Rig]:
    made = Create2Rig(tmp_path)
    yield made
    made.end()


class Driven:
    """A brain that is steered by hand, and drives the robot at the end of the line."""

    def __init__(self, rig: Create2Rig) -> None:
        config = load_robot_config(CONFIGURATION / "robots" / "create2.yaml")
        mission = MissionConfig().slowed_for(config.body)
        station = rig.simulator.home.station
        self.rig = rig
        self.brain = Brain(MappingConfig(), station, config, mission, DockingConfig())
        self.here = Pose()

    def drive(self, twist: Twist, is_so: Callable[[Pose], bool], what: str) -> None:
        """Drive until the odometry since now is so."""
        begin = self.rig.body.read().odometry

        def ticked() -> bool:
            readings = self.rig.body.read()
            self.brain.sense(readings)
            self.rig.body.act(self.brain.steer(twist))
            self.here = readings.odometry
            return is_so(begin.inverse().compose(readings.odometry))

        wait_until(ticked, 60.0, what, pause=TICK)

    @property
    def mapper(self) -> Mapper:
        mapper = self.brain.mapper
        assert mapper is not None
        return mapper

    def errors(self) -> tuple[float, float]:
        """How far the brain takes the robot from where it stands, m and rad."""
        true, told = self.rig.simulator.pose, self.brain.pose
        return told.distance_to(true.x, true.y), abs(wrap_angle(told.theta - true.theta))


def test_a_drive_in_the_studio_makes_its_map(rig: Create2Rig) -> None:
    driven = Driven(rig)
    driven.drive(Twist(), lambda moved: driven.brain.is_ready, "the first scan")
    driven.drive(Twist(-0.15, 0.0), lambda moved: moved.x < -0.6, "it leaves its station")
    for _ in range(3):
        driven.drive(Twist(0.0, 0.4), lambda moved: moved.theta > 2.1, "a third of a turn")
    driven.drive(Twist(-0.15, 0.1), lambda moved: moved.x < -0.5, "it goes on")
    driven.drive(Twist(0.1, -0.4), lambda moved: moved.theta < -math.radians(100.0), "a curve")
    still = rig.simulator.time
    driven.drive(Twist(), lambda moved: rig.simulator.time > still + 1.0, "it stands")
    way, turn = driven.errors()
    assert driven.mapper.estimate.knowledge is Knowledge.KNOWN
    assert way < 0.03
    assert turn < 0.03
    ghosts, holes = wrong_cells(driven.mapper.occupancy(), rig.simulator.home)
    assert max(ghosts, holes) <= STRAY
    assert (driven.mapper.occupancy().values == 100).sum() > 200
    assert rig.body.trouble == rig.lidar.trouble == ""
