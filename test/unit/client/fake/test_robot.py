"""The fake robot: the same calls give the same run, and every way a walk can go is there."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.clean_request import CleanRequest
from roomba.client.fake.errands import (
    CLEANING_RATE,
    HOMING_TIME,
    LOST_NOTICE,
    ErrandScript,
)
from roomba.client.fake.robot import CAMERA_ANGLES, FakeRobot, SteppedClock, Turn, WalkScript
from roomba.client.fake.vacuum import ROOM_AREA, UNDOCKING_TIME
from roomba.client.protocol import (
    CameraClient,
    CleanHandle,
    CleanReport,
    ErrandOutcome,
    RequestRefusedError,
    RobotClient,
    RobotUnavailableError,
    WalkHandle,
    WalkOutcome,
)
from roomba.mission.cleaning.result import CleanOutcome
from roomba.vocabulary import (
    CarpetWay,
    CleanMode,
    EdgeOrder,
    EdgeReason,
    FanLevel,
    OpenEdge,
    RoomWay,
)

COORDINATE = st.floats(min_value=-100.0, max_value=100.0)


def feedbacks(walk: WalkHandle, timeout: float = 100.0) -> list[float]:
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
        (Turn.VANISHES, WalkOutcome.DISCONNECTED, 1.5, 4.0),
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


def ended(clean: CleanHandle) -> CleanReport:
    while clean.next_feedback(100.0) is not None:
        pass
    report = clean.report()
    assert report is not None
    return report


def test_the_outcomes_of_errands_are_those_of_the_mission() -> None:
    outcomes = {outcome.name for outcome in ErrandOutcome}
    assert outcomes - {"REFUSED", "DISCONNECTED", "INTERRUPTED"} == {
        each.name for each in CleanOutcome
    }


def test_a_clean_tells_every_second_and_ends_on_the_station() -> None:
    robot: RobotClient = FakeRobot(room_names=("kitchen", "hall"))
    clean = robot.clean()
    told = []
    while (progress := clean.next_feedback(100.0)) is not None:
        told.append(progress)
    cleaning = 2 * ROOM_AREA / CLEANING_RATE
    assert len(told) == cleaning + HOMING_TIME
    assert [told[index].covered for index in (0, 1, -1)] == pytest.approx([0.0, 0.5, 8.0])
    assert [told[index].state for index in (0, -1)] == ["cleaning", "returning"]
    assert {progress.room for progress in told} == {"kitchen", "hall"}
    report = clean.report()
    assert report is not None
    assert report.outcome is ErrandOutcome.COMPLETED
    assert report.duration == pytest.approx(cleaning + HOMING_TIME)
    assert robot.vacuum().state == "docked"


def test_the_words_of_a_clean_become_one_request() -> None:
    robot = FakeRobot(room_names=("kitchen", "hall"))
    ways, zone = (RoomWay(2, FanLevel.QUIET), RoomWay()), (0.0, 0.0, 1.0, 2.0)
    robot.clean(
        CleanMode.ROOMS,
        rooms=["hall", "kitchen"],
        in_order=True,
        zones=[zone],
        spot=(1.0, 2.0),
        passes=3,
        fan=FanLevel.STRONG,
        each=list(ways),
        carpets=CarpetWay.AVOID,
        edges=EdgeOrder.LAST,
    )
    robot.clean()
    assert robot.asked == [
        CleanRequest(
            CleanMode.ROOMS,
            rooms=("hall", "kitchen"),
            zones=(zone,),
            spot=(1.0, 2.0),
            passes=3,
            fan=FanLevel.STRONG,
            in_order=True,
            each=ways,
            carpets=CarpetWay.AVOID,
            edges=EdgeOrder.LAST,
        ),
        CleanRequest(),
    ]
    for passes in (0, 6):
        with pytest.raises(RequestRefusedError, match=f"1 to 5 passes, got {passes}"):
            robot.clean(passes=passes)
    assert len(robot.asked) == 2


def test_a_pause_takes_no_part_in_the_work() -> None:
    robot = FakeRobot()
    clean = robot.clean(CleanMode.SPOT)
    robot.clock.sleep(2.0)
    robot.pause()
    robot.clock.sleep(100.0)
    assert robot.vacuum().state == "paused"
    assert robot.vacuum().covered == pytest.approx(1.0)
    with pytest.raises(RequestRefusedError, match="cannot pause now: the robot is paused"):
        robot.pause()
    robot.resume()
    assert robot.vacuum().state == "cleaning"
    assert ended(clean).covered == pytest.approx(2.25)
    with pytest.raises(RequestRefusedError, match="cannot resume now: the robot is docked"):
        robot.resume()


def test_stop_ends_a_clean_on_the_spot() -> None:
    robot = FakeRobot()
    clean = robot.clean()
    robot.clock.sleep(3.0)
    robot.stop()
    report = clean.report()
    assert report is not None
    assert report.outcome is ErrandOutcome.STOPPED
    assert report.covered == pytest.approx(1.5)
    assert robot.vacuum().state == "idle"
    robot.stop()


def test_a_newer_errand_takes_over_and_a_refused_one_does_not() -> None:
    robot = FakeRobot()
    first = robot.clean()
    robot.clock.sleep(1.0)
    refused = ended(robot.clean(CleanMode.ROOMS, rooms=("attic",)))
    assert refused.outcome is ErrandOutcome.REFUSED
    assert "attic" in refused.message
    assert first.report() is None
    docking = robot.dock()
    assert ended(first).message == "a newer goal took over"
    assert docking.next_feedback(1.0) == "returning"
    robot.clock.sleep(HOMING_TIME)
    report = docking.report()
    assert report is not None
    assert report.outcome is ErrandOutcome.COMPLETED
    assert robot.vacuum().state == "docked"
    assert robot.undock().next_feedback(1.0) == "undocking"
    robot.clock.sleep(UNDOCKING_TIME)
    assert robot.vacuum().state == "idle"


def test_a_clean_that_is_lost_goes_on_without_its_client() -> None:
    robot = FakeRobot(errands=[ErrandScript(ErrandOutcome.DISCONNECTED, after=3.0)])
    clean = robot.clean()
    report = ended(clean)
    assert report.outcome is ErrandOutcome.DISCONNECTED
    assert robot.clock.monotonic() == pytest.approx(3.0 + LOST_NOTICE)
    assert math.isnan(report.distance)
    robot.clock.sleep(1.0)
    state = robot.vacuum()
    assert state.state == "cleaning"
    assert state.covered == pytest.approx(3.25)


def test_errands_that_end_badly() -> None:
    script = ErrandScript(ErrandOutcome.STUCK, after=4.0, message="a wheel hangs")
    report = ended(FakeRobot(errands=[script]).clean())
    assert (report.outcome, report.message) == (ErrandOutcome.STUCK, "a wheel hangs")
    assert (report.covered, report.duration) == pytest.approx((2.0, 4.0))
    frozen = FakeRobot(errands=[ErrandScript(after=2.0, freezes=True)]).clean()
    assert [frozen.next_feedback(50.0) is None for _ in range(3)] == [False, False, True]
    assert frozen.report() is None


def test_where_a_map_stays_open_is_told_at_the_end() -> None:
    edges = (OpenEdge(2.0, 1.0, 3.0, EdgeReason.NO_ECHO),)
    script = ErrandScript(open_edges=edges)
    exploring = FakeRobot(errands=[script]).explore()
    while exploring.next_feedback(100.0) is not None:
        pass
    report = exploring.report()
    assert report is not None
    assert report.open_edges == edges
    assert ended(FakeRobot(errands=[script]).clean()).open_edges == edges


def test_a_silent_vacuum_uses_up_the_timeout() -> None:
    robot = FakeRobot()
    robot.answers = False
    for ask in (robot.vacuum, robot.rooms, robot.pause, robot.clean, robot.dock):
        with pytest.raises(RobotUnavailableError):
            ask()
    assert robot.clock.monotonic() == pytest.approx(25.0)


def test_the_rooms_of_a_clean_are_changed_while_it_is_under_way() -> None:
    robot = FakeRobot()
    robot.clean(CleanMode.ROOMS, rooms=("kitchen", "hall"))
    assert robot.vacuum().queue == ("kitchen", "hall")
    robot.clock.sleep(1.5 * ROOM_AREA / CLEANING_RATE)
    assert robot.vacuum().queue == ("hall",)
    robot.change_rooms(("study", "hall"))
    assert (robot.vacuum().queue, robot.vacuum().room) == (("study", "hall"), "study")
    assert robot.vacuum().wanted == pytest.approx(3.0 * ROOM_AREA)
    for wrong in ((), ("attic",)):
        with pytest.raises(RequestRefusedError, match="expected rooms among"):
            robot.change_rooms(wrong)
    robot.clean()
    assert robot.vacuum().queue == ()
    with pytest.raises(RequestRefusedError, match="under way, got none"):
        robot.change_rooms(("hall",))
