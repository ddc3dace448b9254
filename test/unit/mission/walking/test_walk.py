import math
from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist
from roomba.headless.mission import HeadlessMission
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.inputs.senses import Senses
from roomba.mission.walking.walk import Walk, WalkState, feedback_period
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.planning.path.planner import NoPathError, PathPlanner
from roomba.world.layers.layer import load_home

CONFIG = RobotConfig()
FURNITURE: tuple[Block, ...] = (
    (1.2, 0.0, 1.3, 2.6),
    (2.4, 1.0, 3.2, 1.8),
    (3.8, 2.2, 3.9, 4.0),
)


def furnished(hidden: tuple[Block, ...] = ()) -> HeadlessMission:
    return HeadlessMission(room_home(blocks=FURNITURE, hidden=hidden))


def planner_of(robot: HeadlessMission) -> PathPlanner:
    return robot.brain.walking.planner(robot.mission.context.occupancy)


@settings(max_examples=examples(25))
@given(st.floats(0.2, 4.8), st.floats(0.2, 3.8))
def test_it_arrives_wherever_there_is_a_way_and_touches_nothing(x: float, y: float) -> None:
    robot = furnished()
    try:
        planner_of(robot).plan((0.5, 0.5), (x, y))
    except NoPathError:
        assume(False)
    record = robot.walk(x, y)
    assert record.state is WalkState.ARRIVED
    assert math.dist(record.poses[-1, 1:3], (x, y)) < 0.05
    assert record.bumps == 0


def test_it_stays_near_its_path_and_takes_about_the_time_of_its_length() -> None:
    record = furnished().walk(4.5, 3.5)
    assert record.state is WalkState.ARRIVED
    assert record.distance < 1.05 * math.dist((0, 0), (0, record.steps[0].distance_left))
    assert record.duration < record.steps[0].distance_left / 0.5 + 8.0


@pytest.mark.parametrize("distance", [0.0, 0.03, 0.1, 0.3, 0.9])
def test_short_ways_arrive_too_and_never_above_the_top_speed(distance: float) -> None:
    robot = furnished()
    record = robot.walk(0.5, 0.5 + distance)
    assert record.state is WalkState.ARRIVED
    assert math.dist(record.poses[-1, 1:3], (0.5, 0.5 + distance)) < 0.05
    times, points = record.poses[:, 0], record.poses[:, 1:3]
    for t, p, t2, p2 in zip(times, points, times[1:], points[1:], strict=False):
        # Slip that varies by chance lets a wheel go a little farther than it turned, too.
        assert math.dist(p, p2) <= 1.02 * 0.5 * (t2 - t)


@pytest.mark.parametrize("further", [0.04, 0.06, 0.09])
def test_a_little_further_right_after_arriving_is_walked_too(further: float) -> None:
    robot = furnished()
    robot.walk(0.8, 1.0)
    record = robot.walk(0.8, 1.0 + further)
    assert record.state is WalkState.ARRIVED
    assert record.duration < 10.0
    assert math.dist(record.poses[-1, 1:3], (0.8, 1.0 + further)) < 0.04


def test_a_thing_that_only_the_lidar_sees_is_gone_around_without_a_touch() -> None:
    robot = furnished(hidden=((1.6, 2.9, 2.0, 3.3),))
    record = robot.walk(2.8, 3.0)
    assert record.state is WalkState.ARRIVED
    assert record.bumps == 0
    assert math.dist(record.poses[-1, 1:3], (2.8, 3.0)) < 0.05


def test_a_way_that_is_walled_up_ends_with_the_reason() -> None:
    robot = furnished(hidden=((1.2, 2.6, 1.3, 4.0),))
    record = robot.walk(4.5, 0.5)
    assert record.state is WalkState.FAILED
    assert "map does not show" in record.reason
    assert record.duration < 180.0


def test_a_goal_inside_an_unknown_thing_ends_with_the_reason() -> None:
    record = furnished(hidden=((1.8, 2.8, 2.6, 3.6),)).walk(2.2, 3.2)
    assert record.state is WalkState.FAILED
    assert record.reason


def test_a_destination_in_the_wall_is_refused_with_the_nearest_point() -> None:
    with pytest.raises(NoPathError) as refusal:
        furnished().walk(1.25, 1.0)
    assert refusal.value.nearest is not None
    assert "1.25, 1.00" in str(refusal.value)


def family_robot() -> HeadlessMission:
    return HeadlessMission(load_home("family", HOMES))


@pytest.mark.parametrize("goal", [(7.1, -0.7), (7.1, -1.0)])
def test_a_goal_down_the_stairs_ends_at_their_edge_with_the_reason(
    goal: tuple[float, float],
) -> None:
    robot = family_robot()
    record = robot.walk(*goal)
    assert record.state is WalkState.FAILED
    assert "the floor ends" in record.reason
    numbers = robot.simulator.numbers
    assert not numbers["drop_left"]
    assert not numbers["drop_right"]
    assert record.poses[:, 1].max() < 6.5


def test_a_goal_beside_the_stairs_is_reached_without_a_wheel_over_the_edge() -> None:
    robot = family_robot()
    record = robot.walk(6.3, -0.9)
    assert record.state is WalkState.ARRIVED
    assert not robot.simulator.numbers["drop_left"]
    assert record.poses[:, 1].max() < 6.5


def stuck_walk() -> tuple[Walk, Senses]:
    home = room_home()
    planner = PathPlanner(home.map, CONFIG.body.radius, 0.04, 0.01)
    senses = Senses(100.0, Pose(1.0, 1.0, 0.0))
    things = ThingLayer(SurfaceField.of(home.map))
    obstacles = Obstacles(things, CONFIG.walk, CONFIG.body, MissionConfig().driving)
    return Walk(planner, CONFIG.walk, obstacles, (4.0, 3.0), senses), senses


def test_where_it_stands_it_has_arrived_though_no_way_leads_there() -> None:
    home = room_home(blocks=FURNITURE)
    planner = PathPlanner(home.map, CONFIG.body.radius, 0.04, 0.01)
    things = ThingLayer(SurfaceField.of(home.map))
    obstacles = Obstacles(things, CONFIG.walk, CONFIG.body, MissionConfig().driving)
    beside = Senses(100.0, Pose(1.2 - CONFIG.body.radius, 1.0, 0.0))
    goal = (beside.pose.x + 0.01, beside.pose.y)
    with pytest.raises(NoPathError):
        planner.plan((0.5, 1.0), goal)
    walk = Walk(planner, CONFIG.walk, obstacles, goal, beside)
    assert walk.tick(beside, 0.5).state is WalkState.ARRIVED
    with pytest.raises(NoPathError):
        Walk(planner, CONFIG.walk, obstacles, (goal[0] + 0.1, goal[1]), beside)


def test_a_robot_that_does_not_move_gives_up_with_the_reason() -> None:
    walk, senses = stuck_walk()
    for tick in range(20 * 200):
        step = walk.tick(Senses(100.0 + 0.05 * tick, senses.pose), 0.5)
        if step.state is not WalkState.WALKING:
            break
    assert step.state is WalkState.FAILED
    assert "comes no nearer" in step.reason
    expected = CONFIG.walk.progress_timeout * (CONFIG.walk.max_replans + 1)
    assert walk.time_spent(100.0 + 0.05 * tick) == pytest.approx(expected, abs=2.0)


def test_one_that_turns_slowly_keeps_its_path_while_it_turns() -> None:
    """Its half turn on the spot takes some 16 s, more than twice what is no progress."""
    walk, senses = stuck_walk()
    path, speed = walk.path, 0.2
    ahead = senses.pose.bearing_to(*path.points[1])
    times = np.arange(0.05, math.pi / speed, 0.05)
    for time in times:
        turned = replace(senses.pose, theta=ahead + math.pi - speed * time)
        walk.tick(Senses(100.0 + time, turned), 0.5)
        assert walk.path is path
    for time in times[-1] + np.arange(0.05, CONFIG.walk.progress_timeout + 0.2, 0.05):
        walk.tick(Senses(100.0 + time, turned), 0.5)
    assert walk.path is not path, "it is held"


def test_one_that_swings_to_and_fro_is_held() -> None:
    walk, senses = stuck_walk()
    path = walk.path
    for time in np.arange(0.05, 10.0 * CONFIG.walk.progress_timeout, 0.05):
        walk.tick(Senses(100.0 + time, replace(senses.pose, theta=3.0 * math.sin(time))), 0.5)
        if walk.path is not path:
            return
    raise AssertionError("it was never held")


def test_a_robot_that_was_carried_away_plans_anew() -> None:
    walk, senses = stuck_walk()
    path = walk.path
    walk.tick(senses, 0.5)
    walk.tick(Senses(101.0, Pose(3.5, 0.6, 0.0)), 0.5)
    assert walk.path is not path
    assert walk.path.points[0].tolist() == [3.5, 0.6]


def test_it_slows_for_corners() -> None:
    record = furnished().walk(4.5, 0.5)
    cruise = [step.cruise_speed for step in record.steps]
    assert max(cruise) == pytest.approx(0.5)
    assert min(cruise) < 0.4


def test_a_walk_that_passed_its_goal_at_speed_has_not_arrived() -> None:
    walk, _ = stuck_walk()
    assert (
        walk.tick(Senses(101.0, Pose(4.0, 3.0), twist=Twist(0.5)), 0.5).state is WalkState.WALKING
    )
    assert walk.tick(Senses(101.1, Pose(4.0, 3.0)), 0.5).state is WalkState.ARRIVED


@pytest.mark.parametrize("jump", [-3600.0, 3600.0])
def test_a_clock_that_is_set_changes_neither_the_time_spent_nor_the_time_out(jump: float) -> None:
    walk, senses = stuck_walk()
    now, ended = 100.0, WalkState.WALKING
    for tick in range(20 * 200):
        now += 0.05 + (jump if tick == 100 else 0.0)
        ended = walk.tick(Senses(now, senses.pose), 0.5).state
        if ended is not WalkState.WALKING:
            break
    assert ended is WalkState.FAILED
    expected = CONFIG.walk.progress_timeout * (CONFIG.walk.max_replans + 1)
    assert walk.time_spent(now) == pytest.approx(expected, abs=2.0)


def test_feedback_comes_as_often_as_the_report_says() -> None:
    assert feedback_period(9.9) == 2.0
    assert feedback_period(10.0) == 3.0
    assert feedback_period(25.0) == 4.0


def test_a_walk_waits_for_its_place_to_be_found_but_not_for_ever() -> None:
    robot = furnished()
    at = Pose(0.5, 0.5, 0.0)
    senses = Senses(0.0, at)
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (4.5, 3.5), senses)
    astray = replace(senses, knowledge=Knowledge.SEARCHING, trouble="it was carried")
    steps = [walk.tick(replace(astray, now=0.05 * tick), 0.5) for tick in range(1, 1400)]
    assert steps[0].state is WalkState.ASTRAY
    assert "it was carried" in steps[-1].reason
    failed = next(tick for tick, step in enumerate(steps) if step.state is WalkState.FAILED)
    assert 0.05 * failed == pytest.approx(CONFIG.walk.astray_timeout, abs=0.2)


def test_a_walk_goes_on_from_where_the_robot_was_found() -> None:
    robot = furnished()
    senses = Senses(0.0, Pose(0.5, 0.5))
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (4.5, 3.5), senses)
    # It is picked up nose first.
    walk.tick(replace(senses, now=0.05, cliff_left=True), 0.5)
    held = replace(senses, now=0.1, lifted=True, knowledge=Knowledge.SEARCHING)
    assert walk.tick(held, 0.5).state is WalkState.ASTRAY
    assert robot.mission.obstacles.edges() == []
    found = replace(senses, now=0.15, pose=Pose(4.5, 0.5, 0.0))
    assert walk.tick(found, 0.5).state is WalkState.WALKING
    assert tuple(walk.path.points[0]) == pytest.approx((4.5, 0.5), abs=0.06)


def test_a_robot_that_knows_its_place_but_roughly_walks_slowly() -> None:
    robot = furnished()
    senses = Senses(0.0, Pose(0.5, 0.5), knowledge=Knowledge.ROUGH)
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (0.5, 3.5), senses)
    assert walk.tick(replace(senses, now=0.05), 0.5).cruise_speed <= CONFIG.walk.careful_speed


def test_a_lost_robot_gives_its_walk_up() -> None:
    robot = furnished()
    senses = Senses(0.0, Pose(0.5, 0.5))
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (0.5, 3.5), senses)
    lost = replace(senses, now=0.05, knowledge=Knowledge.LOST, trouble="several places fit")
    step = walk.tick(lost, 0.5)
    assert step.state is WalkState.FAILED
    assert "several places fit" in step.reason


def test_a_walk_that_begins_lost_looks_around_first() -> None:
    robot = furnished()
    lost = Senses(0.0, Pose(0.5, 0.5), knowledge=Knowledge.LOST, trouble="several places fit")
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (0.5, 3.5), lost)
    assert walk.tick(replace(lost, now=0.05), 0.5).state is WalkState.ASTRAY
    searched = replace(lost, now=1.0, knowledge=Knowledge.SEARCHING)
    assert walk.tick(searched, 0.5).state is WalkState.ASTRAY
    assert walk.tick(replace(lost, now=1.05), 0.5).state is WalkState.FAILED
    # Where no search begins it says so soon.
    walk = Walk(planner_of(robot), CONFIG.walk, robot.mission.obstacles, (0.5, 3.5), lost)
    late = replace(lost, now=CONFIG.walk.search_wait + 0.1)
    assert walk.tick(replace(lost, now=0.05), 0.5).state is WalkState.ASTRAY
    assert walk.tick(replace(late, now=1.0), 0.5).state is WalkState.ASTRAY
    assert walk.tick(late, 0.5).state is WalkState.FAILED


@pytest.mark.parametrize("speed", [0.15, 0.5])
def test_around_corners_it_keeps_most_of_its_clearance(speed: float) -> None:
    """Slow or fast: the setpoint on a bend of many small ones is not so far ahead as to cut it."""
    robot = HeadlessMission(room_home(blocks=[(2.0, 1.5, 2.2, 2.5)], station=Pose(0.5, 2.0)))
    robot.brain.limit_speed(speed)
    there = robot.walk(3.6, 2.0)
    assert there.state is WalkState.ARRIVED
    assert there.bumps == 0
    x, y = there.poses[:, 1], there.poses[:, 2]
    off = np.hypot(np.maximum(np.abs(x - 2.1) - 0.1, 0.0), np.maximum(np.abs(y - 2.0) - 0.5, 0.0))
    assert off.min() - CONFIG.body.radius > 0.5 * CONFIG.walk.clearance
