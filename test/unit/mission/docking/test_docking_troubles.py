"""Docking that cannot succeed: what is in the way, the station without power, the robot itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

import pytest
from fixtures.robots.docking_rig import BROUGHT, CONFIG, ENDS, RADIUS, ROBOT, TICK, Rig

from roomba.geometry import Pose, Twist
from roomba.mission.docking.docking import Docking, DockSenses, DockState, DockStep, Trouble
from roomba.world.engine.state.arrays import Fault


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


def test_it_waits_until_the_way_is_free() -> None:
    rig = Rig()
    rig.put_obstacle(-0.3, 0.0)
    rig.run_until(lambda step: step.state is DockState.WAITING)
    rig.world.remove_obstacles()
    step = rig.run(30.0)
    assert (step.state, step.attempts) == (DockState.DOCKED, 2)
    waiting = rig.ticks_in(DockState.WAITING)
    assert len(waiting) * TICK == pytest.approx(CONFIG.blocked_wait, abs=0.11)
    assert {step.twist for step in waiting} == {Twist()}


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


def test_every_trouble_says_what_helps() -> None:
    for trouble in Trouble:
        assert trouble is Trouble.TIMEOUT or any(mark in trouble.value for mark in ":;"), trouble
