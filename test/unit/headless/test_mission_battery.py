"""A robot that cleans charges on the way, and says so where it cannot."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.headless_cleans import assert_all_clean, assert_stands, begun, command
from fixtures.robots.missions import HOME, floor_clean, in_phase, until, wait

from roomba.clean_request import CleanRequest
from roomba.configuration.body import BatteryConfig
from roomba.configuration.mission import EnergyConfig, MissionConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Errand, Event
from roomba.perception.localization.estimate import Knowledge
from roomba.vocabulary import CleanMode, Phase
from roomba.world.engine.state.arrays import Fault


def test_with_a_low_battery_it_goes_home_charges_and_goes_on() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    assert robot.mission.state.errand is Errand.CLEAN
    assert robot.mission.take_result() is None
    swept = floor_clean(robot)
    assert swept < 0.6
    wait(robot, 10.0)
    assert robot.mission.state.phase is Phase.CHARGING
    robot.simulator.set_charge(0.95)
    until(robot, in_phase(robot, Phase.CLEANING), 20.0)
    assert_all_clean(robot, robot.run())


def test_a_power_cut_while_it_charges_for_a_clean_leaves_it_on_its_station() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    robot.simulator.inject(Fault.STATION_DEAD, 1.0)
    assert_stands(robot, 60.0)
    assert robot.mission.state.phase is Phase.CHARGING
    assert "gives no current" in robot.mission.message
    level = robot.seen.battery.level
    robot.simulator.inject(Fault.STATION_DEAD, 0.0)
    wait(robot, 60.0)
    assert robot.mission.state.phase is Phase.CHARGING
    assert robot.mission.message == ""
    assert robot.seen.battery.level > level


def test_a_charge_that_an_emergency_stop_held_up_ends_when_it_is_told_to_go_on() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    command(robot, Event.EMERGENCY, "a child")
    assert_stands(robot)
    command(robot, Event.RELEASE)
    robot.simulator.set_charge(0.95)
    assert_stands(robot, 20.0)
    assert robot.mission.state.phase is Phase.PAUSED
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_while_it_charges_time_passes_in_few_ticks_and_is_recorded() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    since, level, calls = robot.seen.time, robot.seen.battery.level, 0
    robot.rows.clear()
    while robot.seen.time < since + 60.0:
        robot.advance()
        calls += 1
        assert robot.localizer.estimate.knowledge is Knowledge.KNOWN
    assert calls < 70
    assert robot.seen.battery.level > level
    times = np.concatenate(robot.rows)[:, 0]
    assert np.diff(times, prepend=since).max() <= 0.2 + 1e-9
    robot.simulator.set_charge(0.95)
    robot.advance()
    robot.advance()
    assert robot.mission.state.phase is not Phase.CHARGING


def test_it_charges_as_much_as_the_rest_needs() -> None:
    robot = begun(130.0)
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    robot.simulator.set_charge(0.5)
    until(robot, in_phase(robot, Phase.CLEANING), 20.0)
    assert_all_clean(robot, robot.run())


def test_off_its_station_with_little_energy_it_does_not_begin() -> None:
    robot = HeadlessMission(HOME, start=Pose(2.5, 0.6, 1.0))
    robot.simulator.set_charge(0.1)
    robot.tick()
    with pytest.raises(CommandRefusedError, match=r"15%.*10%.*station"):
        robot.mission.clean(CleanRequest(), robot.senses())
    assert robot.mission.state.phase is Phase.IDLE
    assert robot.mission.cleaning is None


def test_an_empty_battery_ends_it() -> None:
    robot = begun()
    robot.simulator.set_charge(0.004)
    result = robot.run().result
    assert result.outcome is CleanOutcome.BATTERY
    assert "battery" in result.message
    assert robot.mission.state.phase is Phase.ERROR
    assert_stands(robot)


def test_with_a_dead_station_it_says_that_it_is_not_docked() -> None:
    robot = begun(request=CleanRequest(CleanMode.SPOT, spot=(1.0, 0.6)), after=10.0)
    robot.simulator.inject(Fault.STATION_DEAD, 1.0)
    result = robot.run().result
    assert result.outcome is CleanOutcome.NOT_DOCKED
    assert result.message
    assert result.message == robot.mission.message
    assert result.fraction >= 0.99
    assert robot.mission.state.phase is Phase.ERROR
    assert_stands(robot)
    # It docks by itself once it sees the beams.
    robot.simulator.inject(Fault.STATION_DEAD, 0.0)
    wait(robot, 3.0)
    assert robot.mission.message == ""
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home


def test_a_clean_that_charges_take_no_further_comes_to_an_end() -> None:
    home = room_home(6.0, 0.8, station=Pose(0.2, 0.4, math.pi))
    robot = HeadlessMission(
        home,
        SimulatedRobotConfig(battery=BatteryConfig(capacity=0.5)),
        MissionConfig(energy=EnergyConfig(reserve=0.89)),
    )
    record = robot.clean(CleanRequest())
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert "what is left is too far from the station" in record.result.message
    assert record.result.covered < 0.5 * record.result.wanted
    assert robot.mission.state.phase is Phase.DOCKED
    # The next one begins to count anew.
    assert robot.clean(CleanRequest()).result.covered > 0.0


def test_with_a_worn_battery_it_comes_home_from_far_away() -> None:
    home = room_home(28.0, 0.8, station=Pose(0.2, 0.4, math.pi))
    robot = HeadlessMission(home, SimulatedRobotConfig(battery=BatteryConfig(capacity=1.0)))
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.CHARGING), 3600.0)
    assert robot.seen.battery.level > 0.02
