"""The phase of cleaning: it is finished after another look at what was out of reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from fixtures.homes.obstacles import Standing
from fixtures.robots.missions import TWO_ROOMS, WALL_X

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.cleaning import CleanPhase
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import PhaseStep
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.dirt_map import DirtMap

ROBOT, CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(TWO_ROOMS.map, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig())
IN_THE_DEN = Senses(0.0, Pose(3.0, 1.2, 0.0))
FENCE: list[RoundObstacle] = [(WALL_X + 0.05, float(y), 0.05) for y in np.arange(0.85, 1.6, 0.1)]
SPEED = 0.3


def test_with_nothing_left_the_clean_is_finished_after_another_look() -> None:
    drives = Drives(CONTEXT, ROBOT, CONFIG.driving, Standing(FENCE))
    job = Job(DirtMap(TWO_ROOMS.map), CONFIG, 100.0, IN_THE_DEN)
    here = replace(IN_THE_DEN, pose=Pose(0.8, 1.2, 0.0))
    job.begin_clean(Cleaning(CleanRequest(), CONTEXT, job.dirt, CONFIG.cleaning, here.pose), here)
    assert job.cleaning is not None
    coverage = job.cleaning.ledger.coverage
    hall = slice(0, CONTEXT.frame.cell_of(WALL_X, 0.0)[1])
    coverage.cells[:, hall] |= SWEPT
    coverage.count_again()
    # The den was found to be out of reach: perhaps its door is open by now.
    job.cleaning.cut_off()
    phase = CleanPhase(job, drives, RetryPolicy(CONFIG.driving.waiting), CONFIG.exploring)
    steps = [phase.tick(here, SPEED)]
    while steps[-1] == PhaseStep():
        steps.append(phase.tick(here, SPEED))
        assert len(steps) < 10
    assert steps[-1].event is Event.FINISHED
    assert len(steps) > 1
