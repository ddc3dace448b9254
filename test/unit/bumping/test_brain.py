"""A robot without a lidar in simulated homes: it sweeps, goes home by beams, and is safe."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fixtures.bumping import BumpingHome

from roomba.bumping.brain import BumpingState
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import STANDSTILL, Twist
from roomba.robot.readings import Readings

SWEEPING, DOCKED = BumpingState.SWEEPING, BumpingState.DOCKED


def test_it_sweeps_for_five_minutes_and_docks_when_it_is_told_to() -> None:
    home = BumpingHome("studio", 1)
    assert home.brain.state is DOCKED
    home.brain.clean()
    home.pass_time(300.0)
    assert home.brain.state is SWEEPING
    # Of 21.7 m2; what the wheels say is off by what they slip.
    assert home.swept.swept_area > 6.0
    assert home.brain.floor.coverage.swept_area == pytest.approx(home.swept.swept_area, rel=0.3)
    home.brain.dock()
    home.pass_time(900.0, until=DOCKED)
    assert home.brain.state is DOCKED
    assert home.body.seen.battery.is_docked
    assert home.away < 0.05


def test_with_a_low_battery_it_goes_home_by_itself_and_stays_there() -> None:
    home = BumpingHome("studio", 2)
    home.brain.clean()
    home.pass_time(60.0, until=SWEEPING)
    assert home.brain.state is SWEEPING
    home.body.simulator.set_charge(0.15)
    home.tick()
    assert home.brain.state in (BumpingState.HOMING, BumpingState.DOCKING)
    home.pass_time(900.0, until=DOCKED)
    assert home.brain.state is DOCKED
    home.pass_time(5.0)
    assert home.brain.state is DOCKED
    assert home.body.seen.odometry_twist.linear == 0.0


def test_where_the_floor_ends_it_turns_away() -> None:
    home = BumpingHome("family", 1)
    home.brain.clean()
    home.pass_time(240.0)
    assert home.fell == 0
    assert home.swept.swept_area > 2.0


def test_it_stands_when_it_is_told_to_and_goes_on() -> None:
    home = BumpingHome("studio", 1)
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    home.brain.pause()
    assert home.brain.tick(home.read()).twist == STANDSTILL
    home.brain.resume()
    assert home.brain.state is SWEEPING
    home.brain.stop()
    assert home.brain.state is BumpingState.STANDING
    home.brain.clean()
    home.tick()
    home.brain.hold()
    assert home.brain.tick(home.read()).twist == STANDSTILL
    assert home.brain.steer(Twist(0.2, 0.0), home.read()).twist == STANDSTILL
    home.brain.release()
    assert home.brain.state is BumpingState.PAUSED
    assert home.brain.tick(home.read()).twist == STANDSTILL
    assert home.brain.steer(Twist(0.2, 0.0), home.read()).twist == Twist(0.2, 0.0)
    home.brain.resume()
    assert home.brain.state is SWEEPING


def test_what_is_paused_or_held_by_the_emergency_stop_is_ended_by_stop() -> None:
    home = BumpingHome("studio", 1)
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    home.brain.pause()
    home.brain.hold()
    home.brain.hold()
    home.brain.resume()
    assert home.brain.state is BumpingState.EMERGENCY
    home.brain.release()
    assert home.brain.state is BumpingState.PAUSED
    home.brain.stop()
    assert home.brain.state is BumpingState.STANDING
    home.brain.clean()
    home.brain.hold()
    home.brain.stop()
    assert home.brain.state is BumpingState.EMERGENCY
    home.brain.release()
    assert home.brain.state is BumpingState.STANDING
    # A clean before says nothing of a robot that stood when it was held.
    home.brain.hold()
    home.brain.release()
    home.brain.resume()
    assert home.brain.state is BumpingState.STANDING


def docked(home: BumpingHome) -> Readings:
    """What it senses on its station, wherever it is: it was carried there."""
    told = home.read()
    return replace(told, battery=replace(told.battery, is_docked=True))


@pytest.mark.parametrize("is_held", [False, True])
def test_carried_onto_its_station_it_backs_out_before_it_sweeps_on(*, is_held: bool) -> None:
    home = BumpingHome("studio", 1)
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    if is_held:
        home.brain.hold()
        home.brain.tick(docked(home))
        home.brain.release()
    else:
        home.brain.pause()
    home.brain.tick(docked(home))
    assert home.brain.state is BumpingState.PAUSED
    home.brain.resume()
    assert home.brain.state is BumpingState.LEAVING
    assert home.brain.tick(docked(home)).twist.linear < 0.0


def test_a_way_home_that_is_held_up_is_done_once_it_stands_on_its_station() -> None:
    home = BumpingHome("studio", 1)
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    home.brain.dock()
    home.brain.hold()
    home.brain.tick(docked(home))
    assert home.brain.state is BumpingState.EMERGENCY
    home.brain.release()
    home.brain.tick(docked(home))
    assert home.brain.state is DOCKED


def test_lifted_it_stands_and_what_it_steers_at_a_cliff_is_back() -> None:
    home = BumpingHome("studio", 1)
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    told = home.read()
    lifted = replace(told, dropped_left=True, dropped_right=True)
    assert home.brain.tick(lifted).twist == STANDSTILL
    cliff = replace(told, cliff=replace(told.cliff, front_left=True))
    assert home.brain.tick(cliff).twist.linear < 0.0


def test_held_at_one_place_it_asks_for_help() -> None:
    home = BumpingHome("studio", 1, BumpingConfig(most_touches=3))
    home.brain.clean()
    home.pass_time(30.0, until=SWEEPING)
    told = home.read()
    for tick in range(1200):
        pressed = replace(told, time=told.time + 0.05 * tick, bumper_left=True, bumper_right=True)
        home.brain.tick(pressed)
    assert home.brain.state is BumpingState.HELD
    home.brain.resume()
    assert home.brain.state is SWEEPING
