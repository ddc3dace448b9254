"""Bump and go: spirals, straight ways, turns away from what was touched, and along walls."""

from __future__ import annotations

import math
from enum import Enum

import numpy as np

from roomba.bumping.felt_floor import FeltFloor
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import STANDSTILL, TWO_PI, Pose, Twist, wrap_angle
from roomba.robot.readings import Readings


class BumpMove(Enum):
    """What the robot is doing."""

    SPIRAL = "in a spiral"
    STRAIGHT = "straight on"
    WALL = "along a wall"
    """The wall is on the robot's right, where its wall sensor looks."""
    TURN = "turning"
    BACK = "backing off"


class BumpAndGo:
    """Drives by touch alone; ``goal``, m by odometry, is where it heads; None: nowhere.

    ``stays_at_walls``: after each touch the robot follows what it touched, for longer than usual.

    ``wants_wall``: after the next touch the robot follows what it touched.

    ``is_held``: the robot touched so often without getting away that it needs help.
    """

    def __init__(
        self,
        config: BumpingConfig,
        radius: float,
        floor: FeltFloor,
        rng: np.random.Generator,
        goal: tuple[float, float] | None = None,
        *,
        stays_at_walls: bool = False,
    ) -> None:
        """Begin with a spiral, or on the way to a goal; ``radius``, m, is the body's."""
        self._config, self._radius, self._floor, self._rng = config, radius, floor, rng
        self.goal, self._stays_at_walls = goal, stays_at_walls
        self.is_held = self.wants_wall = False
        begins_straight = goal is not None or stays_at_walls
        self.move = BumpMove.STRAIGHT if begins_straight else BumpMove.SPIRAL
        self._next = BumpMove.STRAIGHT
        self._heading = 0.0
        self._began: Pose | None = None
        self._since = self._lost = -math.inf
        self._spiral = config.spiral_start
        self._spiralled = -math.inf
        self._last = -math.inf
        self._touches, self._bumps = 0, 0
        self._touched_at = (math.inf, math.inf)
        self._detour = 0.0
        self._nearest, self._near = 0.0, 0.0
        self._is_wedged = False
        self._around = 1.0
        self._along: float | None = None

    def tick(self, readings: Readings) -> Twist:
        """Return the twist that is wanted now."""
        now, pose = readings.time, readings.odometry
        dt, self._last = min(max(now - self._last, 0.0), 0.1), now
        if self._began is None:
            self._enter(self.move, readings)
        is_touched = readings.bumps or readings.cliff.any
        turns_free = self.move is BumpMove.TURN and self._is_wedged
        if is_touched and self.move is not BumpMove.BACK and not turns_free:
            self._touch(readings)
        match self.move:
            case BumpMove.BACK:
                return self._back(readings, is_touched=is_touched)
            case BumpMove.TURN:
                return self._turn(readings)
            case BumpMove.SPIRAL:
                return self._go_around(readings, dt)
            case BumpMove.WALL:
                return self._go_along(readings, dt)
            case _:
                return self._go_on(readings, pose)

    def _enter(self, move: BumpMove, readings: Readings) -> None:
        self.move, self._began, self._since = move, readings.odometry, readings.time
        self._lost = readings.time

    def _way(self, pose: Pose) -> float:
        began = self._began or pose
        return pose.distance_to(began.x, began.y)

    def is_along(self, readings: Readings) -> bool:
        """Whether the robot follows a wall, saw it a moment ago, and touches nothing."""
        is_seen = readings.time - self._lost <= self._config.wall_gap
        return self.move is BumpMove.WALL and is_seen and not readings.bumps

    def _touch(self, readings: Readings) -> None:
        """Remember the touch, choose what to do next, and back off."""
        pose, config = readings.odometry, self._config
        self._floor.feel(pose, self._radius)
        near = pose.distance_to(*self._touched_at) < config.free_way
        self._touches = self._touches + 1 if near else 1
        if not near:
            self._touched_at = pose.x, pose.y
        self.is_held = self._touches > config.most_touches
        left = readings.bumper_left or readings.cliff.left or readings.cliff.front_left
        right = readings.bumper_right or readings.cliff.right or readings.cliff.front_right
        self._bumps += 1
        turns_along = self.move is BumpMove.TURN and self._next is BumpMove.WALL
        goes_along = self._stays_at_walls or turns_along or self.move is BumpMove.WALL
        goes_along |= self.wants_wall or self._bumps % config.wall_every == 0
        # Between the legs of chairs, following walls leads nowhere.
        goes_along &= self._touches <= config.wall_touches and not readings.cliff.any
        if goes_along:
            self._next = BumpMove.WALL
            turn = config.corner_turn * (0.6 if right and not left else 1.4)
            self._heading, self._nearest = wrap_angle(pose.theta + turn), 0.0
        else:
            self._next, self._along = BumpMove.STRAIGHT, None
            self._heading = self._away(pose, left=left, right=right)
        again = max(1.0, self._touches / config.wall_touches)
        self._detour = config.detour * again * float(self._rng.uniform(0.3, 2.0))
        self._enter(BumpMove.BACK, readings)

    def _away(self, pose: Pose, *, left: bool, right: bool) -> float:
        """Return a heading away from what was touched, to the most unswept floor or to the goal."""
        config = self._config
        lowest = config.least_turn if left is not right else 2.0 * config.least_turn
        turns = self._rng.uniform(lowest, math.pi, config.headings)
        if left is right:
            turns *= self._rng.choice((-1.0, 1.0), config.headings)
        elif left:
            turns = -turns
        best, chosen = -math.inf, pose.theta + math.pi
        for turn in turns.tolist():
            heading = wrap_angle(pose.theta + turn)
            worth = self._floor.new_ahead(pose, heading, config.look_ahead)
            # After many touches at one place, the straight way to the goal is blocked.
            if self.goal is not None and self._touches <= config.wall_touches:
                bearing = math.atan2(self.goal[1] - pose.y, self.goal[0] - pose.x)
                worth = -abs(wrap_angle(heading - bearing))
            worth += float(self._rng.uniform(0.0, 0.5))
            if worth > best:
                best, chosen = worth, heading
        return wrap_angle(chosen)

    def _back(self, readings: Readings, *, is_touched: bool) -> Twist:
        config = self._config
        is_over = readings.time - self._since > config.backing_time
        self._is_wedged = is_over and is_touched
        if is_over or (self._way(readings.odometry) >= config.backing_way and not is_touched):
            self._enter(BumpMove.TURN, readings)
            return STANDSTILL
        return Twist(-0.4 * config.speed, 0.0)

    def _turn(self, readings: Readings) -> Twist:
        if self._next is BumpMove.WALL and self._has_turned_along(readings):
            self._enter(self._next, readings)
            return STANDSTILL
        wrong = wrap_angle(self._heading - readings.odometry.theta)
        took = readings.time - self._since
        if abs(wrong) <= self._config.aimed or took > TWO_PI / self._config.turning_speed:
            self._enter(self._next, readings)
            return STANDSTILL
        return Twist(0.0, math.copysign(self._config.turning_speed, wrong))

    def _has_turned_along(self, readings: Readings) -> bool:
        """Whether the wall's signal is past its peak: the robot then stands along the wall."""
        self._nearest, self._near = max(self._nearest, readings.wall), readings.wall
        return self._nearest > 0.0 and readings.wall < self._nearest - self._config.wall_passed

    def _go_around(self, readings: Readings, dt: float) -> Twist:
        config = self._config
        turning = min(config.speed / self._spiral, config.turning_speed)
        self._spiral += config.spiral_pitch / TWO_PI * turning * dt
        if self._spiral > config.spiral_end:
            self._end_spiral(readings)
        return Twist(min(config.speed, turning * self._spiral), self._around * turning)

    def _end_spiral(self, readings: Readings) -> None:
        self._spiral, self._spiralled = self._config.spiral_start, readings.time
        # Carpets swallow part of each turn: spirals to alternate sides cancel the error.
        self._around = -self._around
        self._enter(BumpMove.STRAIGHT, readings)

    def _go_on(self, readings: Readings, pose: Pose) -> Twist:
        config = self._config
        if self.goal is not None:
            turning = 0.0
            if self._way(pose) >= self._detour:
                wrong = pose.bearing_to(*self.goal)
                turning = min(max(2.0 * wrong, -config.turning_speed), config.turning_speed)
            share = max(0.0, 1.0 - abs(turning) / config.turning_speed)
            return Twist(config.speed * share, turning)
        waited = readings.time - self._spiralled > config.spiral_pause
        if waited and self._way(pose) > config.spiral_end and self._is_new_around(pose):
            self._spiral = config.spiral_start
            self._enter(BumpMove.SPIRAL, readings)
        return Twist(config.speed, 0.0)

    def _is_new_around(self, pose: Pose) -> bool:
        """Whether most of the floor around it was not swept yet."""
        config = self._config
        reach = config.spiral_end
        new = [
            self._floor.new_ahead(pose, number * TWO_PI / config.headings, reach)
            for number in range(config.headings)
        ]
        return float(np.mean(new)) > config.spiral_room * reach

    def _go_along(self, readings: Readings, dt: float) -> Twist:
        """Keep the signal of the wall on the right constant; drive a bend to find a lost wall."""
        config = self._config
        speed = config.wall_speed
        self._along = readings.time if self._along is None else self._along
        # Around furniture in the middle of a room the robot would go for ever.
        longest = config.home_wall_time if self._stays_at_walls else config.wall_time
        if readings.time - self._along > longest:
            self._next, self._along = BumpMove.STRAIGHT, None
            self._heading = wrap_angle(readings.odometry.theta + 2.0 * config.least_turn)
            self._enter(BumpMove.TURN, readings)
            return STANDSTILL
        if readings.wall > 0.0:
            self._lost = readings.time
            # The sensor is coarse: a step of its signal does not mean that the wall turns.
            share = dt / (dt + config.wall_smoothing)
            before, self._near = self._near, self._near + share * (readings.wall - self._near)
            rising = (self._near - before) / dt if dt > 0.0 else 0.0
            turning = config.wall_gain * (self._near - config.wall_signal)
            turning += config.wall_damping * rising
            return Twist(speed, max(min(turning, config.wall_turning), -config.wall_turning))
        lost = readings.time - self._lost
        if lost > TWO_PI * config.wall_radius / speed:
            self._along = None
            self._enter(BumpMove.STRAIGHT, readings)
        if lost < config.wall_gap:
            return Twist(speed, -config.wall_turning)
        return Twist(speed, -speed / config.wall_radius)
