"""Out of the station, into it, and charging on it: what ends each of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from fixtures.robots.missions import HOME, STATION

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.docking.beams import StationBeams
from roomba.mission.docking.docking import Docking, DockState
from roomba.mission.docking.step import DockStep, Trouble
from roomba.mission.docking.undocking import Undocking, UndockState, UndockStep
from roomba.mission.inputs.senses import Battery, EmptyingTold, Senses
from roomba.mission.phases import at_station
from roomba.mission.phases.at_station import AtStation
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Event
from roomba.mission.phases.step import Failure, PhaseStep
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import NO_REASON, Hindrance

DOCKED = Senses(0.0, STATION, battery=Battery(0.5, 26.0, is_docked=True))
BEFORE = Senses(0.0, Pose(0.9, 1.25, 0.0))
STAGING = STATION.compose(Pose(-0.65, 0.0, 0.0))
BACK = Twist(-0.1, 0.0)
TOOL = 0.2


def at_the_station() -> AtStation:
    return AtStation(DockingConfig(), RobotConfig())


def four_twists(at_it: AtStation, senses: Senses) -> list[Twist]:
    """Return what docking wants at its first ticks of a robot that senses so."""
    ticks = (replace(senses, now=0.05 * tick) for tick in range(4))
    return [at_it.dock(each, STATION, STAGING).twist for each in ticks]


def test_it_drives_out_backwards() -> None:
    step = at_the_station().undock(DOCKED, STATION)
    assert step.twist.linear < 0.0
    assert (step.event, step.failure) == (None, None)


def test_with_contacts_behind_it_drives_out_ahead_and_in_backwards() -> None:
    robot = RobotConfig()
    backwards = robot.body.model_copy(update={"docks_backwards": True})
    silent = robot.station.model_copy(update={"has_beams": False})
    robot = robot.model_copy(update={"body": backwards, "station": silent})
    at_it = AtStation(DockingConfig(), robot)
    docked = replace(DOCKED, pose=backwards.docked_at(STATION))
    assert at_it.undock(docked, STATION).twist.linear > 0.0
    before = STATION.compose(Pose(-0.6, 0.0, 0.0))
    # The bumper is at its other end: what it meets is not the station.
    away = Senses(0.0, backwards.docked_at(before), bumper_left=True)
    wanted = [
        at_it.dock(replace(away, now=0.05 * tick), STATION, STAGING).twist for tick in range(4)
    ]
    assert wanted[-1].linear < 0.0
    assert abs(wanted[-1].angular) < 0.05
    # One that looks at the station turns about first.
    at_it.forget()
    faces = replace(away, pose=before)
    turns = [
        at_it.dock(replace(faces, now=0.05 * tick), STATION, STAGING).twist for tick in range(4)
    ]
    assert turns[-1].linear == 0.0
    assert abs(turns[-1].angular) > 0.5


@pytest.mark.parametrize(
    ("state", "event", "failure"),
    [
        (UndockState.OUT, Event.OUT, None),
        (UndockState.FAILED, None, Failure(CleanOutcome.STUCK, "a cable")),
    ],
)
def test_how_undocking_ends(
    monkeypatch: pytest.MonkeyPatch, state: UndockState, event: Event | None, failure: Failure
) -> None:
    ended = UndockStep(state, BACK, "a cable")
    monkeypatch.setattr(Undocking, "tick", lambda undocking, senses: ended)
    assert at_the_station().undock(DOCKED, STATION) == PhaseStep(BACK, event, failure)


@pytest.mark.parametrize(
    ("state", "event", "failure"),
    [
        (DockState.APPROACHING, None, None),
        (DockState.DOCKED, Event.CONTACT, None),
        (DockState.FAILED, None, Failure(CleanOutcome.NOT_DOCKED, "no power")),
    ],
)
def test_how_docking_ends(
    monkeypatch: pytest.MonkeyPatch, state: DockState, event: Event | None, failure: Failure
) -> None:
    ended = DockStep(state, BACK, "no power")
    monkeypatch.setattr(Docking, "tick", lambda docking, senses: ended)
    assert at_the_station().dock(BEFORE, STATION, STAGING) == PhaseStep(BACK, event, failure)


def test_without_beams_it_waits_until_it_sees_them_for_a_while(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ended = DockStep(DockState.FAILED, BACK, "no power", 1, Trouble.NO_POWER)
    monkeypatch.setattr(Docking, "tick", lambda docking, senses: ended)
    station = at_the_station()
    failure = station.dock(BEFORE, STATION, STAGING).failure
    assert failure is not None
    assert failure.awaits_beams
    assert "as soon as it sees the beams" in failure.reason
    lit = replace(BEFORE, beams=StationBeams(halo=True))
    # Of another failure it waits for a person.
    assert station.look_for_beams(replace(lit, now=100.0)) == PhaseStep()
    station.await_beams(BEFORE)
    seen = [replace(lit if tick > 100 else BEFORE, now=0.1 * tick) for tick in range(200)]
    events = [station.look_for_beams(senses).event for senses in seen]
    seen_at = events.index(Event.BEAMS_SEEN)
    assert seen[seen_at].now == pytest.approx(10.0 + DockingConfig().contact_wait, abs=0.2)
    station.await_beams(BEFORE)
    held = [replace(each, wheel_hangs=True) for each in seen]
    assert not any(station.look_for_beams(senses).event for senses in held)
    # A person has it walk, and it stands before its station again.
    station.look_for_beams(replace(BEFORE, pose=Pose(2.0, 1.25, 0.0)))
    assert not any(station.look_for_beams(senses).event for senses in seen)


def test_it_goes_on_docking_until_that_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    begun = []

    class Counted(Docking):
        def __init__(self, *args: object) -> None:
            super().__init__(*args)  # type: ignore[arg-type]
            begun.append(self)

    monkeypatch.setattr(at_station, "Docking", Counted)
    station = at_the_station()
    for number in range(5):
        station.dock(replace(BEFORE, now=0.05 * number), STATION, STAGING)
    assert len(begun) == 1
    station.forget()
    station.dock(BEFORE, STATION, STAGING)
    assert len(begun) == 2


def test_it_charges_until_there_is_enough_for_the_rest() -> None:
    job = Job(DirtMap(HOME.map), MissionConfig(), 100.0, DOCKED)
    job.begin_exploration(DOCKED)
    station = at_the_station()
    full = replace(DOCKED, battery=Battery(1.0, 26.0, is_docked=True))
    # What an exploration takes is not known.
    assert station.charge(DOCKED, job, TOOL, STATION) == PhaseStep(STANDSTILL)
    assert station.charge(full, job, TOOL, STATION) == PhaseStep(event=Event.CHARGED)
    job.forget()
    # It was found out at the beginning what is needed.
    assert station.charge(DOCKED, job, TOOL, STATION) == PhaseStep(STANDSTILL)
    station.forget()
    assert station.charge(DOCKED, job, TOOL, STATION) == PhaseStep(event=Event.CHARGED)


def emptying_job() -> Job:
    job = Job(DirtMap(HOME.map), MissionConfig(), 100.0, DOCKED)
    job.begin_exploration(DOCKED)
    return job


@pytest.mark.parametrize("phase", ["charge", "empty"])
def test_in_a_station_without_power_it_waits_for_current(phase: str) -> None:
    job, station = emptying_job(), at_the_station()
    without = Senses(0.0, STATION.compose(Pose(-0.02, 0.0, 0.05)), battery=Battery(0.5, 26.0))

    def step(senses: Senses) -> PhaseStep:
        if phase == "charge":
            return station.charge(senses, job, TOOL, STATION)
        return station.empty(replace(senses, emptying=EmptyingTold(True, 0.0)), job, STATION)

    for now in range(3600):
        waits = step(replace(without, now=float(now)))
        assert (waits.twist, waits.event) == (STANDSTILL, None)
        assert waits.reason is not None
        assert "gives no current: see that it is plugged in" in waits.reason.text
    assert step(replace(DOCKED, now=3600.0)).reason == NO_REASON
    assert step(replace(DOCKED, now=3600.1)).reason is None


@pytest.mark.parametrize(
    "changes",
    [
        {"pose": STATION.compose(Pose(-0.5, 0.0))},
        {"pose": STATION.compose(Pose(0.0, 0.0, 1.0))},
        {"knowledge": Knowledge.SEARCHING},
    ],
)
def test_one_that_was_moved_docks_anew(changes: dict[str, Any]) -> None:
    job, station = emptying_job(), at_the_station()
    moved = replace(DOCKED, battery=Battery(0.5, 26.0), **changes)
    assert station.charge(moved, job, TOOL, STATION).event is Event.CONTACT_LOST
    assert station.empty(moved, job, STATION).event is Event.CONTACT_LOST


def test_one_that_was_shoved_a_little_sees_that_its_station_has_power_and_docks_anew() -> None:
    job, station = emptying_job(), at_the_station()
    shoved = replace(DOCKED, battery=Battery(0.5, 26.0), beams=StationBeams(halo=True))
    ticks = [replace(shoved, now=0.1 * tick) for tick in range(30)]
    events = [station.charge(senses, job, TOOL, STATION).event for senses in ticks]
    lost = events.index(Event.CONTACT_LOST)
    assert ticks[lost].now == pytest.approx(DockingConfig().contact_wait, abs=0.2)


def test_docked_it_stands_first_and_away_from_its_station_it_does_not() -> None:
    station = at_the_station()
    twists = {
        now: station.undock(replace(DOCKED, now=now), STATION, 2.0).twist
        for now in np.arange(0.0, 3.0, 0.1).round(1).tolist()
    }
    assert {twist for now, twist in twists.items() if now < 1.95} == {STANDSTILL}
    assert all(twist.linear < 0.0 for now, twist in twists.items() if now > 2.05)
    assert at_the_station().undock(BEFORE, STATION, 2.0).event is Event.OUT


def test_it_stands_again_before_it_undocks_another_time() -> None:
    station = at_the_station()
    station.undock(DOCKED, STATION)
    station.forget()
    assert station.undock(replace(DOCKED, now=9.0), STATION, 2.0).twist == STANDSTILL


@pytest.mark.parametrize("told", [None, EmptyingTold(is_at_work=False, bag=1.0)])
def test_a_bin_that_its_station_does_not_empty_is_emptied_by_hand(
    told: EmptyingTold | None,
) -> None:
    job = Job(DirtMap(HOME.map), MissionConfig(), 100.0, DOCKED)
    step = at_the_station().empty(replace(DOCKED, emptying=told), job, STATION)
    assert step.event is Event.FAILED
    assert step.reason is not None
    assert step.reason.hindrance is Hindrance.NOT_EMPTIED
