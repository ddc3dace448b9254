"""Docking in the simulator, through the speed loop, with noise and late senses; and every end."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable

import pytest
from fixtures.rooms import room_home
from fixtures.worlds import DT
from hypothesis import example, given, settings
from hypothesis import strategies as st

from roomba.configuration.docking import DockingConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.control.speed_loop import Hazards, SpeedLoop
from roomba.geometry import Pose, Twist
from roomba.mission.docking.docking import (
    Docking,
    DockSenses,
    DockState,
    DockStep,
    Trouble,
    staging_pose,
)
from roomba.world.engine.state.arrays import Fault, Infrared
from roomba.world.simulator import Simulator

ROBOT, CONFIG = SimulatedRobotConfig(), DockingConfig()
PATIENT = ROBOT.body.model_copy(update={"command_timeout": 0.5})
"""A body whose commands may be late: those of a test come with the robot's own senses."""
RADIUS = ROBOT.body.radius
STATION = Pose(RADIUS + 0.035, 2.0, math.pi)
"""The wall is what the robot touches when it goes 3.5 cm too far."""
HOME = room_home(4.0, 4.0, station=STATION)
BROUGHT = Pose(-0.65, 0.03, 0.1)
RIGHT = Pose()
TICK = 2 * DT
ENDS = (DockState.DOCKED, DockState.FAILED)


class Rig:
    """A robot that docks; poses are given and told in the frame of the docked robot."""

    def __init__(
        self,
        start: Pose = BROUGHT,
        *,
        wrong: Pose = RIGHT,
        delay: int = 2,
        seed: int = 0,
        config: DockingConfig = CONFIG,
        station: Pose = RIGHT,
        faults: Iterable[Fault] = (),
    ) -> None:
        """Stand at ``start`` and believe to be ``wrong`` by so much; senses come ticks late."""
        self.world = Simulator(HOME, ROBOT, seed=seed, start=STATION.compose(start))
        self.wrong, self.is_known, self.clock = wrong, True, 0.0
        self._loop = SpeedLoop(PATIENT, 0.5)
        self.inject(*faults)
        self.world.advance(Twist(), DT, 2)
        self._senses = deque([self._sense()] * (delay + 1), maxlen=delay + 1)
        self.docking = Docking(
            config, ROBOT.body, ROBOT.station, STATION.compose(station), self._senses[0]
        )
        self.steps: list[DockStep] = []
        self.poses: list[Pose] = []
        self.hits: list[float] = []
        """m/s; how fast it was at each first contact."""
        self.pushes = 0
        """Ticks in which ahead was wanted while the bumper was pressed."""

    def _sense(self) -> DockSenses:
        seen = self.world.observe()
        believed = Pose(
            seen.pose.x + self.wrong.x,
            seen.pose.y + self.wrong.y,
            seen.pose.theta + self.wrong.theta,
        )
        return DockSenses(
            seen.time + self.clock,
            believed,
            Infrared.HALO in seen.infrared,
            Infrared.GREEN in seen.infrared,
            Infrared.RED in seen.infrared,
            seen.bumper.left,
            seen.bumper.right,
            seen.cliff.any,
            seen.battery.is_docked,
            self.is_known,
        )

    def tick(self) -> DockStep:
        self._senses.append(self._sense())
        step = self.docking.tick(self._senses[0])
        seen = self.world.observe()
        self.pushes += seen.bumper.pressed and step.twist.linear > 0.0
        hazards = Hazards(seen.bumper.pressed, seen.cliff.any, seen.wheels.dropped)
        self._loop.set_hazards(hazards)
        self._loop.command(seen.time, step.twist)
        wanted, was_pressed = self._loop.tick(seen.time)[0], seen.bumper.pressed
        for _ in range(2):
            speed = seen.twist.linear
            seen = self.world.step(wanted, DT)
            if seen.bumper.pressed and not was_pressed:
                self.hits.append(speed)
            was_pressed = seen.bumper.pressed
        self.steps.append(step)
        self.poses.append(self.pose)
        return step

    @property
    def pose(self) -> Pose:
        return STATION.inverse().compose(self.world.pose)

    @property
    def seconds(self) -> float:
        return TICK * len(self.steps)

    def run(self, seconds: float = 160.0) -> DockStep:
        """Tick until it ends."""
        for _ in range(round(seconds / TICK)):
            step = self.tick()
            if step.state in ENDS:
                return step
        raise AssertionError(f"no end after {seconds} s: {step}")

    def run_until(self, is_so: Callable[[DockStep], bool], seconds: float = 60.0) -> DockStep:
        for _ in range(round(seconds / TICK)):
            step = self.tick()
            if is_so(step):
                return step
        raise AssertionError(f"never so in {seconds} s: {step}")

    def stay(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.tick()

    def put_obstacle(self, x: float, y: float, radius: float = 0.05) -> None:
        place = STATION.compose(Pose(x, y, 0.0))
        self.world.place_obstacle(place.x, place.y, radius)

    def inject(self, *faults: Fault) -> None:
        for fault in faults:
            self.world.inject(fault, 1.0)

    @property
    def states(self) -> list[DockState]:
        """The states that it went through, in order."""
        found: list[DockState] = []
        for step in self.steps:
            if not found or found[-1] is not step.state:
                found.append(step.state)
        return found

    def ticks_in(self, state: DockState) -> list[DockStep]:
        return [step for step in self.steps if step.state is state]


@given(
    st.floats(-0.05, 0.05),
    st.floats(-0.05, 0.05),
    st.floats(-0.35, 0.35),
    st.floats(0.0, 0.05),
    st.floats(-math.pi, math.pi),
    st.floats(-0.0524, 0.0524),
    st.integers(0, 3),
    st.integers(0, 1000),
)
@example(0.05, -0.05, -0.14, 0.05, -1.12, 0.0523, 0, 336)
@example(-0.05, 0.05, 0.35, 0.05, 1.57, -0.0523, 3, 1)
@settings(max_examples=25)
def test_it_docks_from_where_it_is_brought(
    x: float, y: float, theta: float, off: float, way: float, turn: float, delay: int, seed: int
) -> None:
    wrong = Pose(off * math.cos(way), off * math.sin(way), turn)
    rig = Rig(Pose(x - 0.65, y, theta), wrong=wrong, delay=delay, seed=seed)
    step = rig.run(15.0)
    assert step == DockStep(DockState.DOCKED, Twist(), "", 1, None)
    assert rig.seconds < 9.0
    assert rig.hits == []
    rig.stay(0.5)
    assert rig.world.observe().battery.is_docked
    assert (
        rig.states
        == [
            DockState.SEARCHING,
            DockState.APPROACHING,
            DockState.TOUCHING,
            DockState.DOCKED,
        ][-len(rig.states) :]
    )


@given(
    st.floats(0.1, 1.5), st.floats(-1.25, 1.25), st.floats(-math.pi, math.pi), st.integers(0, 1000)
)
@example(0.1, 0.0, 0.0, 0)
@example(0.3, 1.2, 1.0, 0)
@settings(max_examples=20)
def test_it_docks_from_anywhere_near(away: float, way: float, theta: float, seed: int) -> None:
    start = Pose(-away * math.cos(way), away * math.sin(way), theta)
    step = Rig(start, seed=seed).run(60.0)
    assert step.state is DockState.DOCKED
    assert step.attempts <= 3


def test_beside_the_way_or_too_near_it_first_goes_to_where_it_can_get_straight() -> None:
    starts = [
        Pose(-0.085, -0.13, 1.85),
        Pose(-0.3, 0.153, 1.24),
        Pose(-0.027, -0.205, -1.07),
        Pose(-0.05, 0.1, 3.0),
        Pose(-0.35, -0.15, -2.0),
        Pose(-0.15, 0.0, 1.6),
    ]
    for seed, start in enumerate(starts):
        step = Rig(start, wrong=Pose(0.02, -0.03, 0.04), seed=seed).run(30.0)
        assert (step.state, step.attempts) == (DockState.DOCKED, 1)


def test_docked_already_it_is_done_at_once() -> None:
    rig = Rig(Pose())
    assert rig.tick() == DockStep(DockState.DOCKED, Twist(), "", 0, None)
    rig.inject(Fault.STATION_DEAD)
    rig.stay(1.0)
    # What has ended stays so.
    assert set(rig.steps) == {DockStep(DockState.DOCKED, Twist(), "", 0, None)}


def test_in_the_station_without_current_it_goes_back_straight_and_tries_again() -> None:
    rig = Rig(Pose(-0.02, 0.0, 0.0), delay=0)
    rig.run_until(lambda step: step.twist.linear != 0.0)
    assert rig.steps[-1].state is DockState.BACKING_OFF
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    assert rig.pose.x < -0.35
    assert rig.run(20.0).state is DockState.DOCKED
    assert max(abs(pose.theta) for pose in rig.poses) < 0.5


def test_it_goes_slowly_at_the_end() -> None:
    rig = Rig(delay=0)
    rig.run()
    for pose, step in zip(rig.poses, rig.steps, strict=True):
        if pose.x > -0.07:
            assert step.twist.linear <= CONFIG.creep_speed + 1e-9
    assert max(step.twist.linear for step in rig.steps) > 2.0 * CONFIG.creep_speed


def test_the_current_must_last_before_it_is_docked() -> None:
    rig = Rig(delay=0)
    rig.run_until(lambda step: step.state is DockState.TOUCHING)
    rig.run()
    touching = rig.ticks_in(DockState.TOUCHING)
    assert len(touching) * TICK == pytest.approx(CONFIG.settle_time, abs=0.11)
    assert {step.twist for step in touching} == {Twist()}


def test_pressed_in_too_far_it_creeps_back_until_current_comes() -> None:
    rig = Rig(delay=0)
    rig.run_until(lambda step: step.state is DockState.TOUCHING)
    rig.world.put(STATION.compose(Pose(0.0349, 0.0, 0.0)))
    step = rig.run()
    assert (step.state, step.attempts) == (DockState.DOCKED, 1)
    backing = rig.ticks_in(DockState.BACKING_OFF)
    assert {round(step.twist.linear, 6) for step in backing} <= {0.0, -CONFIG.creep_speed}
    assert rig.states[-4:] == [
        DockState.TOUCHING,
        DockState.BACKING_OFF,
        DockState.TOUCHING,
        DockState.DOCKED,
    ]
    waited = len(rig.ticks_in(DockState.TOUCHING)) * TICK
    assert waited == pytest.approx(CONFIG.contact_wait + CONFIG.settle_time, abs=0.2)


def test_it_stops_in_time_though_it_creeps_at_twice_the_speed_and_senses_come_late() -> None:
    hasty = CONFIG.model_copy(update={"creep_speed": 2.0 * CONFIG.creep_speed})
    for seed in range(5):
        step = Rig(seed=seed, delay=3, config=hasty).run(30.0)
        assert (step.state, step.attempts) == (DockState.DOCKED, 1)


def test_a_station_without_power_is_named() -> None:
    rig = Rig(faults=[Fault.STATION_DEAD])
    step = rig.run(60.0)
    assert (step.state, step.trouble) == (DockState.FAILED, Trouble.NO_POWER)
    assert "no power" in step.reason
    assert "receiver" in step.reason
    # It looked around before, felt for the station once, and stands off it.
    turned = sum(abs(step.twist.angular) * TICK for step in rig.steps if step.twist.linear == 0.0)
    assert turned > 2.0 * math.pi
    assert len(rig.hits) == 1
    assert rig.hits[0] < 0.06
    assert rig.pose.x < -0.3


def test_power_that_fails_on_the_way_is_noticed() -> None:
    rig = Rig()
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    rig.stay(2.0)
    rig.inject(Fault.STATION_DEAD)
    rig.run_until(lambda step: step.state is DockState.SEARCHING, CONFIG.beam_wait + 0.3)
    assert rig.steps[-1].trouble is Trouble.BEAMS_LOST
    assert rig.run(60.0).trouble is Trouble.NO_POWER


def test_with_its_receiver_covered_it_docks_by_its_place_and_says_so() -> None:
    rig = Rig(faults=[Fault.INFRARED_BLOCKED])
    step = rig.run(60.0)
    assert step.state is DockState.DOCKED
    assert "receiver" in step.reason
    rig = Rig(wrong=Pose(0.0, 0.05, 0.04), faults=[Fault.INFRARED_BLOCKED])
    step = rig.run(60.0)
    assert step.trouble is Trouble.NO_POWER
    assert step.attempts == 1


def test_beams_that_come_late_are_followed() -> None:
    rig = Rig(wrong=Pose(0.0, 0.05, 0.04), faults=[Fault.INFRARED_BLOCKED])
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    rig.run_until(lambda step: step.twist.linear > 0.15)
    rig.world.inject(Fault.INFRARED_BLOCKED, 0.0)
    step = rig.run(30.0)
    assert (step.state, step.reason) == (DockState.DOCKED, "")


@pytest.mark.parametrize("delay", [0, 3])
@pytest.mark.parametrize("place", [(-0.3, 0.0), (-0.3, 0.13), (-0.35, -0.1)])
def test_what_stands_in_the_way_is_named_and_not_pushed(
    place: tuple[float, float], delay: int
) -> None:
    rig = Rig(delay=delay)
    rig.put_obstacle(*place)
    step = rig.run(60.0)
    assert (step.state, step.trouble) == (DockState.FAILED, Trouble.BLOCKED)
    assert "blocked" in step.reason
    assert "4 attempts" in step.reason
    assert step.attempts == CONFIG.max_attempts == 4
    # When the speed loop backs off before docking knows, its last wish is still on the way.
    assert rig.pushes <= (delay + 1) * len(rig.hits)
    assert max(rig.hits) <= CONFIG.speed + 0.01
    assert rig.pose.x < -0.6
    # The last time it waits for nothing.
    assert rig.states[-2:] == [DockState.BACKING_OFF, DockState.FAILED]


def test_it_waits_for_who_is_in_the_way_to_leave() -> None:
    rig = Rig()
    rig.put_obstacle(-0.3, 0.0)
    rig.run_until(lambda step: step.state is DockState.WAITING)
    rig.world.remove_obstacles()
    step = rig.run(30.0)
    assert (step.state, step.attempts) == (DockState.DOCKED, 2)
    waiting = rig.ticks_in(DockState.WAITING)
    assert len(waiting) * TICK == pytest.approx(CONFIG.blocked_wait, abs=0.11)
    assert {step.twist for step in waiting} == {Twist()}


def test_each_time_it_backs_off_to_another_side() -> None:
    rig = Rig()
    rig.put_obstacle(-0.3, 0.0)
    rig.run(60.0)
    turned = [step for step in rig.ticks_in(DockState.BACKING_OFF) if step.twist.linear < 0.0]
    sides = {step.attempts: math.copysign(1.0, step.twist.angular) for step in turned}
    assert sides[1] == sides[3] != sides[2] == sides[4]
    for attempt in (1, 2, 3, 4):
        ticks = [
            i for i, step in enumerate(rig.steps) if step in turned and step.attempts == attempt
        ]
        way = rig.poses[ticks[-1]].distance_to(rig.poses[ticks[0]].x, rig.poses[ticks[0]].y)
        assert 0.3 < way < 0.5


def test_contact_without_current_is_named() -> None:
    """Something thin stands right before the station, so that it looks like it."""
    rig = Rig()
    rig.put_obstacle(RADIUS - 0.01, 0.0, 0.02)
    step = rig.run(90.0)
    assert (step.state, step.trouble) == (DockState.FAILED, Trouble.NO_CURRENT)
    assert "contacts" in step.reason
    assert step.attempts == CONFIG.max_attempts
    touching = len(rig.ticks_in(DockState.TOUCHING)) * TICK / CONFIG.max_attempts
    assert touching == pytest.approx(CONFIG.contact_wait, abs=0.15)


def test_where_no_station_is_it_says_so() -> None:
    rig = Rig(Pose(-0.65, -1.2, 0.0), station=Pose(-0.3, -1.2, 0.0))
    step = rig.run(90.0)
    assert (step.state, step.trouble) == (DockState.FAILED, Trouble.NOT_THERE)
    assert "does not stand where the map says" in step.reason


def test_something_in_the_way_and_no_beams_is_both_said() -> None:
    rig = Rig(faults=[Fault.INFRARED_BLOCKED])
    rig.put_obstacle(-0.1, 0.12)
    step = rig.run(90.0)
    assert (step.state, step.trouble) == (DockState.FAILED, Trouble.HIDDEN)


def test_what_it_meets_while_it_looks_for_beams_is_left_alone() -> None:
    rig = Rig(faults=[Fault.STATION_DEAD])
    for x, y in ((-0.33, 0.0), (-0.5, 0.33)):
        rig.put_obstacle(x, y)
    searching = rig.run_until(lambda step: step.state is DockState.APPROACHING)
    assert searching.attempts == 1
    assert 1 <= len(rig.hits) <= 3
    assert rig.pushes <= 3 * len(rig.hits)
    # It backs off from each, and goes on to the other side.
    backed = [i for i, step in enumerate(rig.steps) if step.state is DockState.BACKING_OFF]
    assert min(pose.y for pose in rig.poses[backed[0] :]) < -0.2
    ends = [i for i in backed if rig.steps[i + 1].state is not DockState.BACKING_OFF]
    begins = [i for i in backed if rig.steps[i - 1].state is not DockState.BACKING_OFF]
    for begin, end in zip(begins, ends, strict=True):
        here = rig.poses[end]
        assert 0.1 < rig.poses[begin].distance_to(here.x, here.y) < 0.25
    assert rig.seconds < 35.0


def test_beams_that_ended_do_not_mislead_it_when_it_feels_for_its_station() -> None:
    rig = Rig(Pose(-0.65, -0.1, 0.0))
    rig.run_until(lambda step: step.state is DockState.APPROACHING)
    rig.stay(0.3)
    # The red beam ends as it does at its outer edge, which is elsewhere.
    rig.inject(Fault.STATION_DEAD)
    rig.run_until(lambda step: step.state is DockState.TOUCHING)
    assert rig.pose.y == pytest.approx(0.0, abs=0.02)


def test_it_finds_a_station_that_stands_somewhat_elsewhere() -> None:
    for off in (
        Pose(0.0, -0.3, 0.0),
        Pose(0.0, 0.3, 0.0),
        Pose(-0.2, 0.0, 0.0),
        Pose(0.2, 0.0, 0.1),
    ):
        rig = Rig(Pose(off.x - 0.65, off.y, off.theta), station=off)
        assert rig.run(60.0).state is DockState.DOCKED


@pytest.mark.parametrize(
    ("faults", "trouble"),
    [
        ((Fault.BUMPER_STUCK,), Trouble.BUMPER_STUCK),
        ((Fault.CLIFF_DIRTY,), Trouble.CLIFF),
        ((Fault.LIFTED,), Trouble.CLIFF),
        ((Fault.STALL_LEFT, Fault.STALL_RIGHT), Trouble.STUCK),
        ((Fault.BUMPER_STUCK, Fault.STATION_DEAD), Trouble.BUMPER_STUCK),
        ((Fault.STALL_LEFT, Fault.STALL_RIGHT, Fault.STATION_DEAD), Trouble.STUCK),
    ],
)
@pytest.mark.parametrize("later", [0.0, 1.5])
def test_what_is_wrong_with_the_robot_is_named(
    faults: Iterable[Fault], trouble: Trouble, later: float
) -> None:
    rig = Rig(faults=() if later else faults)
    rig.stay(later)
    rig.inject(*faults)
    step = rig.run(60.0)
    assert (step.state, step.trouble) == (DockState.FAILED, trouble)
    assert step.reason.startswith(trouble.value)


@pytest.mark.parametrize("after", [0.3, 1.0, 3.0])
def test_when_its_place_is_lost_it_goes_on_by_the_beams(after: float) -> None:
    for seed in range(5):
        rig = Rig(Pose(-0.68, 0.04, -0.3), wrong=Pose(0.03, 0.04, 0.05), seed=seed)
        rig.stay(after)
        rig.is_known = False
        step = rig.run(40.0)
        assert step.state is DockState.DOCKED


def test_when_its_place_is_lost_between_attempts_beams_are_enough() -> None:
    rig = Rig()
    rig.put_obstacle(-0.1, 0.0)
    rig.run_until(lambda step: step.state is DockState.BACKING_OFF)
    rig.run_until(lambda step: rig.pose.x < -0.6)
    rig.is_known = False
    rig.world.remove_obstacles()
    assert rig.run(20.0).state is DockState.DOCKED


def test_without_place_and_beams_it_waits_a_little_and_gives_up() -> None:
    rig = Rig(Pose(-1.5, 0.5, 0.0))
    rig.is_known = False
    step = rig.run(20.0)
    assert step.trouble is Trouble.LOST
    assert rig.seconds == pytest.approx(CONFIG.lost_timeout, abs=0.3)
    # A place that is no place at all is none either.
    rig = Rig(Pose(-1.5, 0.5, 0.0), wrong=Pose(math.nan, 0.0, 0.0))
    assert rig.run(20.0).trouble is Trouble.LOST
    # Beams do not say which way the robot looks.
    rig = Rig(wrong=Pose(math.nan, 0.0, 0.0))
    assert rig.run(20.0).trouble is Trouble.LOST
    assert {step.twist for step in rig.steps} == {Twist()}


def test_its_place_found_again_it_goes_on() -> None:
    rig = Rig(Pose(-1.2, 0.6, 2.0), delay=0)
    rig.is_known = False
    rig.stay(5.0)
    assert rig.pose.distance_to(-1.2, 0.6) < 0.01
    rig.is_known = True
    assert rig.run(40.0).state is DockState.DOCKED


def test_taken_away_it_comes_back_or_says_that_it_is_too_far() -> None:
    rig = Rig()
    rig.stay(2.0)
    rig.world.put(STATION.compose(Pose(-1.4, 0.5, 2.0)))
    assert rig.run(60.0).state is DockState.DOCKED
    rig = Rig()
    rig.stay(2.0)
    rig.world.put(STATION.compose(Pose(-3.2, 0.5, 2.0)))
    step = rig.run(5.0)
    assert step.trouble is Trouble.FAR
    assert "3.2 m" in step.reason


def test_taken_away_unnoticed_it_ends() -> None:
    rig = Rig()
    rig.stay(2.0)
    rig.is_known = False
    rig.world.put(STATION.compose(Pose(-1.4, 0.5, 2.0)))
    assert rig.run(60.0).state is DockState.FAILED


def test_it_takes_no_longer_than_its_time_limit() -> None:
    short = CONFIG.model_copy(update={"time_limit": 4.0})
    rig = Rig(config=short)
    rig.put_obstacle(-0.3, 0.0)
    step = rig.run(10.0)
    assert step.trouble is Trouble.TIMEOUT
    assert rig.seconds == pytest.approx(4.0, abs=0.25)
    assert "blocked" in step.reason


@pytest.mark.parametrize("jump", [-1e4, 1e4, -0.04])
def test_a_clock_that_is_set_changes_nothing(jump: float) -> None:
    rig = Rig()
    for after in (1.0, 2.0, 1.5):
        rig.stay(after)
        rig.clock += jump
    step = rig.run(10.0)
    assert (step.state, step.attempts) == (DockState.DOCKED, 1)
    # And a failure is as late as ever.
    rig = Rig(Pose(-1.5, 0.5, 0.0))
    rig.is_known = False
    rig.stay(5.0)
    rig.clock += jump
    assert rig.run(20.0).trouble is Trouble.LOST
    assert rig.seconds == pytest.approx(CONFIG.lost_timeout, abs=2.3)


class Phantom:
    """A robot that moves exactly as is wanted, and beams as a test wants them."""

    def __init__(self, start: Pose = BROUGHT) -> None:
        self.now, self.pose = 0.0, start
        self.docking = Docking(CONFIG, ROBOT.body, ROBOT.station, Pose(), self.sense())

    def sense(self, halo: bool = False, green: bool = False, red: bool = False) -> DockSenses:
        return DockSenses(self.now, self.pose, halo, green, red)

    def run(self, beams: Callable[[Pose], tuple[bool, bool, bool]]) -> DockStep:
        for _ in range(4000):
            step = self.docking.tick(self.sense(*beams(self.pose)))
            if step.state in ENDS:
                return step
            self.now += TICK
            turn = step.twist.angular * TICK
            self.pose = self.pose.compose(Pose(step.twist.linear * TICK, 0.0, turn))
        raise AssertionError("no end")


def test_where_nothing_is_touched_though_there_are_beams_it_says_so() -> None:
    phantom = Phantom()
    step = phantom.run(lambda pose: (pose.x > -0.4, True, True))
    assert step.trouble is Trouble.NO_CONTACT
    assert step.attempts == CONFIG.max_attempts
    assert phantom.pose.x < 0.0


def test_beams_that_vanish_each_time_are_named() -> None:
    step = Phantom().run(lambda pose: (False, pose.x < -0.45, pose.x < -0.45))
    assert step.trouble is Trouble.BEAMS_LOST
    assert step.attempts == CONFIG.max_attempts


senses = st.builds(
    DockSenses,
    st.floats(0.0, 0.4),
    st.builds(Pose, st.floats(-1.5, 0.2), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0)),
    *[st.booleans()] * 6,
    st.just(False),
    st.booleans(),
)


@given(st.lists(st.tuples(senses, st.integers(1, 40)), min_size=1, max_size=25))
@settings(max_examples=40)
def test_whatever_is_sensed_it_keeps_to_its_speeds_and_ends(
    runs: list[tuple[DockSenses, int]],
) -> None:
    short = CONFIG.model_copy(update={"time_limit": 20.0})
    docking = Docking(short, ROBOT.body, ROBOT.station, Pose(), runs[0][0])
    now, states = 0.0, []
    for sensed, ticks in [*runs, (runs[-1][0], 500)]:
        for _ in range(ticks):
            now += TICK
            step = docking.tick(
                DockSenses(
                    now,
                    sensed.pose,
                    sensed.halo,
                    sensed.green,
                    sensed.red,
                    sensed.bumper_left,
                    sensed.bumper_right,
                    sensed.cliff,
                    sensed.is_charging,
                    sensed.is_known,
                )
            )
            assert step.twist.is_finite
            assert abs(step.twist.linear) <= CONFIG.speed + 1e-9
            assert abs(step.twist.angular) <= CONFIG.turning_speed + 1e-9
            assert step.attempts <= CONFIG.max_attempts
            assert (step.reason != "") == (step.state is DockState.FAILED)
            if step.state is DockState.APPROACHING and (sensed.bumper_left or sensed.bumper_right):
                assert step.twist == Twist()
            states.append(step.state)
    assert states[-1] is DockState.FAILED
    failed = states.index(DockState.FAILED)
    assert set(states[failed:]) == {DockState.FAILED}


def test_the_place_where_it_is_brought_looks_at_the_station() -> None:
    place = staging_pose(Pose(2.0, 1.0, math.pi / 2.0), CONFIG)
    assert (place.x, place.y) == pytest.approx((2.0, 0.35))
    assert place.theta == pytest.approx(math.pi / 2.0)


def test_a_station_nowhere_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        Docking(
            CONFIG, ROBOT.body, ROBOT.station, Pose(math.inf, 0.0, 0.0), DockSenses(0.0, Pose())
        )


def test_every_trouble_says_what_helps() -> None:
    for trouble in Trouble:
        assert trouble is Trouble.TIMEOUT or any(mark in trouble.value for mark in ":;"), trouble
