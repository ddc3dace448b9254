"""Undocking in the simulator, through the speed loop, with late senses; and every end."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.docking import DockingConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.control.speed_loop import Hazards, SpeedLoop
from roomba.geometry import Pose, Twist
from roomba.mission.docking.step import DockSenses
from roomba.mission.docking.undocking import Undocking, UndockState, UndockStep
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator

ROBOT, CONFIG = SimulatedRobotConfig(), DockingConfig()
PATIENT = ROBOT.body.model_copy(update={"command_timeout": 0.5})
"""A body whose commands may be late: those of a test come with the robot's own senses."""
STATION = Pose(ROBOT.body.radius + 0.035, 2.0, math.pi)
HOME = room_home(4.0, 4.0, station=STATION)
TICK = 2 * DT
DOCKED = Pose()
STALLED = (Fault.STALL_LEFT, Fault.STALL_RIGHT)


class Rig:
    """A robot that undocks; poses are in the frame of the docked robot."""

    def __init__(
        self,
        start: Pose = DOCKED,
        *,
        delay: int = 2,
        is_known: bool = True,
        faults: Iterable[Fault] = (),
    ) -> None:
        self.world = Simulator(HOME, ROBOT, start=STATION.compose(start))
        for fault in faults:
            self.world.inject(fault, 1.0)
        self.world.advance(Twist(), DT, 1)
        self.is_known, self.clock, self.ticks = is_known, 0.0, 0
        self._loop = SpeedLoop(PATIENT, 0.5)
        self.late_senses = deque([self.sense()] * (delay + 1), maxlen=delay + 1)
        self.undocking = Undocking(CONFIG, STATION, self.late_senses[0])

    def sense(self) -> DockSenses:
        seen = self.world.observe()
        return DockSenses(
            seen.time + self.clock,
            seen.pose,
            bumper_left=seen.bumper.left,
            bumper_right=seen.bumper.right,
            cliff=seen.cliff.any,
            is_charging=seen.battery.is_docked,
            is_known=self.is_known,
        )

    def tick(self) -> UndockStep:
        self.ticks += 1
        self.late_senses.append(self.sense())
        step = self.undocking.tick(self.late_senses[0])
        seen = self.world.observe()
        hazards = Hazards(seen.bumper.pressed, seen.cliff.any, seen.wheels.dropped)
        self._loop.set_hazards(hazards)
        self._loop.command(seen.time, step.twist)
        self.world.advance(self._loop.tick(seen.time)[0], DT, 2)
        return step

    def run(self, meanwhile: Callable[[int], None] = lambda tick: None) -> UndockStep:
        for tick in range(round(20.0 / TICK)):
            meanwhile(tick)
            step = self.tick()
            if step.state is not UndockState.BACKING_OUT:
                assert step.twist == Twist()
                return step
        raise AssertionError(f"no end: {step}")

    @property
    def pose(self) -> Pose:
        return STATION.inverse().compose(self.world.pose)

    @property
    def seconds(self) -> float:
        return TICK * self.ticks


@given(st.integers(0, 3), st.booleans(), st.floats(-0.01, 0.0349), st.floats(-0.1, 0.1))
@settings(max_examples=examples(30))
def test_it_backs_straight_out(delay: int, is_known: bool, x: float, theta: float) -> None:
    rig = Rig(Pose(x, 0.0, theta), delay=delay, is_known=is_known)
    starts = rig.pose
    step = rig.run()
    # Without a place and without current it takes itself to be out.
    if is_known or abs(x) < 0.014:
        way = starts.inverse().compose(rig.pose)
        assert step == UndockStep(UndockState.OUT, Twist(), "")
        assert -0.45 < way.x < -0.33
        assert abs(way.y) < 0.02
        assert rig.seconds < 4.0
        assert not rig.world.observe().battery.is_docked
    again = rig.tick()
    assert again.state is UndockState.OUT


def test_out_already_it_is_done_at_once() -> None:
    for start in (Pose(-0.3, 0.0, 0.0), Pose(-1.0, 0.4, 2.0)):
        rig = Rig(start, delay=0)
        assert rig.tick() == UndockStep(UndockState.OUT, Twist(), "")
    assert Rig(Pose(-0.3, 0.0, 0.0), is_known=False).tick().state is UndockState.OUT


def test_in_a_station_without_power_it_backs_out_too() -> None:
    rig = Rig(faults=[Fault.STATION_DEAD])
    assert rig.run().state is UndockState.OUT
    assert rig.pose.x < -0.33


def test_a_robot_that_cannot_move_says_so() -> None:
    rig = Rig(faults=STALLED)
    step = rig.run()
    assert step.state is UndockState.FAILED
    assert "does not move" in step.reason
    assert rig.seconds == pytest.approx(CONFIG.stuck_timeout, abs=0.3)


def test_what_stands_behind_it_holds_it() -> None:
    rig = Rig()
    behind = STATION.compose(Pose(-0.35, 0.0, 0.0))
    rig.world.place_obstacle(behind.x, behind.y, 0.05)
    step = rig.run()
    assert "behind" in step.reason
    assert rig.pose.x == pytest.approx(-0.35 + 0.05 + ROBOT.body.radius, abs=0.01)


def test_a_wall_behind_a_robot_that_is_out_already_holds_nothing() -> None:
    rig = Rig()
    behind = STATION.compose(Pose(-0.3 - 0.05 - ROBOT.body.radius, 0.0, 0.0))
    rig.world.place_obstacle(behind.x, behind.y, 0.05)
    assert rig.run().state is UndockState.OUT
    assert rig.pose.x == pytest.approx(-0.3, abs=0.01)


def test_current_that_stays_tells_that_it_did_not_get_out() -> None:
    rig = Rig(is_known=False, faults=STALLED)
    step = rig.run()
    assert step.state is UndockState.FAILED
    assert "does not get out" in step.reason


@pytest.mark.parametrize(
    ("fault", "word"), [(Fault.BUMPER_STUCK, "touches"), (Fault.CLIFF_DIRTY, "floor")]
)
def test_something_that_touches_or_no_floor_stops_it(fault: Fault, word: str) -> None:
    rig = Rig()

    def meanwhile(tick: int) -> None:
        if tick == 20:
            rig.world.inject(fault, 1.0)

    step = rig.run(meanwhile)
    assert step.state is UndockState.FAILED
    assert word in step.reason
    assert rig.seconds == pytest.approx(1.0, abs=0.25)


def test_leaning_on_its_station_is_no_reason_to_stay() -> None:
    rig = Rig(Pose(0.03, 0.0, 0.0))
    rig.world.advance(Twist(0.1, 0.0), DT, 20)
    assert rig.world.observe().bumper.pressed
    rig.undocking = Undocking(CONFIG, STATION, rig.sense())
    for _ in range(3):
        rig.late_senses.append(rig.sense())
    assert rig.run().state is UndockState.OUT


def test_its_place_lost_it_goes_on() -> None:
    rig = Rig()

    def meanwhile(tick: int) -> None:
        rig.is_known = not 10 <= tick < 20

    assert rig.run(meanwhile).state is UndockState.OUT
    assert -0.42 < rig.pose.x < -0.33


@pytest.mark.parametrize("jump", [-1e4, 1e4])
def test_a_clock_that_is_set_changes_little(jump: float) -> None:
    rig = Rig()

    def meanwhile(tick: int) -> None:
        rig.clock = jump if tick >= 20 else 0.0

    assert rig.run(meanwhile).state is UndockState.OUT
    rig = Rig(faults=STALLED)
    assert "does not move" in rig.run(meanwhile).reason
    assert rig.seconds == pytest.approx(CONFIG.stuck_timeout, abs=2.2)


@pytest.mark.parametrize(
    ("turn", "state"),
    [(0.3, UndockState.BACKING_OUT), (-0.8, UndockState.OUT), (2.5, UndockState.OUT)],
)
def test_a_robot_near_its_station_that_looks_away_is_out(turn: float, state: UndockState) -> None:
    away = STATION.compose(Pose(-0.16, 0.08, turn))
    undocking = Undocking(CONFIG, STATION, DockSenses(0.0, away))
    step = undocking.tick(DockSenses(0.05, away))
    assert step.state is state
    assert (step.twist == Twist()) is (state is UndockState.OUT)


def test_it_takes_no_longer_than_its_time_limit() -> None:
    """It comes nearer and nearer to being out, but so slowly that it is of no use."""
    docked = DockSenses(0.0, DOCKED, is_charging=True)
    undocking, now = Undocking(CONFIG, DOCKED, docked), 0.0
    for _ in range(1000):
        now += TICK
        step = undocking.tick(DockSenses(now, Pose(-0.02 * now, 0.0, 0.0)))
        if step.state is not UndockState.BACKING_OUT:
            break
    assert step.state is UndockState.FAILED
    assert "too long" in step.reason
    assert now == pytest.approx(CONFIG.undock_time_limit, abs=0.1)


def test_a_station_nowhere_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        Undocking(CONFIG, Pose(math.nan, 0.0, 0.0), DockSenses(0.0, Pose()))
