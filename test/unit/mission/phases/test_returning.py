"""The phase of returning, tick by tick: what ends it, and waiting where no way leads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.obstacles import Standing
from fixtures.robots.missions import TWO_ROOMS, WALL_X

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import STANDSTILL, Pose, RoundObstacle
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.phases.machine import Event
from roomba.mission.phases.returning import go_home
from roomba.mission.phases.step import PhaseStep
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import NO_REASON, Hindrance

ROBOT, CONFIG = RobotConfig(), MissionConfig()
CONTEXT = PlanningContext(TWO_ROOMS.map, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig())
IN_THE_DEN = Senses(0.0, Pose(3.0, 1.2, 0.0))
FENCE: list[RoundObstacle] = [(WALL_X + 0.05, float(y), 0.05) for y in np.arange(0.85, 1.6, 0.1)]
SPEED = 0.3
MINUTE = 60.0


class Rig:
    def __init__(self, context: PlanningContext = CONTEXT) -> None:
        self.obstacles = Standing(FENCE)
        self.drives = Drives(context, ROBOT, CONFIG.driving, self.obstacles)
        self.retries = RetryPolicy(CONFIG.driving.waiting)

    def go_home(self, senses: Senses = IN_THE_DEN) -> PhaseStep:
        return go_home(self.drives, self.retries, senses, SPEED)

    @property
    def makes_room(self) -> bool:
        """Whether it is on its way farther into the den, away from the door."""
        driver = self.drives.driver
        return driver is not None and driver.tracker.rest[-1, 0] > IN_THE_DEN.pose.x


def test_at_home_or_before_it_there_is_nothing_to_drive() -> None:
    docked = replace(IN_THE_DEN, battery=Battery(1.0, 26.0, is_docked=True))
    assert Rig().go_home(docked) == PhaseStep(event=Event.CONTACT)
    assert Rig().go_home(replace(IN_THE_DEN, pose=CONTEXT.staging)) == PhaseStep(
        event=Event.ARRIVED
    )


def test_with_a_way_home_it_drives() -> None:
    rig = Rig()
    rig.obstacles.things = []
    step = rig.go_home()
    assert step.twist != STANDSTILL
    # What was told before is over.
    assert step.reason == NO_REASON
    assert rig.go_home(replace(IN_THE_DEN, now=0.05)).reason is None


def test_shut_in_it_waits_twenty_minutes_for_a_way_and_then_says_that_there_is_none() -> None:
    rig, now = Rig(), 0.0
    told, step = set(), PhaseStep()
    while step.failure is None and now < 60.0 * MINUTE:
        step = rig.go_home(replace(IN_THE_DEN, now=now))
        told.add(step.reason)
        now += 0.5
    assert step.failure is not None
    assert step.failure.outcome is CleanOutcome.NOT_DOCKED
    assert "no way home" in step.failure.reason
    # Two short waits, and then long ones; each says when it is over at the latest.
    for seconds in (10, 30):
        ends = f"; it waits for a way to open, and looks again within {seconds} s"
        (reason,) = (reason for reason in told if reason and reason.looks_within == seconds)
        assert reason.hindrance is Hindrance.NO_WAY
        assert reason.text.endswith(ends)
    assert now == pytest.approx(20.0 * MINUTE, abs=0.5 * MINUTE)


def test_beyond_a_wall_of_its_map_it_says_at_once_that_no_way_leads_home() -> None:
    step = Zone("step", ZoneKind.WALL, ((WALL_X + 0.05, 0.7), (WALL_X + 0.05, 1.7)))
    walled = PlanningContext(
        TWO_ROOMS.map, TWO_ROOMS.station, ROBOT, CONFIG, DockingConfig(), zones=Zones((step,))
    )
    rig = Rig(walled)
    rig.obstacles.things = []
    steps = [rig.go_home(replace(IN_THE_DEN, now=0.05 * tick)) for tick in range(20)]
    failures = [step.failure for step in steps if step.failure is not None]
    assert failures[0].outcome is CleanOutcome.NOT_DOCKED
    assert "no way home" in failures[0].reason
    assert "carry it there, or take the zone away" in failures[0].reason


def test_a_door_that_is_opened_meanwhile_is_driven_through() -> None:
    rig, now, waited = Rig(), 0.0, PhaseStep()
    while not waited.reason:
        waited = rig.go_home(replace(IN_THE_DEN, now=now))
        now += 0.05
    rig.obstacles.things = []
    # It has time, and makes room for a person who may stand there.
    assert rig.makes_room
    aside = rig.go_home(replace(IN_THE_DEN, now=now + 5.0))
    assert (aside.twist == STANDSTILL, aside.reason) == (False, None)
    step = rig.go_home(replace(IN_THE_DEN, now=now + 11.0))
    assert step.twist != STANDSTILL
    assert step.reason == NO_REASON
    assert not rig.makes_room


def test_it_waits_no_longer_than_there_is_no_way() -> None:
    rig, now = Rig(), 0.0
    while not rig.go_home(replace(IN_THE_DEN, now=now)).reason:
        now += 0.05
    rig.drives.driver = None
    assert rig.go_home(replace(IN_THE_DEN, now=now + 2.5)) == PhaseStep()
    rig.obstacles.things = []
    assert rig.go_home(replace(IN_THE_DEN, now=now + 3.0)) == PhaseStep()
    assert rig.go_home(replace(IN_THE_DEN, now=now + 5.0)).twist != STANDSTILL
