import math

import numpy as np
import pytest
from fixtures.rooms import Block, room_home
from hypothesis import given
from hypothesis import strategies as st

from roomba.config import BodyConfig
from roomba.geometry import Pose, Twist
from roomba.world.body import Body

CONFIG = BodyConfig()
DT = 0.025


def body_in_room(
    start: Pose, blocks: tuple[Block, ...] = (), max_speed: float = 0.5, config: BodyConfig = CONFIG
) -> Body:
    home = room_home(blocks=blocks)
    return Body(home.solid, home.frame, config, max_speed=max_speed, start=start)


def independent_gap(body: Body, blocks: tuple[Block, ...]) -> float:
    """Distance of the disc to walls and blocks by plain geometry, without any grid."""
    pose = body.pose
    gaps = [pose.x, pose.y, 5.0 - pose.x, 4.0 - pose.y]
    for x_min, y_min, x_max, y_max in blocks:
        dx = max(x_min - pose.x, pose.x - x_max, 0.0)
        dy = max(y_min - pose.y, pose.y - y_max, 0.0)
        gaps.append(math.hypot(dx, dy))
    return min(gaps) - CONFIG.radius


twists = st.tuples(st.floats(-80.0, 80.0), st.floats(-8.0, 8.0))


@given(st.lists(twists, min_size=1, max_size=12), st.floats(0.001, 0.3), st.integers(0, 2**32))
def test_it_is_never_inside_anything_solid_whatever_is_commanded(
    commands: list[tuple[float, float]], dt: float, seed: int
) -> None:
    blocks = ((1.0, 1.0, 1.5, 1.1), (3.0, 2.0, 3.05, 2.05), (2.0, 3.0, 3.0, 3.6))
    config = BodyConfig(max_acceleration=500.0, max_deceleration=500.0)
    theta = np.random.default_rng(seed).uniform(-3.1, 3.1)
    body = body_in_room(Pose(2.5, 1.5, theta), blocks, max_speed=80.0, config=config)
    for linear, angular in commands:
        for _ in range(6):
            body.drive(Twist(linear, angular), dt)
            assert independent_gap(body, blocks) >= -1e-6


@given(st.lists(twists, min_size=1, max_size=20))
def test_speeds_and_accelerations_keep_their_limits(commands: list[tuple[float, float]]) -> None:
    body = body_in_room(Pose(2.5, 2.0, 0.3))
    before = body.twist
    for linear, angular in (command for command in commands for _ in range(40)):
        body.drive(Twist(linear, angular), DT)
        after = body.twist
        assert abs(after.linear) <= 0.5 + 1e-12
        assert abs(after.angular) <= CONFIG.max_angular_speed + 1e-12
        turn_change = abs(after.angular - before.angular)
        assert turn_change <= CONFIG.max_angular_acceleration * DT + 1e-12
        change = after.linear - before.linear
        stopped_by_contact = after.linear == 0.0
        if not stopped_by_contact:
            faster = abs(after.linear) > abs(before.linear)
            limit = CONFIG.max_acceleration if faster else CONFIG.max_deceleration
            assert abs(change) <= limit * DT + 1e-12
        before = after


def test_arcs_are_exact() -> None:
    """At steady speeds it stays on the circle of radius v / w, whatever the step."""
    body = body_in_room(Pose(2.5, 1.0, 0.0), max_speed=0.5)
    body.state[3:5] = 0.4, 0.5
    for _ in range(100):
        body.drive(Twist(0.4, 0.5), 0.037)
    angle = 0.5 * 3.7
    assert body.pose.x == pytest.approx(2.5 + 0.8 * math.sin(angle), abs=1e-9)
    assert body.pose.y == pytest.approx(1.0 + 0.8 * (1.0 - math.cos(angle)), abs=1e-9)
    assert body.pose.theta == pytest.approx(angle)


@pytest.mark.parametrize("speed", [0.05, 0.5, 5.0, 200.0])
def test_it_stops_at_contact_whatever_the_speed(speed: float) -> None:
    post = ((3.0, 1.95, 3.05, 2.05),)
    config = BodyConfig(max_acceleration=1e6, max_deceleration=1e6)
    body = body_in_room(Pose(0.5, 2.0, 0.0), post, max_speed=speed, config=config)
    for _ in range(int(4.0 / (speed * 0.05)) + 3):
        body.drive(Twist(speed, 0.0), 0.05)
    assert body.pose.x == pytest.approx(3.0 - CONFIG.radius, abs=1e-4)
    assert body.twist.linear == 0.0
    assert body.bumper.left
    assert body.bumper.right


def press(start: Pose, linear: float = 0.3) -> Body:
    body = body_in_room(start)
    for _ in range(400):
        body.drive(Twist(linear, 0.0), DT)
    return body


def test_the_bumper_tells_the_side() -> None:
    left = press(Pose(2.0, 3.0, math.radians(30.0)))
    assert left.bumper.left
    assert not left.bumper.right
    right = press(Pose(2.0, 1.0, math.radians(-30.0)))
    assert right.bumper.right
    assert not right.bumper.left


def test_what_is_hit_backwards_stops_the_body_but_presses_nothing() -> None:
    body = press(Pose(1.0, 2.0, 0.0), linear=-0.3)
    assert body.pose.x == pytest.approx(CONFIG.radius, abs=1e-4)
    assert not body.bumper.pressed


def test_it_does_not_stick_it_turns_and_backs_off() -> None:
    body = press(Pose(3.0, 2.0, 0.0))
    contact = body.pose
    for _ in range(80):
        body.drive(Twist(0.3, 1.5), DT)
    assert abs(body.pose.theta) > 1.5
    body = press(Pose(3.0, 2.0, 0.0))
    for _ in range(40):
        body.drive(Twist(-0.3, 0.0), DT)
    assert body.pose.x < contact.x - 0.2
    assert not body.bumper.pressed


def test_the_bumper_stays_pressed_while_it_leans_on_the_wall() -> None:
    body = press(Pose(3.0, 2.0, 0.0))
    for _ in range(10):
        body.drive(Twist(0.0, 0.0), DT)
    assert body.bumper.pressed


def test_standing_beside_a_wall_presses_nothing() -> None:
    body = body_in_room(Pose(CONFIG.radius + 0.0005, 2.0, math.pi))
    body.drive(Twist(0.0, 0.5), DT)
    assert not body.bumper.pressed


def test_a_thing_put_in_the_way_stops_it_and_taken_away_lets_it_go() -> None:
    body = body_in_room(Pose(1.0, 2.0, 0.0))
    free = body.solid
    blocked = room_home(blocks=((2.0, 1.5, 2.2, 2.5),)).solid
    body.replace_solid(blocked)
    for _ in range(200):
        body.drive(Twist(0.5, 0.0), DT)
    assert body.pose.x == pytest.approx(2.0 - CONFIG.radius, abs=1e-4)
    body.replace_solid(free)
    for _ in range(100):
        body.drive(Twist(0.5, 0.0), DT)
    assert body.pose.x > 2.5
