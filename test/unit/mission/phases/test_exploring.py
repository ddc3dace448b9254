"""The phase of exploring: a touch close to a viewpoint ends the way there."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.obstacles import Standing
from fixtures.robots.missions import DOOR, TWO_ROOMS, WALL_X

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import UNKNOWN, OccupancyMap
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.exploring import explore, look_on
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import PhaseStep
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.planning.frontiers.frontiers import Frontier
from roomba.vocabulary import EdgeReason

ROBOT, CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(TWO_ROOMS.map, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig())
DRIVING = CONFIG.driving
SEEN = ThingLayer(SurfaceField.of(TWO_ROOMS.map))
IN_THE_DEN = Senses(0.0, Pose(3.0, 1.2, 0.0))
SPEED = 0.3


def shut_in() -> tuple[Drives, Job]:
    """A robot in the den that felt a pane in the doorway, and explores."""
    drives = Drives(
        CONTEXT, ROBOT, CONFIG.driving, Obstacles(SEEN, ROBOT.walk, ROBOT.body, DRIVING)
    )
    job = Job(DirtMap(TWO_ROOMS.map), CONFIG, 100.0, IN_THE_DEN)
    job.exploration = Exploration(CONFIG.exploring)
    feel_a_pane(drives)
    assert not drives.may_go_home(IN_THE_DEN)
    return drives, job


def feel_a_pane(drives: Drives) -> None:
    """Touch the doorway all along, where neither the map nor the lidar shows anything."""
    for y in np.arange(DOOR[0], DOOR[1], 0.1).tolist():
        beside = Pose(WALL_X + 0.2, y, math.pi)
        drives.obstacles.feel(replace(IN_THE_DEN, pose=beside, bumper_left=True, bumper_right=True))


def test_shut_in_by_what_it_touched_it_forgets_that_before_it_takes_all_for_seen() -> None:
    drives, job = shut_in()
    steps = [explore(job, drives, IN_THE_DEN, SPEED, 3)]
    while steps[-1] == PhaseStep():
        steps.append(explore(job, drives, IN_THE_DEN, SPEED, 3))
        assert len(steps) < 10
    assert steps[-1].event is Event.FINISHED
    assert drives.may_go_home(IN_THE_DEN)


def test_shut_in_for_good_it_tells_where_the_map_is_open() -> None:
    drives, job = shut_in()
    known = TWO_ROOMS.map.values.copy()
    # The last meter of the hall, behind the pane, was not seen.
    known[:, : TWO_ROOMS.map.frame.cell_of(1.0, 0.0)[1]] = UNKNOWN
    seen = OccupancyMap(TWO_ROOMS.map.frame, known)
    drives.use_context(PlanningContext(seen, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig()))
    assert job.exploration is not None
    steps = [explore(job, drives, IN_THE_DEN, SPEED, 3)]
    while steps[-1] == PhaseStep():
        feel_a_pane(drives)
        steps.append(explore(job, drives, IN_THE_DEN, SPEED, 3))
        assert len(steps) < 10
    assert steps[-1].event is Event.FINISHED
    (edge,) = job.exploration.open_edges(seen)
    assert edge.length > 1.0
    assert edge.x == pytest.approx(1.0, abs=0.1)
    assert edge.reason is EdgeReason.NOT_LOOKED_AT


@pytest.mark.parametrize("way", [0.05, 0.5])
def test_what_is_touched_by_a_viewpoint_ends_the_way_there_after_it_backed_off(way: float) -> None:
    exploration = Exploration(CONFIG.exploring)
    drives = Drives(CONTEXT, ROBOT, CONFIG.driving, Standing([]))
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
