"""Noticing what comes up: contact, a lifted robot, an empty battery, a place that is not known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.robots.missions import HOME

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.phases.energy import EnergyLedger
from roomba.mission.phases.machine import Errand, MissionState
from roomba.mission.phases.monitor import Monitor
from roomba.mission.phases.step import Failure
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import Phase

ROBOT, CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(HOME.map, HOME.station, ROBOT, CONFIG, DockingConfig())
HERE = Pose(1.0, 0.6, 0.0)
AWAY = Senses(0.0, HERE)
SEARCHING = replace(AWAY, knowledge=Knowledge.SEARCHING, trouble="too little in sight")
CLEANING = MissionState(Phase.CLEANING, Errand.CLEAN)
EMPTY = Battery(0.001, 26.0)


class Rig:
    def __init__(self, senses: Senses = AWAY) -> None:
        things = ThingLayer(SurfaceField.of(HOME.map))
        obstacles = Obstacles(things, ROBOT.walk, ROBOT.body, CONFIG.driving)
        self.drives = Drives(CONTEXT, ROBOT, CONFIG.driving, obstacles)
        ledger = EnergyLedger(CONFIG.energy, senses)
        self.monitor = Monitor(ROBOT.walk, self.drives, ledger, senses)

    def failure(self, senses: Senses, state: MissionState = CLEANING) -> Failure | None:
        return self.monitor.failure(state, senses, (HERE.x, HERE.y))

    def bump(self) -> None:
        """Find something, with the bumper."""
        self.drives.obstacles.feel(replace(AWAY, bumper_left=True))

    @property
    def remembers(self) -> bool:
        return bool(self.drives.obstacles.standing(0.0))


def test_contact_that_comes_or_goes_is_noticed_once() -> None:
    docked = replace(AWAY, battery=Battery(1.0, 26.0, is_docked=True))
    monitor = Rig().monitor
    seen = [monitor.note_contact(each) for each in (AWAY, docked, docked, AWAY, AWAY)]
    assert seen == [False, True, False, True, False]
    assert not Rig(docked).monitor.note_contact(docked)


@pytest.mark.parametrize(
    ("senses", "outcome"),
    [
        (replace(AWAY, lifted=True), CleanOutcome.FAULT),
        (replace(AWAY, battery=EMPTY), CleanOutcome.BATTERY),
        (replace(AWAY, knowledge=Knowledge.LOST), CleanOutcome.LOST),
    ],
)
def test_what_ends_a_drive_is_no_matter_while_it_stands(
    senses: Senses, outcome: CleanOutcome
) -> None:
    failure = Rig().failure(senses)
    assert failure is not None
    assert failure.outcome is outcome
    assert Rig().failure(senses, MissionState(Phase.PAUSED, Errand.CLEAN)) is None
    assert Rig().failure(AWAY) is None


def test_a_wheel_that_hangs_for_a_moment_is_a_sill_and_for_longer_a_fault() -> None:
    rig, longest = Rig(), ROBOT.walk.hanging_wheel
    for begin in (0.0, longest):
        # On the floor in between, it is given its time again.
        for now in np.arange(begin, begin + longest - 0.1, 0.1).tolist():
            assert rig.failure(replace(AWAY, now=now, wheel_hangs=True)) is None
        assert rig.failure(replace(AWAY, now=begin + longest - 0.05)) is None
    for now in np.arange(10.0, 10.0 + longest + 0.15, 0.1).tolist():
        failure = rig.failure(replace(AWAY, now=now, wheel_hangs=True))
    assert failure is not None
    assert failure.outcome is CleanOutcome.FAULT
    # Resumed with the wheel in the air it is given its time again.
    paused = MissionState(Phase.PAUSED, Errand.CLEAN)
    assert rig.failure(replace(AWAY, now=20.0, wheel_hangs=True), paused) is None
    assert rig.failure(replace(AWAY, now=20.1, wheel_hangs=True)) is None


@pytest.mark.parametrize(("before", "is_remembered"), [(0.5, False), (2.0, True)])
def test_picked_up_nose_first_it_was_at_no_edge(before: float, is_remembered: bool) -> None:
    rig = Rig()
    rig.drives.obstacles.feel(replace(AWAY, cliff_left=True))
    assert rig.failure(replace(AWAY, now=before, lifted=True)) is not None
    assert bool(rig.drives.obstacles.edges()) is is_remembered


def test_astray_it_is_given_time_and_then_the_reason_is_told() -> None:
    rig, timeout = Rig(), ROBOT.walk.astray_timeout
    for now in np.arange(0.0, timeout, 0.1).tolist():
        assert rig.failure(replace(SEARCHING, now=now)) is None
        assert rig.monitor.is_astray
    failure = rig.failure(replace(SEARCHING, now=timeout + 0.2))
    assert failure is not None
    assert failure.outcome is CleanOutcome.LOST
    assert "too little in sight" in failure.reason


@pytest.mark.parametrize("jump", [-1000.0, 1000.0])
def test_astray_it_is_given_its_time_though_the_clock_is_set(jump: float) -> None:
    rig = Rig()
    rig.failure(SEARCHING)
    assert rig.failure(replace(SEARCHING, now=jump)) is None
    assert rig.monitor.is_astray


@pytest.mark.parametrize("is_told_so", [False, True])
def test_one_that_stood_lost_looks_around_first(is_told_so: bool) -> None:
    lost = replace(AWAY, knowledge=Knowledge.LOST, trouble="several places fit")
    rig = Rig(lost) if is_told_so else Rig()
    rig.failure(lost, MissionState(Phase.PAUSED, Errand.CLEAN))
    assert rig.failure(lost) is None
    assert rig.monitor.is_astray
    # The search began anew.
    assert rig.failure(replace(SEARCHING, now=1.0)) is None
    failure = rig.failure(replace(lost, now=2.0))
    assert failure is not None
    assert failure.outcome is CleanOutcome.LOST


def test_one_that_stood_lost_and_is_not_looked_for_says_so_soon() -> None:
    lost, rig = replace(AWAY, knowledge=Knowledge.LOST), Rig()
    rig.failure(lost, MissionState(Phase.PAUSED, Errand.CLEAN))
    failures = [rig.failure(replace(lost, now=0.1 * tick)) for tick in range(40)]
    first = next(index for index, failure in enumerate(failures) if failure is not None)
    assert 0.1 * first == pytest.approx(ROBOT.walk.search_wait, abs=0.25)


def test_standing_or_docking_it_does_not_matter_where_it_is() -> None:
    rig = Rig()
    rig.failure(SEARCHING)
    rig.failure(SEARCHING, MissionState(Phase.PAUSED, Errand.CLEAN))
    assert not rig.monitor.is_astray
    assert rig.failure(SEARCHING, MissionState(Phase.DOCKING, Errand.HOME)) is None
    assert not rig.monitor.is_astray


@pytest.mark.parametrize(("x", "remembers"), [(1.2, True), (2.2, False)])
def test_found_again_far_away_it_was_carried_and_forgets_what_is_here(
    x: float, remembers: bool
) -> None:
    rig = Rig()
    rig.bump()
    rig.failure(SEARCHING)
    assert rig.remembers
    assert rig.failure(replace(AWAY, now=1.0, pose=Pose(x, 0.6, 0.0))) is None
    assert not rig.monitor.is_astray
    assert rig.remembers is remembers
