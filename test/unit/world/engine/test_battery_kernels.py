"""Where the battery's energy goes, and for how long it lasts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import EXACT, IDEAL, NOISY, drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.world.engine.state.arrays import Fault
from roomba.world.simulator import Simulator

CONFIG = SimulatedRobotConfig()
CAPACITY = CONFIG.battery.capacity
HOME = room_home()
FREE = Pose(2.5, 1.0, 0.0)
HALL, MIDDLE = room_home(12.0, 12.0), Pose(6.0, 6.0, 0.0)
"""Room for circles of 0.9 m that drift away as wheels slip: some 0.6 m in 3.4 km."""


def hours_until(world: Simulator, twist: Twist, charge: float, dt: float) -> float:
    """Let time pass until the charge, Wh, is reached; return how long it took, h."""
    began, before = world.time, world.numbers["charge"]
    while (world.numbers["charge"] - charge) * (before - charge) > 0.0:
        world.advance(twist, dt, 20)
        assert world.time - began < 20.0 * 3600.0
    return (world.time - began) / 3600.0


@pytest.mark.parametrize(("speed", "hours", "dt"), [(0.0, 4.9, 5.0), (0.306, 3.1, 0.5)])
def test_it_idles_and_drives_as_long_as_create_3(speed: float, hours: float, dt: float) -> None:
    world = Simulator(HALL, EXACT, start=MIDDLE)
    world.set_power(0.0, 0.0)
    took = hours_until(world, Twist(speed, speed / 0.9), 0.0, dt)
    assert world.numbers["hits"] == 0.0
    assert took == pytest.approx(hours, rel=0.01)


def test_it_charges_from_empty_to_full_in_its_time_the_last_tenth_ever_slower() -> None:
    world = Simulator(HOME, EXACT, start=FREE)
    hours_until(world, Twist(), 0.0, 10.0)
    world.put(HOME.station)
    first = hours_until(world, Twist(), 0.9 * CAPACITY, 1.0)
    rest = hours_until(world, Twist(), CAPACITY - 1e-9, 1.0)
    assert first + rest == pytest.approx(CONFIG.simulation.battery.charge_hours, rel=0.01)
    assert rest / first == pytest.approx(0.1 * math.log(5.0) / 0.8 / 0.9, rel=0.05)
    assert world.numbers["charge"] == CAPACITY


drives = st.lists(
    st.tuples(st.floats(-0.5, 0.5), st.floats(-4.0, 4.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0)),
    min_size=1,
    max_size=8,
)


@settings(max_examples=examples(40))
@given(drives, st.sampled_from((0.01, 0.1, 60.0, 900.0)), st.booleans(), st.booleans())
def test_energy_adds_up_and_the_charge_keeps_its_bounds_whatever_is_driven(
    parts: list[tuple[float, float, float, float]], dt: float, from_station: bool, noisy: bool
) -> None:
    start = HOME.station if from_station else FREE
    world = Simulator(HOME, NOISY if noisy else IDEAL, start=start)
    world.inject(Fault.STALL_LEFT, float(noisy))
    for linear, angular, brush, fan in parts:
        world.set_power(brush, fan)
        # In steps of minutes it stands: a way of many metres in one step is felt for for long.
        moves = float(dt <= 0.1)
        for _ in range(8):
            before = world.numbers["charge"]
            seen = world.step(Twist(moves * linear, moves * angular), dt)
            now = world.numbers
            assert 0.0 <= now["charge"] <= CAPACITY
            assert abs(CAPACITY - now["used"] + now["charged"] - now["charge"]) < 1e-9
            power = (before - now["charge"]) * 3600.0 / dt
            assert now["power"] == pytest.approx(power, abs=1e-6 / dt)
            assert seen.battery.level == pytest.approx(now["charge"] / CAPACITY)
        if not moves:
            world.put(HOME.station if linear < 0.0 else FREE)


def power_of(linear: float, angular: float, duty: tuple[float, float] = (0.0, 0.0)) -> float:
    world = Simulator(room_home(20.0, 8.0), EXACT, start=Pose(10.0, 4.0, 0.0))
    world.set_power(*duty)
    drive(world, linear, angular, 3.0)
    return world.numbers["power"]


def test_each_consumer_draws_its_power() -> None:
    battery, idle = CONFIG.simulation.battery, CONFIG.simulation.battery.idle_power
    assert power_of(0.0, 0.0) == pytest.approx(idle)
    driving = idle + battery.drive_power
    assert power_of(0.306, 0.0) == pytest.approx(driving)
    assert power_of(-0.306, 0.0) == pytest.approx(driving)
    # On the spot both wheels turn against each other.
    wheel_speed = 0.5 * CONFIG.body.wheel_separation * 2.0
    turning = idle + battery.drive_power * wheel_speed / battery.drive_speed
    assert power_of(0.0, 2.0) == pytest.approx(turning)
    brush, fan = CONFIG.simulation.brush.power, CONFIG.simulation.fan.power
    assert power_of(0.306, 0.0, (0.5, 0.0)) == pytest.approx(driving + 0.5 * brush)
    assert power_of(0.306, 0.0, (0.0, 0.5)) == pytest.approx(driving + 0.125 * fan)
    assert power_of(0.0, 2.0, (1.0, 1.0)) == pytest.approx(turning + brush + fan)
    # While the wheels stand brush and fan rest.
    assert power_of(0.0, 0.0, (1.0, 1.0)) == pytest.approx(idle)


def test_carpet_makes_the_brush_draw_more() -> None:
    home = room_home(carpets=((0.0, 0.0, 5.0, 4.0),))
    world = Simulator(home, EXACT, start=FREE)
    world.set_power(1.0, 0.0)
    drive(world, 0.306, 0.306, 1.0)
    battery = CONFIG.simulation.battery
    expected = battery.idle_power + battery.drive_power + CONFIG.simulation.brush.carpet_power
    assert world.numbers["power"] == pytest.approx(expected)


def test_an_empty_robot_comes_to_rest_and_drives_again_when_charged() -> None:
    world = Simulator(HOME, EXACT, start=FREE)
    hours_until(world, Twist(), 0.01, 10.0)
    drive(world, 0.3, 0.3, 60.0)
    rest = world.observe()
    assert rest.battery.level == 0.0
    assert rest.battery.current == 0.0
    assert (rest.twist.linear, rest.twist.angular) == (0.0, 0.0)
    assert drive(world, 0.3, 0.3, 1.0).pose == rest.pose
    world.put(HOME.station)
    drive(world, 0.0, 0.0, 60.0)
    assert drive(world, -0.3, 0.0, 1.0).twist.linear == pytest.approx(-0.3, rel=0.02)


def test_the_battery_warms_up_by_its_load_and_cools_down_again() -> None:
    world = Simulator(HALL, EXACT, start=MIDDLE)
    world.set_power(1.0, 1.0)
    circle = 0.306, 0.34, 60.0, 0.5
    temperatures = [drive(world, *circle).battery.temperature for _ in range(30)]
    assert (np.diff(temperatures) > 0.0).all()
    truth = CONFIG.simulation
    driving = truth.battery.idle_power + truth.battery.drive_power
    power = driving + truth.brush.power + truth.fan.power
    most = truth.battery.ambient + truth.battery.heating * power
    share = 1.0 - math.exp(-1800.0 / truth.battery.heating_time)
    expected = truth.battery.ambient + share * (most - truth.battery.ambient)
    assert temperatures[-1] == pytest.approx(expected, abs=0.05)
    world.set_power(0.0, 0.0)
    assert drive(world, 0.0, 0.0, 600.0, 1.0).battery.temperature < temperatures[-1] - 2.0
