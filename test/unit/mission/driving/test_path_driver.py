"""Driving a path with a body that does what it is told, and things that it feels."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from fixtures.robots.missions import HOME
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.path_driver import DriveState, DriveStep, PathDriver
from roomba.mission.driving.rejoin import Rejoin
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer

CONFIG = RobotConfig()
DRIVING = MissionConfig().driving
BODY = CONFIG.body.radius
CONTEXT = PlanningContext(HOME.map, HOME.station, CONFIG, MissionConfig(), DockingConfig())
LIMIT = 0.3
STRAIGHT = np.array([(0.6, 0.5), (2.6, 0.5)])
HERE = Pose(0.6, 0.5, 0.0)

Disc = tuple[float, float, float]
Floats = NDArray[np.float64]


class Rig:
    """A robot on the floor of HOME, among discs that stop it and that only its bumper tells of."""

    def __init__(
        self,
        points: NDArray[np.float64] = STRAIGHT,
        pose: Pose = HERE,
        discs: list[Disc] | None = None,
        plans_anew: Callable[[float, Floats], bool] = lambda now, rest: False,
        robot: RobotConfig = CONFIG,
    ) -> None:
        self.pose, self.discs = pose, discs or []
        self.time, self.clock = 0.0, 0.0
        self.is_held = False
        self.poses = [pose]
        self.states: list[DriveState] = []
        self.layer = ThingLayer(SurfaceField.of(HOME.map))
        self.obstacles = Obstacles(self.layer, CONFIG.walk, CONFIG.body, DRIVING)
        self.driver = PathDriver(
            points,
            Rejoin(CONTEXT, BODY, DRIVING),
            self.obstacles,
            Trail(),
            DRIVING,
            robot,
            self.senses(),
            plans_anew,
        )

    def senses(self) -> Senses:
        left = right = False
        for x, y, radius in self.discs:
            if self.pose.distance_to(x, y) < BODY + radius + 0.004:
                bearing = self.pose.bearing_to(x, y)
                left |= -0.2 < bearing < 1.4
                right |= -1.4 < bearing < 0.2
        return Senses(self.time + self.clock, self.pose, bumper_left=left, bumper_right=right)

    def tick(self) -> DriveStep:
        step = self.driver.tick(self.senses(), LIMIT)
        self.states.append(step.state)
        self.time += CONFIG.timing.tick
        if not self.is_held:
            self._move(step.twist)
        self.poses.append(self.pose)
        return step

    def _move(self, twist: Twist) -> None:
        theta = self.pose.theta + twist.angular * CONFIG.timing.tick
        half = 0.5 * (self.pose.theta + theta)
        way = twist.linear * CONFIG.timing.tick
        # As far as the discs leave it: up to them.
        for part in np.linspace(way, 0.0, 16).tolist():
            x, y = self.pose.x + part * math.cos(half), self.pose.y + part * math.sin(half)
            if all(math.hypot(x - a, y - b) >= BODY + radius for a, b, radius in self.discs):
                break
        self.pose = Pose(x, y, theta)

    def run(
        self, seconds: float = 120.0, meanwhile: Callable[[int], None] = lambda tick: None
    ) -> DriveStep:
        for tick in range(round(seconds / CONFIG.timing.tick)):
            meanwhile(tick)
            step = self.tick()
            if step.state.is_over:
                assert step.twist == Twist()
                return step
        raise AssertionError(f"no end within {seconds} s: {step}, {self.pose}")


def test_it_drives_a_path_to_its_end() -> None:
    rig = Rig()
    before = rig.driver.left
    assert before == pytest.approx(2.0)
    assert rig.run().state is DriveState.DONE
    assert rig.pose.distance_to(2.6, 0.5) < 0.01
    assert rig.time == pytest.approx(2.0 / LIMIT, abs=2.0)
    assert rig.driver.left == 0.0
    assert set(rig.states[:-1]) == {DriveState.DRIVING}
    # Over is over.
    assert rig.tick().state is DriveState.DONE
    assert not rig.driver.is_tracking


def test_from_anywhere_it_goes_to_the_path_first() -> None:
    rig = Rig(pose=Pose(0.6, 1.9, 2.0))
    assert rig.run().state is DriveState.DONE
    assert min(pose.distance_to(0.6, 0.5) for pose in rig.poses) < 0.06
    assert rig.pose.distance_to(2.6, 0.5) < 0.01


def test_it_goes_around_what_it_felt_and_back_onto_its_path() -> None:
    rig = Rig(discs=[(1.5, 0.5, 0.05)])
    assert rig.run().state is DriveState.DONE
    assert DriveState.BACKING in rig.states
    assert rig.pose.distance_to(2.6, 0.5) < 0.01
    behind = [pose for pose in rig.poses if 2.2 < pose.x < 2.5]
    assert max(abs(pose.y - 0.5) for pose in behind) < 0.02
    before = rig.poses[: rig.states.index(DriveState.BACKING)]
    assert max(abs(pose.y - 0.5) for pose in before) < 0.02
    assert rig.obstacles.standing(rig.time)


def test_it_backs_off_a_little_from_what_it_touched() -> None:
    rig = Rig(discs=[(1.5, 0.5, 0.05)])
    while rig.tick().state is not DriveState.BACKING:
        pass
    touched = rig.pose
    while rig.tick().state is DriveState.BACKING:
        pass
    assert rig.pose.distance_to(touched.x, touched.y) == pytest.approx(
        DRIVING.backing_way, abs=0.02
    )


def test_a_path_that_ends_in_something_comes_to_an_end_with_a_reason() -> None:
    rig = Rig(discs=[(2.55, 0.5, 0.05)])
    step = rig.run()
    assert step.state in (DriveState.CUT_OFF, DriveState.STUCK)
    assert step.reason


def edge(y: float) -> Senses:
    return Senses(0.0, Pose(1.4, y, 0.0), cliff_left=True, cliff_right=True)


def test_behind_an_edge_the_rest_of_the_path_is_cut_off() -> None:
    rig = Rig(discs=[(1.5, 0.5, 0.05)])
    for y in np.arange(0.0, 2.5, 0.15):
        rig.obstacles.feel(edge(float(y)))
    step = rig.run()
    assert step.state is DriveState.CUT_OFF
    assert "no way leads on" in step.reason
    assert "no way leads there" in step.reason


def test_among_things_all_around_it_gives_up_with_a_reason() -> None:
    ring = [
        (1.5 + 0.42 * math.cos(a), 0.5 + 0.42 * math.sin(a), 0.08) for a in np.arange(0.0, 6.2, 0.3)
    ]
    rig = Rig(np.array([(1.5, 0.5), (2.6, 0.5)]), Pose(1.5, 0.5, 0.0), ring)
    step = rig.run(600.0)
    assert step.state in (DriveState.CUT_OFF, DriveState.STUCK)
    assert step.reason


def test_held_it_tries_to_get_free_and_then_says_that_it_is_stuck() -> None:
    rig = Rig()
    rig.is_held = True
    step = rig.run()
    assert step.state is DriveState.STUCK
    assert "stuck near (0.60, 0.50)" in step.reason
    assert DriveState.RECOVERING in rig.states
    assert rig.time > DRIVING.progress_timeout
    # So many tries, each some seconds, and a pause before each.
    assert rig.time < DRIVING.most_recoveries * (DRIVING.progress_timeout + 8.0)


@pytest.mark.parametrize("limit", ["body", "tracking"])
def test_one_that_turns_slowly_is_not_stuck_while_it_turns(limit: str) -> None:
    """Its half turn on the spot takes some 16 s, more than three times what is no progress."""
    slow = {"max_angular_speed" if limit == "body" else "turning_speed": 0.2}
    rig = Rig(pose=Pose(0.6, 0.5, math.pi), robot=RobotConfig.model_validate({limit: slow}))
    assert rig.run().state is DriveState.DONE
    assert DriveState.RECOVERING not in rig.states


def test_one_that_turns_slower_than_it_is_told_is_not_stuck_while_it_turns() -> None:
    """As behind a slow line, whose commands reach it now and then."""
    rig = Rig(pose=Pose(0.6, 0.5, math.pi))

    def meanwhile(tick: int) -> None:
        rig.is_held = tick % 10 != 0

    assert rig.run(meanwhile=meanwhile).state is DriveState.DONE
    assert DriveState.RECOVERING not in rig.states


def test_held_for_a_while_it_goes_on() -> None:
    rig = Rig()

    def meanwhile(tick: int) -> None:
        rig.is_held = 60 < tick < 240

    assert rig.run(meanwhile=meanwhile).state is DriveState.DONE
    assert DriveState.RECOVERING in rig.states
    assert rig.pose.distance_to(2.6, 0.5) < 0.01


@pytest.mark.parametrize("jump", [-1e5, -3.0, 3.0, 1e5])
def test_a_clock_that_is_set_changes_nothing(jump: float) -> None:
    plain, jumped = Rig(discs=[(1.5, 0.5, 0.05)]), Rig(discs=[(1.5, 0.5, 0.05)])
    is_backing = False

    def meanwhile(tick: int) -> None:
        nonlocal is_backing
        if tick == 30 or (not is_backing and DriveState.BACKING in jumped.states):
            is_backing = is_backing or DriveState.BACKING in jumped.states
            jumped.clock += jump

    plain.run()
    assert jumped.run(meanwhile=meanwhile).state is DriveState.DONE
    # Set forward, it forgets what it felt, and may meet it again.
    assert jumped.time == pytest.approx(plain.time, abs=15.0 if jump > 1e4 else 1.0)
    if jump < 1e4:
        assert DriveState.RECOVERING not in jumped.states
        backing = [rig.states.count(DriveState.BACKING) for rig in (plain, jumped)]
        assert backing[1] == backing[0]


def test_pushed_aside_it_looks_for_a_new_way() -> None:
    rig = Rig()

    def meanwhile(tick: int) -> None:
        if tick == 60:
            rig.pose = Pose(rig.pose.x, 1.0, 1.0)

    assert rig.run(meanwhile=meanwhile).state is DriveState.DONE
    assert rig.pose.distance_to(2.6, 0.5) < 0.01


def test_an_edge_is_kept_away_from_as_from_a_thing() -> None:
    rig = Rig()
    plain = rig.senses

    def senses() -> Senses:
        now = plain()
        nose = rig.pose.compose(Pose(BODY, 0.0, 0.0))
        if math.hypot(nose.x - 1.5, nose.y - 0.5) < 0.06:
            return Senses(now.now, now.pose, cliff_left=True, cliff_right=True)
        return now

    rig.senses = senses  # type: ignore[method-assign]
    assert rig.run().state is DriveState.DONE
    assert DriveState.BACKING in rig.states
    assert rig.obstacles.standing(1e9)


def test_whether_it_only_tracks_its_path_is_told() -> None:
    rig = Rig(discs=[(1.5, 0.5, 0.05)])
    for _ in range(10):
        rig.tick()
    assert rig.driver.is_tracking
    while rig.tick().state is DriveState.DRIVING:
        pass
    assert not rig.driver.is_tracking


def see(rig: Rig, x: float, y: float) -> None:
    """Let the lidar see a thin thing."""
    layer = rig.layer
    place = layer.arrays
    frame = HOME.map.frame
    row, column = frame.cell_of(x, y)
    cell = row * frame.columns + column
    place.evidence[cell] = layer.config.most
    place.spots[cell] = x, y
    place.listed[int(place.layer["count"][0])] = cell
    place.layer["count"] += 1
    place.layer["version"] += 1


def asked(answers: list[Floats], answer: bool) -> Callable[[float, Floats], bool]:
    """Return what writes down what was left of the path when it is asked."""

    def plans_anew(now: float, rest: Floats) -> bool:
        answers.append(rest)
        return answer

    return plans_anew


def test_past_a_thing_at_the_side_it_goes_on_a_little_aside() -> None:
    answers: list[Floats] = []
    rig = Rig(plans_anew=asked(answers, True))
    see(rig, 1.5, 0.65)
    assert rig.run().state is DriveState.DONE
    beside = min(pose.distance_to(1.5, 0.65) for pose in rig.poses)
    assert beside == pytest.approx(BODY + 0.02, abs=0.012)
    # It never leaves the path by more than that, so that what is beside the thing gets clean.
    assert max(abs(pose.y - 0.5) for pose in rig.poses) < 0.06
    assert rig.pose.distance_to(2.6, 0.5) < 0.01
    assert answers == []


@pytest.mark.parametrize("answer", [True, False])
def test_what_stands_in_the_middle_of_its_path_has_it_planned_anew_or_gone_around(
    answer: bool,
) -> None:
    answers: list[Floats] = []
    rig = Rig(plans_anew=asked(answers, answer))
    see(rig, 1.5, 0.5)
    step = rig.run()
    (first, *_) = answers
    # From where it was on its path to the end of that.
    assert 1.0 < first[0, 0] < 1.5 - BODY
    assert first[0, 1] == pytest.approx(0.5, abs=0.02)
    assert first[-1] == pytest.approx(STRAIGHT[-1])
    assert np.hypot(*np.diff(first, axis=0).T).sum() == pytest.approx(2.6 - first[0, 0], abs=0.02)
    if answer:
        assert step.state is DriveState.OVERTAKEN
        assert rig.pose.x < 1.5 - BODY
    else:
        assert step.state is DriveState.DONE


def test_what_only_the_bumper_finds_time_and_again_ends_the_path() -> None:
    # What is felt is forgotten at once: the robot drives against it as if for the first time.
    rig = Rig(discs=[(1.5, 0.5, 0.05)])
    rig.obstacles.feel = lambda senses: None  # type: ignore[method-assign]
    step = rig.run()
    assert step.state is DriveState.CUT_OFF
    assert "only the bumper feels" in step.reason
    assert rig.states.count(DriveState.BACKING) > 10
    assert rig.pose.x < 1.5 - BODY


def test_jammed_it_tries_each_recovery_once_and_the_first_one_first() -> None:
    rig = Rig()
    rig.is_held = True
    tried: list[int] = []

    def meanwhile(tick: int) -> None:
        if tick == 5:
            rig.discs.append((HERE.x + BODY + 0.05, HERE.y, 0.05))
        number = int(rig.driver.progress["recoveries"][0])
        if number and (not tried or tried[-1] != number):
            tried.append(number)

    assert rig.run(meanwhile=meanwhile).state is DriveState.STUCK
    assert tried[: DRIVING.most_recoveries] == list(range(1, DRIVING.most_recoveries + 1))
