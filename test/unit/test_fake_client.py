"""The fake robot: the same calls give the same run, and every way a walk can go is there."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.client import (
    CameraClient,
    RequestRefusedError,
    RobotClient,
    RobotUnavailableError,
    Walk,
    WalkOutcome,
)
from roomba.fake_client import CAMERA_ANGLES, FakeRobot, SteppedClock, Turn, WalkScript

COORDINATE = st.floats(min_value=-100.0, max_value=100.0)


def feedbacks(walk: Walk, timeout: float = 100.0) -> list[float]:
    """Collect what a walk tells until it ends, or until nothing is told for ``timeout`` s."""
    told = []
    while (left := walk.next_feedback(timeout)) is not None:
        told.append(left)
    return told


def test_it_is_a_robot_and_a_camera() -> None:
    robot: RobotClient = FakeRobot()
    camera: CameraClient = FakeRobot()
    assert robot.station() == (0.0, 0.0)
    assert camera.picture(0.0).shape == (768, 1024, 3)


def test_the_seeds_walk() -> None:
    robot = FakeRobot()
    walk = robot.walk_to(3.0, 4.0)
    assert feedbacks(walk) == pytest.approx([5.0, 3.5, 2.0, 0.5])
    report = walk.report()
    assert report is not None
    assert report.outcome is WalkOutcome.ARRIVED
    assert report.distance == pytest.approx(5.0)
    assert report.duration == pytest.approx(10.0)
    state = robot.state()
    assert (state.x, state.y, state.speed) == pytest.approx((3.0, 4.0, 0.0))


@given(COORDINATE, COORDINATE, st.floats(min_value=1.0, max_value=3.0))
def test_every_walk_arrives_and_tells_less_and_less(x: float, y: float, detour: float) -> None:
    robot = FakeRobot(detour=detour)
    length = robot.path_length(x, y)
    walk = robot.walk_to(x, y)
    told = feedbacks(walk)
    report = walk.report()
    assert report is not None
    assert report.outcome is WalkOutcome.ARRIVED
    assert report.distance == pytest.approx(length)
    assert report.duration == pytest.approx(length / 0.5)
    assert told == sorted(told, reverse=True)
    assert math.dist((robot.state().x, robot.state().y), (x, y)) < 1e-6


def test_the_same_script_gives_the_same_run() -> None:
    def run() -> list[object]:
        robot = FakeRobot(scripts=[WalkScript(), WalkScript(Turn.FAILS, 3.1, "stuck")])
        trace: list[object] = []
        for goal in ((2.0, 1.0), (-4.0, 3.0), (0.5, 0.1)):
            walk = robot.walk_to(*goal)
            trace += [feedbacks(walk), walk.report(), robot.state()]
        return trace

    assert run() == run()


@pytest.mark.parametrize(
    ("turn", "outcome", "travelled", "duration"),
    [
        (Turn.REFUSED, WalkOutcome.REFUSED, 0.0, 0.0),
        (Turn.FAILS, WalkOutcome.FAILED, 1.5, 3.0),
        (Turn.VANISHES, WalkOutcome.LOST, 1.5, 4.0),
    ],
)
def test_walks_that_end_badly(
    turn: Turn, outcome: WalkOutcome, travelled: float, duration: float
) -> None:
    robot = FakeRobot(scripts=[WalkScript(turn, after=3.0, message="because")])
    walk = robot.walk_to(3.0, 4.0)
    feedbacks(walk)
    report = walk.report()
    assert report is not None
    assert (report.outcome, report.message) == (outcome, "because")
    assert report.distance == pytest.approx(travelled)
    assert report.duration == pytest.approx(duration)
    assert robot.state().speed == 0.0


def test_a_walk_that_arrives_before_its_script_strikes() -> None:
    walk = FakeRobot(scripts=[WalkScript(Turn.FAILS, after=99.0)]).walk_to(1.0, 0.0)
    feedbacks(walk)
    report = walk.report()
    assert report is not None
    assert report.outcome is WalkOutcome.ARRIVED


def test_a_frozen_robot_tells_nothing_and_reports_nothing() -> None:
    robot = FakeRobot(scripts=[WalkScript(Turn.FREEZES, after=1.0)])
    walk = robot.walk_to(3.0, 4.0)
    assert feedbacks(walk, timeout=50.0) == [5.0]
    walk.cancel()
    assert walk.report() is None
    before = robot.clock.monotonic()
    with pytest.raises(RobotUnavailableError, match="within 2 s"):
        robot.state(timeout=2.0)
    assert robot.clock.monotonic() - before == pytest.approx(2.0)


def test_without_an_action_server_a_walk_cannot_be_asked_for() -> None:
    robot = FakeRobot(scripts=[WalkScript(Turn.ABSENT)])
    with pytest.raises(RobotUnavailableError, match="no action server"):
        robot.walk_to(1.0, 1.0)
    assert robot.walk_to(1.0, 1.0).report() is None


def test_waiting_for_feedback_takes_no_longer_than_allowed() -> None:
    robot = FakeRobot()
    walk = robot.walk_to(3.0, 4.0)
    assert walk.next_feedback(0.25) == 5.0
    assert walk.next_feedback(0.25) is None
    assert robot.clock.monotonic() == pytest.approx(0.25)
    assert robot.state().speed == 0.5


def test_cancel_stops_on_the_spot() -> None:
    robot = FakeRobot()
    walk = robot.walk_to(3.0, 4.0)
    robot.clock.sleep(2.0)
    walk.cancel()
    robot.clock.sleep(2.0)
    report = walk.report()
    assert report is not None
    assert report.outcome is WalkOutcome.CANCELLED
    assert (report.distance, report.duration) == pytest.approx((1.0, 2.0))
    assert (robot.state().x, robot.state().y) == pytest.approx((0.6, 0.8))
    assert walk.next_feedback(1.0) is None


def test_a_disobedient_robot_walks_on() -> None:
    robot = FakeRobot(scripts=[WalkScript(obeys=False)])
    walk = robot.walk_to(3.0, 4.0)
    robot.clock.sleep(2.0)
    walk.cancel()
    assert walk.report() is None
    assert walk.cancels == 1
    assert robot.state().speed == 0.5


def test_a_new_walk_takes_over() -> None:
    robot = FakeRobot()
    first = robot.walk_to(3.0, 4.0)
    robot.clock.sleep(2.0)
    second = robot.walk_to(0.6, 2.8)
    report = first.report()
    assert report is not None
    assert report.outcome is WalkOutcome.CANCELLED
    feedbacks(second)
    assert (robot.state().x, robot.state().y) == pytest.approx((0.6, 2.8))


@pytest.mark.parametrize("x", [math.nan, math.inf, -100.1, 1e9])
def test_points_outside_the_limits_are_refused(x: float) -> None:
    with pytest.raises(RequestRefusedError, match="from -100 to 100"):
        FakeRobot().path_length(x, 0.0)


def test_blocked_points_are_refused_with_their_reason() -> None:
    robot = FakeRobot(blocked={(1.0, 2.0): "inside a wall"})
    with pytest.raises(RequestRefusedError, match="inside a wall"):
        robot.path_length(1.0, 2.0)


def test_a_silent_robot_uses_up_the_timeout() -> None:
    robot = FakeRobot()
    robot.answers = False
    with pytest.raises(RobotUnavailableError):
        robot.state()
    assert robot.clock.monotonic() == pytest.approx(5.0)


def test_events_happen_at_their_moment() -> None:
    seen = []
    clock = SteppedClock(events=[(t, lambda: seen.append(clock.monotonic())) for t in (3.0, 1.0)])
    clock.sleep(2.0)
    assert seen == [1.0]
    clock.sleep(2.0)
    assert seen == [1.0, 3.0]
    assert clock.monotonic() == 4.0


def test_each_camera_angle_has_its_picture_and_the_nearest_is_taken() -> None:
    robot = FakeRobot()
    pictures = [robot.picture(angle) for angle in CAMERA_ANGLES]
    assert all(picture.dtype == np.uint8 for picture in pictures)
    assert len({picture.tobytes() for picture in pictures}) == len(CAMERA_ANGLES)
    assert np.array_equal(robot.picture(13.0), robot.picture(15.0))


@pytest.mark.parametrize("angle", [math.nan, math.inf, -math.inf, 1e30])
def test_impossible_angles_are_refused(angle: float) -> None:
    with pytest.raises(RequestRefusedError, match="expected an angle"):
        FakeRobot().picture(angle)


def test_a_missing_camera_is_unavailable() -> None:
    robot = FakeRobot()
    robot.camera_answers = False
    with pytest.raises(RobotUnavailableError, match="within 5 s"):
        robot.picture(0.0)
