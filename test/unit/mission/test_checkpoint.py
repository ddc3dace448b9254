"""A mission as plain values: it resumes where it was ended at any moment; junk is refused."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fixtures.robots.missions import HOME

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.checkpoint import checkpoint_of, remembered, state_after, take_up
from roomba.mission.cleaning.checkpoint import CheckpointError, Values
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, MissionState
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import NO_REASON, EdgeReason, Hindrance, OpenEdge, Phase, Reason

CONTEXT = PlanningContext(HOME.map, HOME.station, RobotConfig(), MissionConfig(), DockingConfig())
SENSES = Senses(100.0, Pose(1.0, 0.6, 0.0))
CLEANING = MissionState(Phase.CLEANING, Errand.CLEAN)


REASON = Reason("a message", Hindrance.STOP_RELEASED)
EDGE = OpenEdge(2.0, 1.0, -3.0, EdgeReason.NO_ECHO)


def begin(request: CleanRequest) -> Cleaning:
    return Cleaning(request, CONTEXT, DirtMap(HOME.map), MissionConfig().cleaning, SENSES.pose)


def job() -> Job:
    """A clean that is under way for a minute."""
    job = Job(DirtMap(HOME.map), MissionConfig(), 100.0, SENSES)
    job.begin_clean(begin(CleanRequest(passes=2)), Senses(40.0, SENSES.pose))
    job.ledger.distance, job.ledger.energy, job.ledger.dirt = 12.0, 0.5, 2.0
    job.ledger.driven, job.ledger.used = 11.0, 0.4
    job.times.restore({"turning": 20.0, "fastest": 0.3})
    job.open_edges, job.rough_way = (EDGE,), 3.0
    return job


def values(**changes: Any) -> Values:
    made = checkpoint_of(CLEANING, REASON, job(), SENSES.now)
    assert made is not None
    return json.loads(json.dumps(made)) | changes  # type: ignore[no-any-return]


def test_all_that_matters_comes_back() -> None:
    found = remembered(values(outcome="COMPLETED"), begin, MissionConfig().exploring)
    assert (found.state, found.reason) == (CLEANING, REASON)
    again, now = Job(DirtMap(HOME.map), MissionConfig(), 100.0, SENSES), 7.0
    take_up(found, again, Senses(now, SENSES.pose))
    assert again.cleaning is not None
    assert again.cleaning.ledger.request == CleanRequest(passes=2)
    assert again.exploration is None
    assert again.outcome is CleanOutcome.COMPLETED
    assert (again.ledger.distance, again.ledger.energy, again.ledger.dirt) == (12.0, 0.5, 2.0)
    assert (again.ledger.driven, again.ledger.used) == (11.0, 0.4)
    assert again.times.values() == job().times.values()
    assert (again.open_edges, again.rough_way) == ((EDGE,), 3.0)
    # By a clock that began anew.
    assert again.duration(now) == pytest.approx(60.0)


def test_a_checkpoint_of_an_older_program_goes_on() -> None:
    older = values()
    for added in ("open_edges", "rough_way", "hindrance", "driven"):
        del older[added]
    found = remembered(older, begin, MissionConfig().exploring)
    assert (found.open_edges, found.rough_way) == ((), 0.0)
    assert found.reason == Reason("a message")
    assert found.driven == found.ledger[:2] == (12.0, 0.5)


@pytest.mark.parametrize("errand", [Errand.NONE, Errand.UNDOCK])
def test_without_an_errand_there_is_nothing_to_remember(errand: Errand) -> None:
    assert checkpoint_of(MissionState(Phase.IDLE, errand), NO_REASON, job(), 0.0) is None


@pytest.mark.parametrize(
    "changes",
    [
        {"version": 0},
        {"phase": "FLYING"},
        {"cleaning": None},
        {"cleaning": {}},
        {"errand": "EXPLORE"},
        {"exploration": 3},
        {"ledger": [1.0, 2.0]},
        {"ledger": [1.0, 2.0, float("nan")]},
        {"driven": [1.0]},
        {"driven": [1.0, float("nan")]},
        {"duration": "long"},
        {"rough_way": float("nan")},
        {"times": {"turning": float("inf")}},
        {"times": {"turning": "long"}},
        {"times": 3},
        {"outcome": "WONDERFUL"},
        {"hindrance": "WONDERFUL"},
    ],
)
def test_junk_is_refused(changes: Values) -> None:
    with pytest.raises(CheckpointError, match="expected"):
        remembered(values(**changes), begin, MissionConfig().exploring)


@pytest.mark.parametrize("errand", [Errand.CLEAN, Errand.EXPLORE])
@pytest.mark.parametrize(
    ("before", "away", "docked"),
    [
        (Phase.UNDOCKING, Phase.UNDOCKING, Phase.UNDOCKING),
        (Phase.CLEANING, Phase.UNDOCKING, Phase.UNDOCKING),
        (Phase.RETURNING, Phase.UNDOCKING, Phase.CHARGING),
        (Phase.DOCKING, Phase.UNDOCKING, Phase.CHARGING),
        # Whether it was moved or has no current is seen there.
        (Phase.CHARGING, Phase.CHARGING, Phase.CHARGING),
    ],
)
def test_an_errand_goes_on_from_wherever_it_stands(
    errand: Errand, before: Phase, away: Phase, docked: Phase
) -> None:
    state = MissionState(before, errand)
    assert state_after(state, is_docked=False) == MissionState(away, errand)
    assert state_after(state, is_docked=True) == MissionState(docked, errand)


def test_on_its_way_home_it_goes_on_or_is_there() -> None:
    state = MissionState(Phase.DOCKING, Errand.HOME)
    assert state_after(state, is_docked=False) == MissionState(Phase.RETURNING, Errand.HOME)
    assert state_after(state, is_docked=True) == MissionState(Phase.DOCKED)


@pytest.mark.parametrize("resumes", [Phase.CLEANING, Phase.UNDOCKING, Phase.RETURNING])
def test_held_up_it_stays_so_and_on_its_station_it_charges_first(resumes: Phase) -> None:
    held = MissionState(Phase.PAUSED, Errand.CLEAN, resumes)
    away = state_after(held, is_docked=False)
    assert away.phase is Phase.PAUSED
    assert away.resumes is (Phase.UNDOCKING if resumes is Phase.CLEANING else resumes)
    docked = state_after(held, is_docked=True)
    assert docked == MissionState(Phase.PAUSED, Errand.CLEAN, Phase.CHARGING)


def test_held_up_on_its_way_home_it_stays_so() -> None:
    homewards = MissionState(Phase.ERROR, Errand.HOME, Phase.RETURNING)
    assert state_after(homewards, is_docked=False) == homewards
