"""Compiled motion: speed ramps, slipping wheels, exact arcs; what encoders and gyro measure."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import inner_part, part
from roomba.world.engine.contact_kernels import arc, free_share
from roomba.world.engine.state.arrays import CARPET, Row, Solid
from roomba.world.engine.state.random_kernels import next_normal

Quantiles = NDArray[np.float32]


@part
def ramp(value: float, target: float, speeding_up: float, braking: float, dt: float) -> float:
    """Return ``value`` brought towards ``target`` within the limits (1/s2), not past it."""
    target_now = 0.0 if value * target < 0.0 else target
    limit = (speeding_up if abs(target_now) > abs(value) else braking) * dt
    return value + min(max(target_now - value, -limit), limit)


@inner_part
def ramped(body: Row, numbers: Row, dt: float) -> tuple[float, float]:
    """Return the velocities that the drive has after ``dt`` s; without charge it comes to rest."""
    linear = min(max(body.wanted_linear, -body.max_speed), body.max_speed)
    most = numbers.max_angular_speed
    angular = min(max(body.wanted_angular, -most), most)
    if body.charge <= 0.0:
        linear = angular = 0.0
    return (
        ramp(body.linear, linear, numbers.acceleration, numbers.deceleration, dt),
        ramp(body.angular, angular, numbers.angular_acceleration, numbers.angular_deceleration, dt),
    )


@inner_part
def slips(
    body: Row, numbers: Row, quantiles: Quantiles, ground: int, way: float
) -> tuple[float, float]:
    """Return which share of its ``way``, m, each wheel loses in this step.

    The varying part of the slip stays about the same over ``slip_length`` (an Ornstein-Uhlenbeck
    process), so that the noise of a long way grows as a random walk does, for any step.
    """
    left, right = body.slip_left, body.slip_right
    if numbers.noisy > 0.0 and way > 0.0:
        mean = numbers.carpet_slip if ground == CARPET else numbers.slip
        stays = math.exp(-way / numbers.slip_length)
        fresh = numbers.slip_spread * math.sqrt(1.0 - stays * stays)
        body.varying_left = stays * body.varying_left + fresh * next_normal(body, quantiles)
        body.varying_right = stays * body.varying_right + fresh * next_normal(body, quantiles)
        left += mean + body.varying_left
        right += mean + body.varying_right
    if body.drop_left > 0.0:
        left = 1.0
    if body.drop_right > 0.0:
        right = 1.0
    return left, right


@inner_part
def drive(
    solid: Solid,
    home: Row,
    world: Row,
    robot: int,
    numbers: Row,
    quantiles: Quantiles,
    ground: int,
    dt: float,
) -> tuple[float, float]:
    """Move a robot by ``dt`` s; return the way, m, and the turn, rad, of its body.

    The robot drives one arc, by the mean velocities of the ramp, less slip. At contact the disc
    stops, and its forward speed is zero, and so is that of the wheels.
    """
    body = solid.robots[robot]
    linear, angular = ramped(body, numbers, dt)
    asked, asked_turn = 0.5 * (body.linear + linear) * dt, 0.5 * (body.angular + angular) * dt
    rolled, rolled_turn = asked, asked_turn
    half = 0.5 * numbers.track
    left, right = rolled - half * rolled_turn, rolled + half * rolled_turn
    body.stall_left = 1.0 if body.held_left > 0.0 and left != 0.0 else 0.0
    body.stall_right = 1.0 if body.held_right > 0.0 and right != 0.0 else 0.0
    if body.held_left > 0.0 or body.held_right > 0.0:
        left = 0.0 if body.held_left > 0.0 else left
        right = 0.0 if body.held_right > 0.0 else right
        rolled, rolled_turn = 0.5 * (left + right), (right - left) / numbers.track
    length, turn = rolled, rolled_turn
    slip_left, slip_right = slips(body, numbers, quantiles, ground, 0.5 * (abs(left) + abs(right)))
    if slip_left != 0.0 or slip_right != 0.0 or numbers.worn > 0.0:
        over_left = left * (1.0 - slip_left) * body.roll_left
        over_right = right * (1.0 - slip_right) * body.roll_right
        length, turn = 0.5 * (over_left + over_right), (over_right - over_left) / body.track
    if body.lifted > 0.0:
        length = turn = 0.0
    share = free_share(solid, home, world, robot, numbers.radius, length, turn)
    is_hit = share < 1.0
    if length != 0.0:
        body.x, body.y = arc(body.x, body.y, body.theta, length * share, turn * share)
    body.theta = wrapped(body.theta + turn)
    if ground == CARPET and numbers.worn > 0.0 and body.lifted == 0.0:
        pull_aside(solid, home, world, robot, numbers, 0.5 * (abs(left) + abs(right)))
    body.hits += 1.0 if is_hit and body.hit == 0.0 else 0.0
    body.hit = 1.0 if is_hit else 0.0
    body.linear = 0.0 if is_hit else linear
    body.angular = angular
    body.distance += abs(length) * share
    body.turned += abs(turn)
    before = body.ground_linear
    is_held = is_hit or body.lifted > 0.0
    body.ground_linear = 0.0 if is_held else linear + (length - asked) / dt
    body.ground_angular = 0.0 if body.lifted > 0.0 else angular + (turn - asked_turn) / dt
    if is_hit:
        # The wheels of a blocked body stand still, but for what they slip on the spot.
        rolled *= share + (1.0 - share) * numbers.blocked_slip
    left, right = rolled - half * rolled_turn, rolled + half * rolled_turn
    count_wheels(body, numbers, left, right, share, dt)
    feel_motion(body, numbers, quantiles, turn / dt, (body.ground_linear - before) / dt, dt)
    return math.copysign(abs(length) * share, length), turn


@inner_part
def pull_aside(
    solid: Solid, home: Row, world: Row, robot: int, numbers: Row, rolled: float
) -> None:
    """Carry a robot along the pile of the carpet that its wheels rolled over, m, up to a wall."""
    body = solid.robots[robot]
    way = rolled * math.hypot(world.pull_x, world.pull_y)
    if way == 0.0:
        return
    heading, body.theta = body.theta, math.atan2(world.pull_y, world.pull_x)
    share = free_share(solid, home, world, robot, numbers.radius, way, 0.0)
    body.x, body.y = arc(body.x, body.y, body.theta, way * share, 0.0)
    body.theta = heading


@inner_part
def count_wheels(
    body: Row, numbers: Row, left: float, right: float, share: float, dt: float
) -> None:
    """Let the encoders count what the wheels rolled, m, and odometry go on by that.

    After ``share`` of the step the body was stopped, and turned on the spot for the rest of it.
    """
    body.wheel_left += left / numbers.wheel_radius
    body.wheel_right += right / numbers.wheel_radius
    counted_left, counted_right = body.wheel_left, body.wheel_right
    if numbers.noisy > 0.0:
        step = numbers.radians_per_count
        counted_left = step * math.floor(counted_left / step)
        counted_right = step * math.floor(counted_right / step)
        left = (counted_left - body.encoder_left) * numbers.wheel_radius * body.wheel_left_size
        right = (counted_right - body.encoder_right) * numbers.wheel_radius
        right *= body.wheel_right_size
    body.encoder_left, body.encoder_right = counted_left, counted_right
    length, turn = 0.5 * (left + right), (right - left) / numbers.track
    if length != 0.0:
        body.odometry_x, body.odometry_y = arc(
            body.odometry_x, body.odometry_y, body.odometry_theta, length, turn * share
        )
    body.odometry_theta = wrapped(body.odometry_theta + turn)
    body.odometry_linear, body.odometry_angular = length / dt, turn / dt


@inner_part
def feel_motion(
    body: Row,
    numbers: Row,
    quantiles: Quantiles,
    angular: float,
    acceleration: float,
    dt: float,
) -> None:
    """Let the gyro feel the turning, rad/s, and the accelerometer the acceleration, m/s2."""
    if numbers.noisy > 0.0:
        body.gyro_bias += numbers.gyro_walk * math.sqrt(dt) * next_normal(body, quantiles)
        angular = angular * body.gyro_scale + body.gyro_bias
        angular += numbers.gyro_noise * next_normal(body, quantiles)
        acceleration += numbers.acceleration_noise * next_normal(body, quantiles)
        most = numbers.most_acceleration
        acceleration = min(max(acceleration, -most), most)
    elif numbers.worn > 0.0:
        angular *= body.gyro_scale
    body.gyro = angular
    body.acceleration = acceleration
