"""Voltage, current and noise."""

from __future__ import annotations

import itertools

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import drive
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.body import BatteryConfig
from roomba.configuration.simulation import SimulationConfig
from roomba.geometry import Pose
from roomba.world.power import BatteryState, battery_state, noise_level, open_circuit_voltage
from roomba.world.simulator import Simulator

CONFIG = BatteryConfig()
CELLS = CONFIG.cells


def state(level: float, power: float, resistance: float = 0.15) -> BatteryState:
    return battery_state(
        CONFIG.capacity,
        resistance,
        CELLS,
        charge=level * CONFIG.capacity,
        power=power,
        temperature=22.0,
        is_docked=False,
    )


@given(st.floats(0.0, 1.0), st.floats(-40.0, 60.0), st.sampled_from((0.0, 0.15, 0.5)))
def test_power_is_voltage_times_current_and_the_resistance_takes_its_part(
    level: float, power: float, resistance: float
) -> None:
    battery = state(level, power, resistance)
    assert battery.voltage * -battery.current == pytest.approx(power, abs=1e-9)
    rest = open_circuit_voltage(battery.level, CELLS)
    assert battery.voltage == pytest.approx(rest + resistance * battery.current)
    assert battery.is_charging == (battery.current > 0.0)
    assert power == 0.0 or (battery.current < 0.0) == (power > 0.0) or abs(power) < 1e-12


@given(st.floats(0.0, 1.0), st.floats(0.0, 0.999))
def test_the_voltage_rises_with_the_charge_and_falls_with_the_load(
    level: float, share: float
) -> None:
    assert open_circuit_voltage(level * share, CELLS) <= open_circuit_voltage(level, CELLS)
    assert state(level, 20.0).voltage < state(level, 5.0).voltage < state(level, 0.0).voltage
    assert state(level, -20.0).voltage > state(level, 0.0).voltage


def test_an_empty_and_a_full_cell_have_the_usual_voltages() -> None:
    assert open_circuit_voltage(0.0, CELLS) == pytest.approx(3.0 * CELLS)
    assert open_circuit_voltage(0.5, CELLS) == pytest.approx(3.7 * CELLS, rel=0.01)
    assert open_circuit_voltage(1.0, CELLS) == pytest.approx(4.2 * CELLS)
    mean = sum(open_circuit_voltage(level / 100.0, CELLS) for level in range(101)) / 101.0
    assert mean == pytest.approx(CONFIG.nominal_voltage, rel=0.05)


def test_more_than_a_battery_can_give_is_not_given() -> None:
    battery = state(0.5, 1e6)
    assert battery.voltage == pytest.approx(0.5 * open_circuit_voltage(0.5, CELLS))
    assert battery.current < 0.0


def test_a_level_is_never_above_one() -> None:
    assert state(1.0 + 1e-12, 0.0).level == 1.0
    assert state(1.0, 0.0).is_full
    assert not state(0.999, 0.0).is_full


def test_it_is_louder_the_more_brush_and_fan_do() -> None:
    truth = SimulationConfig()
    fan = truth.fan
    duties = (0.0, 0.1, 0.5, 1.0)
    for low, high in itertools.pairwise(duties):
        for other in duties:
            at = [noise_level(truth, duty) for duty in ((low, other), (high, other))]
            assert at[0] < at[1]
            at = [noise_level(truth, duty) for duty in ((other, low), (other, high))]
            assert at[0] < at[1]
    assert noise_level(truth, (0.0, 0.0)) == pytest.approx(45.0)
    assert noise_level(truth, (0.0, 1.0)) == pytest.approx(fan.noise_level, abs=0.1)
    # Fan laws: half the speed is 15 dB less.
    assert noise_level(truth, (0.0, 0.5)) == pytest.approx(fan.noise_level - 15.05, abs=0.7)


def test_the_robot_is_louder_while_it_works_than_while_it_stands() -> None:
    world = Simulator(room_home(), start=Pose(1.0, 2.0, 0.0))
    world.set_power(0.5, 1.0)
    standing = world.noise_level
    drive(world, 0.3, 0.0, 1.0)
    assert world.noise_level == noise_level(SimulationConfig(), (0.5, 1.0))
    assert world.noise_level > standing + 10.0
    drive(world, 0.0, 0.0, 1.0)
    assert world.noise_level == standing
