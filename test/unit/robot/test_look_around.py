"""Looking around: what it drives into, how fast, and how much it sees."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT
from fixtures.robots.located import CONFIG, FURNISHED, TWO_ROOMS, Located, steps
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.look_around import LookAround, SearchDrive
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

RADIUS = CONFIG.body.radius
SPEED, TURNING = CONFIG.looking_around.speed, CONFIG.looking_around.turning_speed
NOTHING = np.zeros((0, 4))
FAR_AWAY = np.array([[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0], [0.0, -5.0]])
"""The ends of some beams, farther off than it ever goes at once."""


def wall_ahead(distance: float, width: float = 1.0) -> NDArray[np.float64]:
    """The ends of beams on a wall across the way, its middle so far ahead, robot's frame."""
    aside = np.linspace(-width, width, 80)
    return np.column_stack((np.full(80, distance), aside))


@given(
    st.integers(0, 2**32 - 1),
    st.integers(0, 360),
    st.lists(st.tuples(st.booleans(), st.floats(-3.0, 3.0)), min_size=1, max_size=25),
)
@settings(max_examples=examples(60))
def test_it_never_wants_to_go_faster_than_it_says(
    seed: int, beams: int, ticks: list[tuple[bool, float]]
) -> None:
    random = np.random.default_rng(seed)
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    for step, (touches, jump) in enumerate(ticks):
        ends = random.uniform(-3.0, 3.0, (beams, 2))
        pose = Pose(*random.uniform(-3.0, 3.0, 3).tolist())
        wanted = look_around.tick(0.3 * step + jump, pose, ends, touches)
        assert -SPEED <= wanted.linear <= SPEED
        assert abs(wanted.angular) <= TURNING
        if wanted.linear < 0.0:
            assert wanted.angular == 0.0


def test_it_goes_to_where_there_is_room() -> None:
    """Walls near on three sides: it turns to the fourth, and then goes."""
    near = RADIUS + 0.12
    sides = np.linspace(-0.6, 0.6, 60)
    ends = np.vstack(
        [
            np.column_stack((np.full(60, near), sides)),
            np.column_stack((sides, np.full(60, near))),
            np.column_stack((np.full(60, -near), sides)),
        ]
    )
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    wanted = look_around.tick(0.0, Pose(), ends, False)
    assert wanted == Twist(0.0, -TURNING)
    turned = ends[:, ::-1] * (-1.0, 1.0)
    wanted = look_around.tick(1.0, Pose(0.0, 0.0, -0.5 * math.pi), turned, False)
    assert wanted.linear == pytest.approx(SPEED)
    assert wanted.angular == pytest.approx(0.0, abs=0.02)


def going_ahead() -> LookAround:
    """Let it choose where only the way ahead is free."""
    aside = RADIUS + 0.12
    along = np.linspace(-0.5, 2.0, 120)
    sides = np.linspace(-0.5, 0.5, 60)
    ends = np.vstack(
        [
            np.column_stack((along, np.full(120, aside))),
            np.column_stack((along, np.full(120, -aside))),
            np.column_stack((np.full(60, -aside), sides)),
        ]
    )
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    assert look_around.tick(0.0, Pose(), ends, False).linear == SPEED
    return look_around


def test_it_stops_for_what_comes_into_its_way() -> None:
    look_around = going_ahead()
    slower = look_around.tick(0.1, Pose(), wall_ahead(RADIUS + 0.06 + 0.15), False)
    assert 0.0 < slower.linear < SPEED
    assert look_around.tick(0.2, Pose(), wall_ahead(RADIUS + 0.08), False) == Twist()
    # And then it goes somewhere else.
    wanted = look_around.tick(0.3, Pose(), wall_ahead(RADIUS + 0.08), False)
    assert wanted.linear == 0.0
    assert abs(wanted.angular) == TURNING


def test_it_does_not_go_back_to_where_it_was() -> None:
    """At the end of its way there is more room behind it than to its right."""
    look_around, at_the_end = going_ahead(), Pose(1.5, 0.0, 0.0)
    aside = RADIUS + 0.12
    ends = np.vstack(
        [
            np.column_stack((np.linspace(-2.0, aside, 200), np.full(200, aside))),
            np.column_stack((np.linspace(-2.0, -aside, 200), np.full(200, -aside))),
            np.column_stack((np.full(200, aside), np.linspace(-1.3, aside, 200))),
            np.column_stack((np.full(200, -aside), np.linspace(-1.3, -aside, 200))),
            np.column_stack((np.linspace(-aside, aside, 50), np.full(50, -1.3))),
        ]
    )
    assert look_around.tick(6.0, at_the_end, ends, False) == Twist()
    assert look_around.tick(6.1, at_the_end, ends, False) == Twist(0.0, -TURNING)
    turned = np.column_stack((-ends[:, 1], ends[:, 0]))
    facing_right = Pose(1.5, 0.0, -0.5 * math.pi)
    assert look_around.tick(7.0, facing_right, turned, False).linear > 0.2


def test_what_is_beside_the_way_or_behind_stops_nothing() -> None:
    look_around = going_ahead()
    beside = np.array([[0.3, RADIUS + 0.08], [0.3, -RADIUS - 0.08], [-0.25, 0.0]])
    assert look_around.tick(0.1, Pose(), beside, False).linear == SPEED
    in_way = np.array([[0.3, RADIUS + 0.04]])
    assert look_around.tick(0.2, Pose(), in_way, False).linear < SPEED


def test_it_backs_from_what_it_touches_and_then_goes_elsewhere() -> None:
    look_around = going_ahead()
    backing = [look_around.tick(1.0, Pose(), NOTHING, True)]
    backing += [look_around.tick(1.0 + DT * step, Pose(), NOTHING, False) for step in range(1, 32)]
    assert set(backing) == {Twist(-CONFIG.looking_around.backing_speed, 0.0)}
    after = look_around.tick(1.85, Pose(), NOTHING, False)
    assert after.linear >= 0.0
    assert after != Twist()


def test_a_clock_that_is_set_back_does_not_let_it_back_for_ever() -> None:
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    look_around.tick(5000.0, Pose(), NOTHING, True)
    after = look_around.tick(10.0, Pose(), NOTHING, False)
    assert after.linear >= 0.0
    assert after != Twist()


def drive(home: Home, start: Pose, seconds: float) -> tuple[Located, list[Pose], int]:
    """Return the robot, where it was, and how often it began to touch something."""
    robot = Located(home, start)
    poses, touches, was_touching = [], 0, False
    for _ in steps(seconds):
        seen = robot.look()
        poses.append(seen.pose)
        assert seen.twist.linear < SPEED + 0.02
        assert abs(seen.twist.angular) < TURNING + 0.1
        touches += seen.bumper.pressed and not was_touching
        was_touching = seen.bumper.pressed
    return robot, poses, touches


def places(poses: list[Pose], size: float = 0.5) -> set[tuple[int, int]]:
    return {(math.floor(pose.x / size), math.floor(pose.y / size)) for pose in poses}


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_it_visits_new_places_and_touches_nothing_that_it_sees(home: Home) -> None:
    _, poses, touches = drive(home, Pose(1.0, 1.0, 0.3), 40.0)
    assert touches == 0
    # Twice as long is to see more.
    early = places(poses[: len(poses) // 2])
    assert len(early) >= 8
    assert len(places(poses)) >= len(early) + 4


@pytest.mark.parametrize("theta", [-0.75 * math.pi, 0.0, 0.5 * math.pi, 0.25 * math.pi])
def test_it_gets_out_of_a_corner(theta: float) -> None:
    home = room_home(4.0, 3.0)
    _, poses, _ = drive(home, Pose(RADIUS + 0.03, RADIUS + 0.03, theta), 8.0)
    assert max(math.hypot(pose.x, pose.y) for pose in poses) > 1.2


def test_it_gets_away_from_what_the_lidar_does_not_see() -> None:
    """Ahead is something that only the bumper feels, again and again."""
    world = Simulator(room_home(3.0, 3.0), CONFIG, start=Pose(1.5, 1.5, 0.0))
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    poses = []
    for step in steps(12.0):
        now = world.observe()
        felt = now.pose.x > 1.7 and math.cos(now.pose.theta) > 0.0 and step % 4 == 0
        seen = world.step(look_around.tick(now.time, now.odometry, FAR_AWAY, felt), DT)
        poses.append(seen.pose)
    assert max(pose.x for pose in poses) < 1.8
    assert min(pose.x for pose in poses) < 1.2


def test_where_there_is_no_other_way_it_goes_through_a_narrow_one() -> None:
    """Walls 4 cm beside the body, and one right behind it."""
    aside, along = RADIUS + 0.04, np.linspace(-0.4, 2.0, 200)
    ends = np.vstack(
        [
            np.column_stack((along, np.full(200, aside))),
            np.column_stack((along, np.full(200, -aside))),
            np.column_stack((np.full(60, -aside), np.linspace(-0.2, 0.2, 60))),
        ]
    )
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    wanted = [look_around.tick(DT * step, Pose(), ends, False) for step in range(3)]
    assert wanted[-1].linear > 0.2


def test_boxed_in_it_stands() -> None:
    angles = np.linspace(-math.pi, math.pi, 180)
    around = (RADIUS + 0.07) * np.column_stack((np.cos(angles), np.sin(angles)))
    look_around = LookAround(CONFIG.body, CONFIG.looking_around)
    for step in range(20):
        assert look_around.tick(0.1 * step, Pose(), around, False) == Twist()


def searching(robot: Located, search: SearchDrive) -> Twist | None:
    return search.tick(robot.world.time, robot.localizer, robot.world.observe().bumper.pressed)


def test_a_search_drives_only_while_more_must_be_seen() -> None:
    robot, search = (
        Located(TWO_ROOMS, Pose(1.0, 1.0, 0.3)),
        SearchDrive(CONFIG.body, CONFIG.looking_around),
    )
    assert searching(robot, search) is None
    robot.stay(0.5)
    assert searching(robot, search) is None
    # Nothing tells places apart within so little.
    robot.see_as = lambda ranges: np.where(ranges < 1.0, ranges, np.inf).astype(np.float32)
    robot.localizer.forget("it was told so")
    wanted = []
    for _ in steps(5.0):
        twist = searching(robot, search)
        wanted.append(twist)
        robot.step(twist or Twist())
    assert wanted[-1] is not None
    assert robot.world.numbers["distance"] > 0.2
    robot.see_as = lambda ranges: ranges
    for _ in steps(5.0):
        twist = searching(robot, search)
        if twist is None:
            break
        robot.step(twist)
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < 0.03
    assert searching(robot, search) is None


def test_one_that_stood_for_long_has_its_whole_time_to_look_around() -> None:
    robot, timeout = Located(TWO_ROOMS, Pose(1.0, 1.0, 0.3)), CONFIG.localization.search_timeout
    robot.stay(0.5)
    robot.see_as = lambda ranges: np.where(ranges < 1.0, ranges, np.inf).astype(np.float32)
    robot.localizer.forget("it was told so")
    for _ in range(2):
        robot.stay(timeout + 1.0)
        assert robot.estimate.knowledge is Knowledge.LOST
        search = SearchDrive(CONFIG.body, CONFIG.looking_around)
        searching(robot, search)
        assert robot.estimate.knowledge is Knowledge.SEARCHING
        for _ in steps(timeout - 1.0):
            robot.step(Twist())
            searching(robot, search)
            assert robot.estimate.knowledge is Knowledge.SEARCHING
        for _ in steps(2.0):
            robot.step(Twist())
            searching(robot, search)
        assert robot.estimate.knowledge is Knowledge.LOST


def test_a_robot_in_the_air_does_not_look_around() -> None:
    robot, search = (
        Located(TWO_ROOMS, Pose(1.0, 1.0, 0.3)),
        SearchDrive(CONFIG.body, CONFIG.looking_around),
    )
    robot.stay(0.3)
    robot.localizer.forget("it was told so")
    robot.localizer.lift(True)
    assert searching(robot, search) is None
