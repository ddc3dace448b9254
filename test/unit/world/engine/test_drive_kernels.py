"""What encoders, odometry, gyro and accelerometer tell of a drive, ideal and noisy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, IDEAL, NOISY, drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.world.engine.drive_kernels import ramp
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Home
from roomba.world.simulator import Simulator

CONFIG = SimulatedRobotConfig()
TRACK = CONFIG.body.wheel_separation
WHEEL = 0.5 * CONFIG.body.wheel_diameter
HALL = room_home(width=20.0, height=8.0)
CARPETED = room_home(width=20.0, height=8.0, carpets=((0.0, 0.0, 20.0, 8.0),))

commands = st.lists(st.tuples(st.floats(-0.7, 0.7), st.floats(-5.0, 5.0)), min_size=1, max_size=15)


@settings(max_examples=examples(60))
@given(
    st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.0, 5.0), st.floats(0.0, 5.0),
    st.floats(1e-4, 0.5),
)  # fmt: skip
def test_a_ramp_keeps_its_limits_and_neither_passes_its_target_nor_zero(
    value: float, target: float, speeding_up: float, braking: float, dt: float
) -> None:
    after = ramp(value, target, speeding_up, braking, dt)
    assert min(value, target) - 1e-12 <= after <= max(value, target) + 1e-12
    assert value * after >= 0.0
    limit = speeding_up if abs(after) > abs(value) else braking
    assert abs(after - value) <= limit * dt + 1e-12


@settings(max_examples=examples(60))
@given(commands, st.floats(0.005, 0.1), st.floats(-3.1, 3.1))
def test_ideal_odometry_is_the_way_from_the_start_whatever_is_driven_and_hit(
    twists: list[tuple[float, float]], dt: float, theta: float
) -> None:
    start = Pose(1.0, 1.0, theta)
    home = room_home(2.0, 2.0, blocks=((1.5, 1.5, 1.6, 1.6),))
    world = Simulator(home, IDEAL, start=start, max_speed=0.7)
    for linear, angular in twists:
        seen = drive(world, linear, angular, 15 * dt, dt)
        believed = start.compose(seen.odometry)
        assert believed.distance_to(seen.pose.x, seen.pose.y) < 1e-9
        assert abs(wrap_angle(believed.theta - seen.pose.theta)) < 1e-9


@settings(max_examples=examples(30))
@given(commands, st.floats(0.005, 0.1))
def test_an_ideal_gyro_tells_the_true_turning_and_encoders_the_wheels_way(
    twists: list[tuple[float, float]], dt: float
) -> None:
    world = Simulator(HALL, IDEAL, start=Pose(10.0, 4.0, 0.0), max_speed=0.7)
    left = right = 0.0
    for linear, angular in twists:
        for _ in range(10):
            before, twist_before = world.pose, world.observe().twist
            seen = world.step(Twist(linear, angular), dt)
            turn = wrap_angle(seen.pose.theta - before.theta)
            assert seen.angular_velocity == pytest.approx(turn / dt, abs=1e-9)
            assert seen.odometry_twist.angular == pytest.approx(turn / dt, abs=1e-9)
            change = seen.twist.linear - twist_before.linear
            assert seen.acceleration == pytest.approx(change / dt, abs=1e-9)
            way = 0.5 * (twist_before.linear + seen.twist.linear) * dt
            assert seen.odometry_twist.linear == pytest.approx(way / dt, abs=1e-9)
            left += (way - 0.5 * TRACK * turn) / WHEEL
            right += (way + 0.5 * TRACK * turn) / WHEEL
            assert seen.wheels.left == pytest.approx(left, abs=1e-9)
            assert seen.wheels.right == pytest.approx(right, abs=1e-9)


def test_wheels_of_a_body_that_is_held_stand_still_unless_they_slip() -> None:
    world = Simulator(room_home(), IDEAL, start=Pose(4.5, 2.0, 0.0))
    drive(world, 0.3, 0.0, 3.0)
    before = world.observe()
    after = drive(world, 0.3, 0.0, 3.0)
    assert after.wheels.left == pytest.approx(before.wheels.left, abs=1e-6)
    noisy = Simulator(room_home(), NOISY, start=Pose(4.5, 2.0, 0.0))
    drive(noisy, 0.3, 0.0, 3.0)
    before = noisy.observe()
    after = drive(noisy, 0.3, 0.0, 3.0)
    assert after.pose.x == pytest.approx(before.pose.x, abs=1e-3)
    assert after.odometry.x > before.odometry.x + 0.005


def loop(
    home: Home, seed: int, config: SimulatedRobotConfig = NOISY
) -> tuple[float, float, Simulator]:
    """Drive 30 m of circles; return how far odometry is off: m and rad."""
    start = Pose(10.0, 4.0, 0.0)
    world = Simulator(home, config, seed=seed, start=start)
    for part in range(6):
        seen = drive(world, 0.4, 0.5 if part % 2 else -0.5, 12.5)
    believed = start.compose(seen.odometry)
    off = believed.distance_to(seen.pose.x, seen.pose.y)
    return off, wrap_angle(believed.theta - seen.pose.theta), world


def test_noisy_odometry_drifts_within_bounds_and_each_robot_in_its_own_way() -> None:
    errors = np.array([loop(HALL, seed)[:2] for seed in range(12)])
    assert (errors[:, 0] > 1e-3).all()
    assert (errors[:, 0] < 2.0).all()
    assert (np.abs(errors[:, 1]) < 2.0).all()
    assert len({tuple(row) for row in errors.tolist()}) == 12
    # Sizes are wrong by 0.1 %: about 30 m * 0.001 * sqrt(2) / 0.235 m = 0.18 rad; and slip.
    assert 0.1 < float(errors[:, 1].std()) < 0.5


def test_slip_varies_the_way_as_much_in_short_steps_as_in_long_ones() -> None:
    spread = []
    for dt in (0.01, 0.1):
        turned = []
        for seed in range(60):
            world = Simulator(HALL, NOISY, seed=seed, start=Pose(4.0, 4.0, 0.0))
            world.advance(Twist(0.4, 0.0), dt, round(10.0 / dt))
            turned.append(world.pose.theta)
        spread.append(float(np.std(turned)))
    # 0.002 m of each wheel over a metre: sqrt(2 * 4 m) * 0.002 / 0.235 m = 0.024 rad over 4 m.
    assert spread == pytest.approx([0.024, 0.024], rel=0.3)


def test_the_imu_is_not_swamped_by_slip_and_a_bump_is_its_most() -> None:
    world = Simulator(room_home(), NOISY, start=Pose(0.5, 2.0, 0.0))
    drive(world, 0.3, 0.0, 1.0)
    seen = [world.step(Twist(0.3, 0.0), DT) for _ in range(200)]
    assert float(np.std([look.acceleration for look in seen])) < 0.1
    assert float(np.std([look.angular_velocity for look in seen])) < 0.03
    bumped = [world.step(Twist(0.5, 0.0), DT).acceleration for _ in range(200)]
    assert min(bumped) >= -NOISY.simulation.gyro.most_acceleration


def test_noisy_sensors_repeat_with_the_seed() -> None:
    first, again, other = (loop(HALL, seed)[2] for seed in (4, 4, 5))
    assert first.digest() == again.digest()
    assert first.numbers["gyro"] != other.numbers["gyro"]
    assert first.numbers["wheel_left_size"] != other.numbers["wheel_left_size"]


def ahead(home: Home, config: SimulatedRobotConfig, seed: int, way: float) -> tuple[float, float]:
    """Drive straight on; return the true way and that of the wheels as they really turned."""
    world = Simulator(home, config, seed=seed, start=Pose(1.0, 4.0, 0.0))
    seen = drive(world, 0.5, 0.0, way / 0.5)
    wheels = 0.5 * (world.numbers["wheel_left"] + world.numbers["wheel_right"]) * WHEEL
    return seen.pose.distance_to(1.0, 4.0), wheels


def test_wheels_slip_more_on_carpet() -> None:
    lost = []
    for home in (HALL, CARPETED):
        ways = [ahead(home, NOISY, seed, 12.0) for seed in range(6)]
        lost.append(float(np.mean([1.0 - true / turned for true, turned in ways])))
    assert lost[0] == pytest.approx(CONFIG.simulation.wheels.slip, abs=0.002)
    assert lost[1] == pytest.approx(CONFIG.simulation.wheels.carpet_slip, abs=0.002)


@pytest.mark.parametrize("dt", [0.01, 0.1])
def test_slip_varies_by_the_way_and_not_by_the_step(dt: float) -> None:
    """The difference of two wheels' random walks, over their distance, is a turn of the body."""
    turns = []
    for seed in range(40):
        world = Simulator(HALL, NOISY, seed=seed, start=Pose(1.0, 4.0, 0.0))
        turns.append(drive(world, 0.5, 0.0, 8.0, dt).pose.theta)
    expected = CONFIG.simulation.wheels.slip_noise * math.sqrt(2.0 * 4.0) / TRACK
    assert float(np.std(turns)) == pytest.approx(expected, rel=0.3)


def test_noisy_encoders_count_in_whole_steps_and_ideal_ones_do_not() -> None:
    step = 2.0 * math.pi / CONFIG.wheels.counts_per_turn
    for config, is_whole in ((NOISY, True), (IDEAL, False)):
        world = Simulator(HALL, config, start=Pose(5.0, 4.0, 0.0))
        wheels = drive(world, 0.31, 0.4, 1.0).wheels
        for counted in (wheels.left / step, wheels.right / step):
            assert (abs(counted - round(counted)) < 1e-6) == is_whole
        assert 0.0 <= world.numbers["wheel_left"] - wheels.left < step


def test_a_noisy_gyro_has_its_scale_bias_and_noise() -> None:
    world = Simulator(HALL, NOISY, seed=3, start=Pose(10.0, 4.0, 0.0))
    drive(world, 0.0, 2.0, 2.0)
    expected = world.numbers["gyro_scale"]
    # On one spot slip makes the true turning vary too: compare to that.
    errors = []
    for _ in range(4000):
        seen = world.step(Twist(0.0, 2.0), DT)
        errors.append(seen.angular_velocity - expected * seen.twist.angular)
    bias = world.numbers["gyro_bias"]
    assert float(np.mean(errors)) == pytest.approx(bias, abs=2e-4)
    assert bias != 0.0
    assert float(np.std(errors)) == pytest.approx(CONFIG.simulation.gyro.noise, rel=0.08)


def test_a_noisy_accelerometer_has_its_noise() -> None:
    world = Simulator(HALL, NOISY, seed=3, start=Pose(10.0, 4.0, 0.0))
    felt = [world.step(Twist(), DT).acceleration for _ in range(2000)]
    assert float(np.mean(felt)) == pytest.approx(0.0, abs=3e-3)
    assert float(np.std(felt)) == pytest.approx(CONFIG.simulation.gyro.acceleration_noise, rel=0.08)


@pytest.mark.parametrize("faults", [(Fault.STALL_LEFT,), (Fault.STALL_LEFT, Fault.STALL_RIGHT)])
def test_the_twist_is_that_of_the_body_and_not_of_wheels_that_are_held(
    faults: tuple[Fault, ...],
) -> None:
    world = Simulator(HALL, start=Pose(10.0, 4.0, 0.0))
    for fault in faults:
        world.inject(fault, 1.0)
    drive(world, 0.3, 0.0, 2.0)
    before = world.pose
    seen = world.step(Twist(0.3, 0.0), DT)
    way = seen.pose.distance_to(before.x, before.y)
    turn = wrap_angle(seen.pose.theta - before.theta)
    assert seen.twist.linear == pytest.approx(way / DT, abs=1e-4)
    assert seen.twist.angular == pytest.approx(turn / DT, abs=1e-9)
