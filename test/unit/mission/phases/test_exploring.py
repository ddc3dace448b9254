"""The phase of exploring: what is touched beside a place to look from ends the way there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.obstacles import Standing
from fixtures.robots.missions import TWO_ROOMS

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.driving.drives import Drives
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.exploring import look_on
from roomba.planning.frontiers.frontiers import Frontier

ROBOT, CONFIG = RobotConfig(), MissionConfig()
SITE = PlanningContext(TWO_ROOMS.map, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig())
IN_THE_DEN = Senses(0.0, Pose(3.0, 1.2, 0.0))
SPEED = 0.3


@pytest.mark.parametrize("way", [0.05, 0.5])
def test_what_is_touched_by_a_viewpoint_ends_the_way_there_after_it_backed_off(way: float) -> None:
    exploration = Exploration(CONFIG.exploring)
    drives = Drives(SITE, ROBOT, CONFIG.driving, Standing([]))
    here = IN_THE_DEN.pose
    there = (here.x + way, here.y)
    exploration.goal = Frontier((there[0] + 0.2, here.y), there, way, 0.5)
    drives.begin(np.array([(here.x - 0.3, here.y), there]), IN_THE_DEN)
    begun = drives.driver
    touching = replace(IN_THE_DEN, now=0.05, bumper_left=True)
    assert look_on(exploration, drives, touching, SPEED, 3).twist.linear <= 0.0
    assert drives.driver is begun
    back = Pose(here.x - 2.0 * CONFIG.driving.backing_way, here.y, 0.0)
    look_on(exploration, drives, replace(IN_THE_DEN, now=1.0, pose=back), SPEED, 3)
    is_near = way < CONFIG.exploring.viewpoint_tolerance
    assert (drives.driver is None) == is_near
    assert (exploration.goal is None) == is_near
