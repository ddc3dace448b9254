"""Bump and go without a home: its commands when it touches something."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.bumping.felt_floor import FeltFloor
from roomba.bumping.sweeping import BumpAndGo, BumpMove
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.robot.readings import Readings

CONFIG, TICK = BumpingConfig(), 0.05


class Driven:
    """A body that does exactly what is wanted."""

    def __init__(self, goal: tuple[float, float] | None = None, seed: int = 1) -> None:
        self.floor = FeltFloor(CONFIG, 0.2)
        rng = np.random.default_rng(seed)
        self.sweeping = BumpAndGo(CONFIG, 0.17, self.floor, rng, goal)
        self.pose, self.time = Pose(), 0.0
        self.is_blocked = False

    def tick(self, *, left: bool = False, right: bool = False, wall: float = 0.0) -> Twist:
        readings = Readings(self.time, self.pose, bumper_left=left, bumper_right=right, wall=wall)
        twist = self.sweeping.tick(readings)
        turn, way = twist.angular * TICK, 0.0 if self.is_blocked else twist.linear * TICK
        self.pose = self.pose.compose(
            Pose(way * math.cos(turn / 2), way * math.sin(turn / 2), turn)
        )
        self.time += TICK
        return twist

    def until(self, move: BumpMove, seconds: float, wall: float = 0.0) -> None:
        for _ in range(round(seconds / TICK)):
            self.tick(wall=wall)
            if self.sweeping.move is move:
                return
        raise AssertionError(f"not {move} within {seconds} s but {self.sweeping.move}")

    def come_to_a_wall(self) -> None:
        """Bump until it has turned to go along a wall."""
        self.until(BumpMove.STRAIGHT, 300.0)
        for _ in range(CONFIG.wall_every):
            self.tick(right=True)
            self.until(BumpMove.TURN, 5.0)
            while self.sweeping.move is BumpMove.TURN:
                self.tick()


def test_it_begins_in_a_spiral_that_grows_and_ends() -> None:
    driven = Driven()
    driven.tick()
    assert driven.sweeping.move is BumpMove.SPIRAL
    farthest = 0.0
    while driven.sweeping.move is BumpMove.SPIRAL and driven.time < 300.0:
        driven.tick()
        farthest = max(farthest, math.hypot(driven.pose.x, driven.pose.y))
    assert driven.sweeping.move is BumpMove.STRAIGHT
    assert farthest > CONFIG.spiral_end


@pytest.mark.parametrize("is_left", [True, False])
def test_after_a_touch_it_backs_off_and_turns_away_from_it(is_left: bool) -> None:
    driven = Driven()
    driven.until(BumpMove.STRAIGHT, 300.0)
    before = driven.pose
    driven.tick(left=is_left, right=not is_left)
    assert driven.sweeping.move is BumpMove.BACK
    assert driven.floor.felt.any()
    driven.until(BumpMove.TURN, 5.0)
    assert driven.pose.distance_to(before.x, before.y) == pytest.approx(
        CONFIG.backing_way, abs=0.02
    )
    driven.until(BumpMove.STRAIGHT, 5.0)
    turned = wrap_angle(driven.pose.theta - before.theta)
    away = -turned if is_left else turned
    assert CONFIG.least_turn - CONFIG.aimed - 0.1 < away or away < -math.pi + 0.2


def test_along_a_wall_it_keeps_that_on_its_right_until_the_time_is_over() -> None:
    driven = Driven()
    driven.come_to_a_wall()
    assert driven.sweeping.move is BumpMove.WALL
    for wall in (0.2, CONFIG.wall_signal, 0.9):
        for _ in range(40):
            twist = driven.tick(wall=wall)
        # By how far the wall is from where it should be; a wall that stays there turns nothing.
        expected = CONFIG.wall_gain * (wall - CONFIG.wall_signal)
        assert twist.angular == pytest.approx(expected, abs=1e-3)
    assert driven.tick(wall=0.2).angular < 0.0
    assert driven.tick().angular < 0.0
    driven.until(BumpMove.TURN, CONFIG.wall_time + 1.0, wall=0.2)
    driven.until(BumpMove.STRAIGHT, 5.0)


def test_a_wall_that_ended_is_looked_for_in_one_turn_and_then_it_goes_on() -> None:
    driven = Driven()
    driven.come_to_a_wall()
    driven.until(BumpMove.STRAIGHT, 2.0 * math.tau * CONFIG.wall_radius / CONFIG.wall_speed)


def test_with_a_goal_it_comes_there() -> None:
    driven = Driven(goal=(2.0, 1.0))
    for _ in range(round(60.0 / TICK)):
        driven.tick()
        if driven.pose.distance_to(2.0, 1.0) < 0.3:
            return
    raise AssertionError(f"it is at {driven.pose}")


def test_spirals_go_left_and_right_by_turns() -> None:
    driven = Driven()
    turned = []
    for _ in range(2):
        driven.until(BumpMove.SPIRAL, 30.0)
        turned.append(driven.tick().angular)
        driven.until(BumpMove.STRAIGHT, 300.0)
        driven.time += CONFIG.spiral_pause
    assert turned[0] > 0.0 > turned[1]


def test_wedged_between_things_it_turns_although_it_touches_one() -> None:
    driven = Driven()
    driven.until(BumpMove.STRAIGHT, 300.0)
    driven.is_blocked = True
    turning = 0.0
    for _ in range(round(10.0 / TICK)):
        turning += abs(driven.tick(left=True, right=True).angular) * TICK
    assert turning > CONFIG.least_turn


@pytest.mark.parametrize("wants", [True, False])
def test_where_a_wall_is_wanted_it_goes_along_what_it_touches_next(wants: bool) -> None:
    driven = Driven()
    driven.until(BumpMove.STRAIGHT, 300.0)
    driven.sweeping.wants_wall = wants
    driven.tick(right=True)
    driven.until(BumpMove.WALL if wants else BumpMove.STRAIGHT, 5.0)
