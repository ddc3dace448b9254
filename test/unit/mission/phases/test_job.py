"""The job under way: its ledgers, and its report at the end."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.missions import HOME

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import UNKNOWN, OccupancyMap
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import EdgeReason

ROBOT, CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(HOME.map, HOME.station, ROBOT, CONFIG, DockingConfig())
AWAY = Senses(0.0, Pose(1.0, 0.6, 0.0))


def half_known() -> PlanningContext:
    """The home of which nothing is known beyond x = 1.5 m."""
    values = HOME.map.values.copy()
    values[:, HOME.map.frame.cell_of(1.5, 0.0)[1] :] = UNKNOWN
    known = OccupancyMap(HOME.map.frame, values)
    return PlanningContext(known, HOME.station, ROBOT, CONFIG, DockingConfig(), is_growing=True)


HALF = half_known()
EDGE = (1.5, 1.0)


def obstacles() -> Obstacles:
    things = ThingLayer(SurfaceField.of(HOME.map))
    return Obstacles(things, ROBOT.walk, ROBOT.body, CONFIG.driving)


def cleaning_job() -> Job:
    job = Job(DirtMap(HOME.map), CONFIG, 100.0, AWAY, ROBOT.localization.known_deviation)
    clean = Cleaning(CleanRequest(), CONTEXT, job.dirt, CONFIG.cleaning, AWAY.pose)
    job.begin_clean(clean, AWAY)
    return job


def end(
    job: Job,
    outcome: CleanOutcome,
    message: str = "",
    *,
    can_go_on: bool = False,
    context: PlanningContext = CONTEXT,
) -> None:
    senses = replace(AWAY, now=60.0)
    job.end(outcome, message, context, obstacles(), senses, can_go_on=can_go_on)


def test_with_nothing_cleaned_a_completed_clean_says_why() -> None:
    job = cleaning_job()
    end(job, CleanOutcome.COMPLETED)
    result = job.take_result()
    assert result is not None
    assert (result.outcome, result.covered) == (CleanOutcome.COMPLETED, 0.0)
    assert result.message.startswith("nothing of it")
    assert job.cleaning is None


def test_with_all_cleaned_there_is_nothing_to_say() -> None:
    job = cleaning_job()
    assert job.cleaning is not None
    job.cleaning.ledger.coverage.cells[:] |= SWEPT
    job.cleaning.ledger.coverage.count_again()
    end(job, CleanOutcome.COMPLETED)
    result = job.take_result()
    assert result is not None
    assert (result.message, result.missed, result.fraction) == ("", (), 1.0)
    assert result.duration == 60.0


@pytest.mark.parametrize("outcome", [CleanOutcome.STOPPED, CleanOutcome.STUCK])
def test_what_ended_it_early_is_told_as_it_is(outcome: CleanOutcome) -> None:
    job = cleaning_job()
    end(job, outcome, "a person sat on it")
    result = job.take_result()
    assert result is not None
    assert result.message == "a person sat on it"


def test_a_result_is_told_once_and_after_going_on_there_is_another_one() -> None:
    job = cleaning_job()
    end(job, CleanOutcome.STUCK, "a cable", can_go_on=True)
    assert job.cleaning is not None
    assert job.take_result() is not None
    end(job, CleanOutcome.STUCK, "a cable", can_go_on=True)
    assert job.take_result() is None
    job.take_up()
    end(job, CleanOutcome.STOPPED, "told to")
    assert job.take_result() is not None
    assert job.cleaning is None


def test_what_was_told_and_is_over_then_is_forgotten() -> None:
    job = cleaning_job()
    end(job, CleanOutcome.NOT_DOCKED, "a door is shut", can_go_on=True)
    assert job.take_result() is not None
    end(job, CleanOutcome.STOPPED)
    assert job.take_result() is None
    assert job.cleaning is None


def test_what_it_passes_is_swept_where_its_place_is_known_and_it_drives() -> None:
    job = cleaning_job()
    assert job.cleaning is not None
    coverage = job.cleaning.ledger.coverage
    there = replace(AWAY, now=0.05, pose=Pose(1.05, 0.6, 0.0))
    job.account(there, AWAY, drives=True, sweeps=False)
    job.account(replace(there, knowledge=Knowledge.SEARCHING), AWAY, drives=True, sweeps=True)
    assert coverage.swept_cells == 0
    job.account(there, AWAY, drives=True, sweeps=True)
    assert coverage.swept_cells > 100


@pytest.mark.parametrize(
    ("knowledge", "unsure", "is_told"),
    [
        (Knowledge.KNOWN, 0.01, False),
        (Knowledge.ROUGH, 0.07, True),
        (Knowledge.ROUGH, math.inf, True),
        # As by a lidar whose scans come a second late.
        (Knowledge.ROUGH, 0.02, False),
    ],
)
def test_a_way_on_which_the_place_was_hardly_known_is_told(
    knowledge: Knowledge, unsure: float, is_told: bool
) -> None:
    job, last = cleaning_job(), AWAY
    for step in range(1, 60):
        here = Pose(1.0 + 0.02 * step, 0.6, 0.0)
        senses = Senses(0.1 * step, here, knowledge=knowledge, unsure=unsure)
        job.account(senses, last, drives=True, sweeps=True)
        last = senses
    end(job, CleanOutcome.COMPLETED)
    result = job.take_result()
    assert result is not None
    assert ("its place was known roughly" in result.message) == is_told


def test_time_that_a_clock_jumps_does_not_count() -> None:
    job = cleaning_job()
    job.account(replace(AWAY, now=1.0), AWAY, drives=True, sweeps=True)
    job.account(replace(AWAY, now=1e6), replace(AWAY, now=1.0), drives=True, sweeps=True)
    assert job.duration(1e6 + 1.0) == pytest.approx(2.0)


def test_the_rest_takes_energy_by_its_floor_and_that_of_an_exploration_is_unknown() -> None:
    job = cleaning_job()
    needed = job.needed_energy(0.2)
    assert needed > 0.0
    assert job.needed_energy(0.1) == pytest.approx(2.0 * needed)
    assert job.cleaning is not None
    # Few patches may have a long way between them: the path that was broken off tells.
    job.cleaning.interrupted(np.array([(0.0, 0.0), (1000.0, 0.0)]))
    assert job.needed_energy(0.2) > 10.0 * needed
    job.forget()
    assert job.needed_energy(0.2) == 0.0
    job.begin_exploration(AWAY)
    assert job.needed_energy(0.2) == float("inf")


def test_an_exploration_tells_what_is_known() -> None:
    job = Job(DirtMap(HOME.map), CONFIG, 100.0, AWAY)
    job.begin_exploration(AWAY)
    end(job, CleanOutcome.COMPLETED)
    result = job.take_exploration()
    assert result is not None
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert result.known > 5.0
    assert job.take_result() is None
    assert job.exploration is None


def test_an_exploration_that_left_the_map_open_tells_where() -> None:
    job = Job(DirtMap(HOME.map), CONFIG, 100.0, AWAY)
    job.begin_exploration(AWAY)
    assert job.exploration is not None
    job.exploration.give_up(EDGE, 0.6)
    end(job, CleanOutcome.COMPLETED, context=HALF)
    result = job.take_exploration()
    assert result is not None
    assert result.message.startswith("the map is open for ")
    assert "the lidar met nothing" in result.message
    (edge,) = result.open_edges
    assert ((edge.x, edge.y), edge.reason) == (EDGE, EdgeReason.NO_ECHO)


def test_a_clean_of_a_home_that_it_explored_tells_where_the_map_stayed_open() -> None:
    job = cleaning_job()
    job.exploration = Exploration(CONFIG.exploring)
    job.exploration.give_up(EDGE)
    job.look_no_more(HALF.known)
    assert job.exploration is None
    end(job, CleanOutcome.COMPLETED)
    result = job.take_result()
    assert result is not None
    assert "the map is open for " in result.message
    assert "it got to no place from which to look there" in result.message
    (edge,) = result.open_edges
    assert ((edge.x, edge.y), edge.reason) == (EDGE, EdgeReason.NOT_LOOKED_AT)
