"""How the body moves, and what stops it: driven through the simulator."""

import math

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.homes.worlds import DT, IDEAL, block_that_moves, drive
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.configuration.body import BodyConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.world.home.home import Move
from roomba.world.simulator import Simulator

NORMAL = SimulatedRobotConfig()
"""Its wheels slip, so that it does not go quite as far and as straight as it is told."""
BODY = NORMAL.body
FREE = Pose(2.5, 2.0, 0.3)


def robot(
    start: Pose,
    config: SimulatedRobotConfig = NORMAL,
    *,
    blocks: tuple[Block, ...] = (),
    max_speed: float = 0.5,
    acceleration: float = 0,
) -> Simulator:
    """Return a robot in a room, with an acceleration and deceleration of its own if given."""
    if acceleration:
        body = BodyConfig(max_acceleration=acceleration, max_deceleration=acceleration)
        config = config.model_copy(update={"body": body})
    return Simulator(room_home(blocks=blocks), config, max_speed=max_speed, start=start)


def away_from_rectangle(
    x: float, y: float, middle: tuple[float, float, float], size: tuple[float, float]
) -> float:
    """Return the distance from a point to a turned rectangle."""
    turned = complex(x - middle[0], y - middle[1]) * np.exp(-1j * middle[2])
    dx = max(abs(turned.real) - 0.5 * size[0], 0.0)
    dy = max(abs(turned.imag) - 0.5 * size[1], 0.0)
    return math.hypot(dx, dy)


def independent_gap(
    world: Simulator, blocks: tuple[Block, ...], thing_size: tuple[float, float] = (0.0, 0.0)
) -> float:
    """Return the gap to all that is solid by plain geometry, without any grid."""
    x, y = world.pose.x, world.pose.y
    gaps = [x, y, 5.0 - x, 4.0 - y]
    for x_min, y_min, x_max, y_max in blocks:
        middle = (0.5 * (x_min + x_max), 0.5 * (y_min + y_max), 0.0)
        gaps.append(away_from_rectangle(x, y, middle, (x_max - x_min, y_max - y_min)))
    for thing_x, thing_y, theta, present in world.things.tolist():
        if present:
            gaps.append(away_from_rectangle(x, y, (thing_x, thing_y, theta), thing_size))
    gaps += [math.hypot(x - disc[0], y - disc[1]) - disc[2] for disc in world.discs.tolist()]
    return min(gaps) - BODY.radius


twists = st.tuples(st.floats(-80.0, 80.0), st.floats(-8.0, 8.0))


@settings(max_examples=examples(60))
@given(st.lists(twists, min_size=1, max_size=12), st.floats(0.001, 0.3), st.floats(-3.1, 3.1))
def test_it_is_never_inside_anything_solid_whatever_is_commanded(
    commands: list[tuple[float, float]], dt: float, theta: float
) -> None:
    blocks = ((1.0, 1.0, 1.5, 1.1), (3.0, 2.0, 3.05, 2.05), (2.0, 3.0, 3.0, 3.6))
    world = robot(Pose(2.5, 1.5, theta), blocks=blocks, max_speed=80.0, acceleration=500.0)
    for linear, angular in commands:
        for _ in range(6):
            world.step(Twist(linear, angular), dt)
            assert independent_gap(world, blocks) >= -1e-6


@settings(max_examples=examples(40))
@given(
    st.lists(st.tuples(st.floats(-0.7, 0.7), st.floats(-5.0, 5.0)), min_size=4, max_size=12),
    st.floats(0.01, 0.1),
    st.floats(0.1, 1.5),
)
def test_it_is_never_inside_round_or_moving_things(
    commands: list[tuple[float, float]], dt: float, speed: float
) -> None:
    size = (0.7, 0.2)
    way = 1.6
    there, back = Pose(2.5 - way, 2.6, 1.0), Pose(2.5 + way, 2.6, -2.0)
    pace = 2.0 * way / speed
    thing = block_that_moves(
        Move(0.0, pace, there), Move(pace, pace, back), pose=back, size=size, period=2.0 * pace
    )
    world = Simulator(room_home(moving=[thing]), max_speed=0.7, start=Pose(2.5, 1.9, 0.0))
    world.place_obstacle(2.0, 1.5, 0.1)
    world.place_obstacle(3.2, 1.9, 0.2)
    for linear, angular in commands:
        for _ in range(30):
            world.step(Twist(linear, angular), dt)
            assert independent_gap(world, (), size) >= -1e-6


@settings(max_examples=examples(40))
@given(st.lists(st.tuples(st.floats(-80.0, 80.0), st.floats(-8.0, 8.0)), min_size=1, max_size=12))
def test_speeds_and_accelerations_keep_their_limits(commands: list[tuple[float, float]]) -> None:
    world = robot(FREE, IDEAL)
    linear = angular = 0.0
    for command in (command for command in commands for _ in range(20)):
        was_at = world.pose
        twist = world.step(Twist(*command), DT).twist
        assert abs(twist.linear) <= 0.5 + 1e-12
        # An arc that hardly turns has a radius of up to 1e7 m, and is rounded by as much less.
        assert world.pose.distance_to(was_at.x, was_at.y) <= 0.5 * DT + 1e-8
        assert abs(twist.angular) <= BODY.max_angular_speed + 1e-12
        is_turning_faster = abs(twist.angular) > abs(angular)
        most = BODY.max_angular_acceleration if is_turning_faster else BODY.max_angular_deceleration
        assert abs(twist.angular - angular) <= most * DT + 1e-12
        is_faster = abs(twist.linear) > abs(linear)
        limit = BODY.max_acceleration if is_faster else BODY.max_deceleration
        was_stopped_by_contact = world.numbers["hit"] > 0.0
        assert was_stopped_by_contact or abs(twist.linear - linear) <= limit * DT + 1e-12
        linear, angular = twist.linear, twist.angular


def test_a_turn_on_the_spot_is_braked_as_soon_as_a_straight_drive() -> None:
    world = robot(FREE, IDEAL)
    assert drive(world, 0.0, BODY.max_angular_speed, 1.0).twist.angular == pytest.approx(4.25)
    assert drive(world, 0.0, 0.0, BODY.braking_time - DT).twist.angular > 0.0
    assert drive(world, 0.0, 0.0, DT).twist.angular == 0.0


def test_it_speeds_up_and_brakes_as_configured() -> None:
    world = robot(Pose(0.5, 2.0, 0.0), IDEAL)
    started = drive(world, 0.5, 0.0, 0.4)
    assert started.twist.linear == pytest.approx(0.4 * BODY.max_acceleration)
    assert started.pose.x - 0.5 == pytest.approx(0.5 * BODY.max_acceleration * 0.4**2)
    cruising = drive(world, 0.5, 0.0, 1.0)
    assert cruising.twist.linear == pytest.approx(0.5)
    standing = drive(world, 0.0, 0.0, 1.0)
    assert standing.twist.linear == 0.0
    way = standing.pose.x - cruising.pose.x
    assert way == pytest.approx(0.5**2 / (2.0 * BODY.max_deceleration), rel=1e-6)


def test_the_top_speed_may_be_set_while_it_drives() -> None:
    world = robot(Pose(0.5, 2.0, 0.0))
    assert drive(world, 0.5, 0.0, 1.0).twist.linear == pytest.approx(0.5, rel=0.02)
    world.max_speed = 0.2
    assert drive(world, 0.5, 0.0, 1.0).twist.linear == pytest.approx(0.2, rel=0.02)
    assert world.max_speed == 0.2


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_a_top_speed_that_makes_no_sense_is_refused(speed: float) -> None:
    with pytest.raises(ValueError, match="max_speed"):
        robot(FREE, max_speed=speed)
    world = robot(FREE)
    with pytest.raises(ValueError, match="max_speed"):
        world.max_speed = speed
    assert world.max_speed == 0.5


@settings(max_examples=examples(30))
@given(st.floats(-0.5, 0.5), st.floats(0.1, 4.0), st.sampled_from((1, -1)), st.floats(0.001, 0.2))
def test_arcs_are_exact_whatever_the_step(
    linear: float, angular: float, sign: int, dt: float
) -> None:
    """At steady speeds it stays on the circle of radius v / w; on a line if it is huge."""
    angular *= sign
    linear *= min(1.0, abs(angular))  # a circle that has room
    world = robot(FREE, IDEAL, max_speed=1.0, acceleration=1e6)
    world.advance(Twist(linear, angular), dt, math.ceil(4.25 / 7.7 / dt) + 1)
    before = world.pose
    world.advance(Twist(linear, angular), dt, 17)
    turn = 17.0 * dt * angular
    chord = linear / angular * 2.0 * math.sin(0.5 * turn)
    direction = before.theta + 0.5 * turn
    assert world.pose.x == pytest.approx(before.x + chord * math.cos(direction), abs=1e-9)
    assert world.pose.y == pytest.approx(before.y + chord * math.sin(direction), abs=1e-9)
    assert abs(wrap_angle(world.pose.theta - before.theta - turn)) < 1e-9


@pytest.mark.parametrize("speed", [0.05, 0.5, 5.0, 200.0])
def test_it_stops_at_contact_whatever_the_speed(speed: float) -> None:
    post = ((3.0, 1.95, 3.05, 2.05),)
    world = robot(Pose(0.5, 2.0, 0.0), IDEAL, blocks=post, max_speed=speed, acceleration=1e6)
    seen = drive(world, speed, 0.0, 3.0 / speed + 0.3, 0.05)
    assert seen.pose.x == pytest.approx(3.0 - BODY.radius, abs=1e-6)
    assert seen.twist.linear == 0.0
    assert seen.bumper.left
    assert seen.bumper.right
    assert world.gap == pytest.approx(0.0, abs=1e-6)
    assert world.numbers["hits"] == 1.0


def press(start: Pose, linear: float = 0.3, config: SimulatedRobotConfig = NORMAL) -> Simulator:
    world = robot(start, config)
    drive(world, linear, 0.0, 10.0)
    return world


@pytest.mark.parametrize(
    ("start", "left", "right"),
    [
        (Pose(2.0, 3.0, math.radians(30.0)), True, False),
        (Pose(2.0, 1.0, math.radians(-30.0)), False, True),
        (Pose(2.0, 2.0, math.radians(0.0)), True, True),
        (Pose(4.0, 3.0, math.radians(45.0)), True, True),  # into a corner
    ],
)
def test_the_bumper_tells_the_side(start: Pose, left: bool, right: bool) -> None:
    bumper = press(start, config=IDEAL).observe().bumper
    assert (bumper.left, bumper.right) == (left, right)
    assert bumper.pressed


def test_what_is_hit_backwards_stops_the_body_but_presses_nothing() -> None:
    world = press(Pose(1.0, 2.0, 0.0), linear=-0.3)
    assert world.pose.x == pytest.approx(BODY.radius, abs=1e-6)
    assert world.numbers["hits"] == 1.0
    assert not world.observe().bumper.pressed


def test_it_does_not_stick_it_turns_and_backs_off() -> None:
    world = press(Pose(3.0, 2.0, 0.0))
    contact = world.pose
    assert abs(drive(world, 0.3, 1.5, 2.0).pose.theta) > 1.5
    world = press(Pose(3.0, 2.0, 0.0))
    seen = drive(world, -0.3, 0.0, 1.0)
    assert seen.pose.x < contact.x - 0.2
    assert not seen.bumper.pressed
    assert seen.twist.linear == pytest.approx(-0.3, rel=0.02)


def test_the_bumper_stays_pressed_while_it_leans_on_the_wall() -> None:
    world = press(Pose(3.0, 2.0, 0.0))
    assert drive(world, 0.0, 0.0, 0.25).bumper.pressed


def test_turning_on_the_spot_moves_the_pressed_half_along_the_rim() -> None:
    world = press(Pose(4.0, 2.0, 0.0))
    seen = drive(world, 0.0, 0.5, 1.6)
    assert (seen.bumper.left, seen.bumper.right) == (False, True)
    assert not drive(world, 0.0, 0.5, 2.5).bumper.pressed


def test_standing_beside_a_wall_presses_nothing() -> None:
    world = robot(Pose(BODY.radius + 0.0005, 2.0, math.pi))
    assert not world.step(Twist(0.0, 0.5), DT).bumper.pressed


def test_a_hit_along_a_wall_is_one_hit() -> None:
    world = robot(Pose(2.0, 3.0, math.radians(60.0)))
    drive(world, 0.3, 0.0, 10.0)
    assert world.numbers["hits"] == 1.0
    drive(world, -0.3, 0.0, 1.0)
    drive(world, 0.3, 0.0, 5.0)
    assert world.numbers["hits"] == 2.0


def test_a_thing_put_in_the_way_stops_it_and_taken_away_lets_it_go() -> None:
    world = robot(Pose(1.0, 2.0, 0.0))
    world.place_obstacle(2.1, 2.0, 0.1)
    stopped = drive(world, 0.5, 0.0, 5.0)
    assert stopped.pose.distance_to(2.1, 2.0) == pytest.approx(0.1 + BODY.radius, abs=1e-6)
    assert stopped.bumper.pressed
    world.remove_obstacles()
    assert world.discs.shape == (0, 3)
    assert drive(world, 0.5, 0.0, 2.5).pose.x > 2.5


def test_it_counts_its_way_and_its_turns() -> None:
    world = robot(Pose(1.0, 2.0, 0.0), IDEAL)
    before = drive(world, 0.4, 0.0, 4.0).pose
    assert world.numbers["distance"] == pytest.approx(before.x - 1.0)
    drive(world, 0.0, 0.0, 1.0)
    drive(world, -0.4, 0.0, 2.0)
    drive(world, 0.0, 0.0, 1.0)
    farthest = before.x + 0.4**2 / (2.0 * BODY.max_deceleration)
    way = farthest - 1.0 + farthest - world.pose.x
    assert world.numbers["distance"] == pytest.approx(way, abs=2e-3)
    assert world.numbers["turned"] == 0.0
    drive(world, 0.0, 2.0, 2.0)
    drive(world, 0.0, -2.0, 2.0)
    drive(world, 0.0, 0.0, 1.0)
    assert world.numbers["turned"] == pytest.approx(7.5, abs=0.6)


@settings(max_examples=examples(60))
@given(st.floats(0.2, 4.8), st.floats(0.2, 3.8))
def test_the_gap_is_the_rims_distance_to_the_nearest_thing(x: float, y: float) -> None:
    blocks = ((2.0, 1.5, 2.5, 2.0), (1.0, 2.5, 1.05, 3.9))
    world = Simulator(room_home(blocks=blocks))
    world.place_obstacle(4.0, 3.0, 0.15)
    assume(max(abs(x - 2.25), abs(y - 1.75)) > 0.5 and math.hypot(x - 4.0, y - 3.0) > 0.35)
    assume(abs(x - 1.025) > 0.25)
    world.put(Pose(x, y, 0.0))
    expected = min(independent_gap(world, blocks), BODY.radius)
    assert world.gap == pytest.approx(expected, abs=1e-9)
