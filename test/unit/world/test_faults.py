"""Each fault does what it says, and ends when it is taken back; senseless values are refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, EXACT, IDEAL, drive

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.world.engine.state.arrays import ROBOT, Fault, Infrared
from roomba.world.simulator import Simulator

CONFIG = EXACT
TRACK = CONFIG.body.wheel_separation
WHEEL = 0.5 * CONFIG.body.wheel_diameter


def robot(config: SimulatedRobotConfig = CONFIG) -> Simulator:
    return Simulator(room_home(), config, start=Pose(1.0, 2.0, 0.0))


@pytest.mark.parametrize("fault", Fault)
def test_every_fault_is_a_number_of_the_robot_and_is_0_at_first(fault: Fault) -> None:
    assert fault.value in (ROBOT.names or ())
    world = robot()
    assert world.numbers[fault.value] == 0.0
    world.inject(fault, 0.5)
    assert world.numbers[fault.value] == 0.5


@pytest.mark.parametrize("fault", Fault)
@pytest.mark.parametrize("value", [-0.01, 1.01, math.nan, math.inf])
def test_values_that_make_no_sense_are_refused(fault: Fault, value: float) -> None:
    world = robot()
    before = world.digest()
    with pytest.raises(ValueError, match=f"{fault.name.lower()}: expected a value from 0 to 1"):
        world.inject(fault, value)
    assert world.digest() == before


@pytest.mark.parametrize(
    ("fault", "side"), [(Fault.SLIP_LEFT, 1), (Fault.SLIP_RIGHT, -1)]
)  # fmt: skip
def test_a_wheel_that_slips_turns_the_body_to_its_side(fault: Fault, side: int) -> None:
    world = robot(IDEAL)
    world.inject(fault, 0.3)
    seen = drive(world, 0.2, 0.0, 2.0)
    rolled = seen.wheels.left * WHEEL
    assert seen.wheels.left == pytest.approx(seen.wheels.right)
    assert seen.pose.theta == pytest.approx(side * 0.3 * rolled / TRACK)
    assert world.numbers["distance"] == pytest.approx(0.85 * rolled)
    assert seen.odometry.theta == 0.0
    assert seen.angular_velocity == pytest.approx(side * 0.3 * 0.2 / TRACK)


@pytest.mark.parametrize(
    ("fault", "side"), [(Fault.STALL_LEFT, 1), (Fault.STALL_RIGHT, -1)]
)  # fmt: skip
def test_a_wheel_that_is_held_stands_still_and_draws_more(fault: Fault, side: int) -> None:
    world, sound = robot(IDEAL), robot(IDEAL)
    world.inject(fault, 1.0)
    seen, expected = drive(world, 0.1, 0.0, 1.0), drive(sound, 0.1, 0.0, 1.0)
    wheels = seen.wheels
    held, free = (wheels.left, wheels.right)[::side]
    assert held == 0.0
    assert free == pytest.approx(expected.wheels.left)
    assert (wheels.stalled_left, wheels.stalled_right)[::side] == (True, False)
    assert seen.pose.theta == pytest.approx(side * free * WHEEL / TRACK)
    more = world.numbers["power"] - sound.numbers["power"]
    assert more == pytest.approx(CONFIG.simulation.battery.stall_power)
    standing = drive(world, 0.0, 0.0, 1.0)
    assert not standing.wheels.stalled_left
    assert not standing.wheels.stalled_right


def test_a_robot_that_is_lifted_stays_where_it_is_and_feels_no_floor() -> None:
    world = robot()
    world.spill(1.0, 2.0, 0.3, 10.0)
    world.inject(Fault.LIFTED, 1.0)
    before = world.pose
    seen = drive(world, 0.3, 1.0, 2.0)
    assert seen.pose == before
    assert (seen.twist.linear, seen.twist.angular) == (0.0, 0.0)
    assert seen.angular_velocity == pytest.approx(0.0, abs=8.0 * CONFIG.simulation.gyro.noise)
    assert seen.wheels.dropped_left
    assert seen.wheels.dropped_right
    assert seen.cliff == type(seen.cliff)(True, True, True, True)
    assert seen.wheels.right > 1.0
    assert world.in_bin == 0
    world.inject(Fault.LIFTED, 0.0)
    drive(world, 0.0, 0.0, 1.0)
    seen = drive(world, 0.3, 0.0, 1.0)
    assert seen.pose.x > before.x + 0.1
    assert not seen.cliff.any
    assert not seen.wheels.dropped_left


def test_who_is_lifted_off_the_station_charges_no_more() -> None:
    world = Simulator(room_home())
    assert world.step(Twist(), DT).battery.is_docked
    world.inject(Fault.LIFTED, 1.0)
    assert not world.step(Twist(), DT).battery.is_docked


def test_a_blocked_lidar_sees_nothing_and_goes_on_counting() -> None:
    world = robot()
    drive(world, 0.0, 0.0, 1.0)
    assert np.isfinite(world.ranges).mean() > 0.9
    world.inject(Fault.LIDAR_BLOCKED, 1.0)
    before = world.observe().scans
    after = drive(world, 0.0, 0.0, 1.0)
    assert (world.ranges == np.inf).all()
    assert after.scans == pytest.approx(before + 10, abs=1)
    world.inject(Fault.LIDAR_BLOCKED, 0.0)
    drive(world, 0.0, 0.0, 0.2)
    assert np.isfinite(world.ranges).mean() > 0.9


def test_a_bumper_that_sticks_is_pressed_until_it_sticks_no_more() -> None:
    world = robot()
    world.inject(Fault.BUMPER_STUCK, 1.0)
    seen = drive(world, 0.2, 0.0, 1.0)
    assert seen.bumper.left
    assert seen.bumper.right
    assert seen.pose.x > 1.1
    world.inject(Fault.BUMPER_STUCK, 0.0)
    assert not world.step(Twist(), DT).bumper.pressed


def test_dirty_cliff_sensors_see_no_floor_but_wheels_do_not_drop() -> None:
    for stairs in ((), ((4.0, 0.0, 5.0, 4.0),)):
        world = Simulator(room_home(stairs=stairs), start=Pose(1.0, 2.0, 0.0))
        world.inject(Fault.CLIFF_DIRTY, 1.0)
        seen = world.step(Twist(), DT)
        assert seen.cliff == type(seen.cliff)(True, True, True, True)
        assert not seen.wheels.dropped_left
        world.inject(Fault.CLIFF_DIRTY, 0.0)
        assert not world.step(Twist(), DT).cliff.any


def test_a_blind_infrared_receiver_sees_no_station_but_contacts_touch() -> None:
    world = Simulator(room_home())
    world.inject(Fault.INFRARED_BLOCKED, 1.0)
    seen = world.step(Twist(), DT)
    assert seen.infrared == Infrared(0)
    assert seen.battery.is_docked


def test_a_blind_dirt_sensor_counts_nothing_of_what_comes_in() -> None:
    world = robot()
    world.spill(2.0, 2.0, 0.3, 10.0)
    world.inject(Fault.DIRT_SENSOR_BLOCKED, 1.0)
    assert max(world.step(Twist(0.3, 0.0), DT).grains for _ in range(150)) == 0.0
    assert world.in_bin > 0


@pytest.mark.parametrize(
    "pose",
    [
        Pose(0.1, 2.0, 0.0),
        Pose(2.25, 1.5, 0.0),
        Pose(-7.0, 2.0, 0.0),
        Pose(1e9, 0.0, 0.0),
        Pose(4.0, 3.0, 1.0),
        Pose(math.nan, 2.0, 0.0),
        Pose(1.0, math.inf, 0.0),
        Pose(1.0, 2.0, math.nan),
    ],
)
def test_put_where_it_does_not_fit_is_refused_and_leaves_all_as_it_was(pose: Pose) -> None:
    world = Simulator(room_home(blocks=((2.0, 1.0, 2.5, 2.0),)), start=Pose(1.0, 2.0, 0.0))
    world.place_obstacle(4.0, 3.0, 0.1)
    drive(world, 0.3, 0.2, 1.0)
    before = world.digest()
    with pytest.raises(HomeError, match="the robot does not fit at"):
        world.put(pose)
    assert world.digest() == before


def test_put_stands_it_there_and_it_believes_what_it_believed() -> None:
    world = robot()
    before = drive(world, 0.3, 0.2, 1.0)
    world.put(Pose(4.0, 1.0, 2.0))
    after = world.observe()
    assert after.pose == Pose(4.0, 1.0, 2.0)
    assert (after.twist.linear, after.twist.angular) == (0.0, 0.0)
    assert after.odometry == before.odometry
    assert after.wheels == before.wheels
    assert world.step(Twist(), DT).pose == Pose(4.0, 1.0, 2.0)
