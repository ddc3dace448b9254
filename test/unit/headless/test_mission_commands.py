"""A robot that cleans is paused, stopped, sent home, lifted, carried; the emergency stop holds."""

from __future__ import annotations

import math

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL
from fixtures.robots.headless_cleans import assert_all_clean, assert_stands, begun, command
from fixtures.robots.missions import (
    FLOOR_TOO_LITTLE,
    HOME,
    STATION,
    TWO_ROOMS,
    floor_clean,
    in_phase,
    until,
    wait,
)

from roomba.clean_request import CleanRequest
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Event
from roomba.mission.transitions import RELEASED
from roomba.perception.localization.estimate import Knowledge
from roomba.vocabulary import CleanMode, Phase
from roomba.world.engine.state.arrays import Fault


def test_paused_it_stands_and_resumed_it_goes_on() -> None:
    robot = begun()
    command(robot, Event.PAUSE)
    assert_stands(robot)
    assert robot.mission.take_result() is None
    with pytest.raises(CommandRefusedError, match="paused"):
        command(robot, Event.PAUSE)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


@pytest.mark.parametrize("phase", [Phase.UNDOCKING, Phase.RETURNING, Phase.DOCKING])
def test_it_may_be_paused_in_each_phase(phase: Phase) -> None:
    robot = HeadlessMission(HOME)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, phase))
    for _ in range(12):
        robot.tick()
    command(robot, Event.PAUSE)
    assert_stands(robot)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_stopped_it_stands_and_tells_what_is_left() -> None:
    robot = begun()
    command(robot, Event.STOP)
    result = robot.run().result
    assert result.outcome is CleanOutcome.STOPPED
    assert "stop" in result.message
    assert 0.05 < result.fraction < 0.6
    assert {missed.reason for missed in result.missed} == {MissReason.STOPPED}
    left = result.wanted - result.covered
    assert sum(missed.area for missed in result.missed) == pytest.approx(left, abs=0.1)
    assert robot.mission.state.phase is Phase.IDLE
    assert_stands(robot)
    assert robot.mission.take_result() is None
    # It can be told to clean again, and begins anew.
    robot.truth.cells[:] = 1
    assert_all_clean(robot, robot.clean())


def test_told_to_dock_it_goes_home_at_once() -> None:
    robot = begun()
    command(robot, Event.DOCK)
    assert robot.run().result.outcome is CleanOutcome.STOPPED
    until(robot, lambda: robot.is_home, 60.0)
    assert robot.seen.battery.is_docked
    assert robot.mission.take_result() is None


def test_told_to_undock_it_stands_before_its_station() -> None:
    robot = HeadlessMission(HOME)
    command(robot, Event.UNDOCK)
    until(robot, in_phase(robot, Phase.IDLE), 20.0)
    assert 0.25 < robot.simulator.pose.distance_to(STATION.x, STATION.y) < 0.5
    assert robot.mission.take_result() is None


def test_a_newer_clean_takes_over() -> None:
    robot = begun()
    robot.mission.clean(CleanRequest(CleanMode.SPOT, spot=(1.0, 0.6)), robot.senses())
    old = robot.mission.take_result()
    assert old is not None
    assert (old.outcome, old.message) == (CleanOutcome.STOPPED, "a newer clean took over")
    new = robot.run().result
    assert new.outcome is CleanOutcome.COMPLETED
    assert new.wanted < 0.7 * old.wanted
    assert new.duration < robot.seen.time - 35.0


def test_lifted_it_stops_and_set_down_and_resumed_it_goes_on() -> None:
    robot = begun()
    robot.simulator.inject(Fault.LIFTED, 1.0)
    result = robot.run().result
    assert result.outcome is CleanOutcome.FAULT
    assert "wheel" in result.message
    assert robot.mission.state.phase is Phase.ERROR
    wait(robot, 3.0)
    with pytest.raises(CommandRefusedError, match="wheel"):
        command(robot, Event.PAUSE)
    robot.simulator.inject(Fault.LIFTED, 0.0)
    wait(robot, 1.0)
    assert robot.mission.state.phase is Phase.ERROR
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_resumed_in_the_air_it_stops_again() -> None:
    robot = begun()
    robot.simulator.inject(Fault.LIFTED, 1.0)
    robot.run()
    command(robot, Event.RESUME)
    assert robot.run().result.outcome is CleanOutcome.FAULT


def test_carried_elsewhere_where_it_stands_for_long_it_looks_around_when_told_to_clean() -> None:
    """Two alcoves look alike from where it was set down."""
    alcoves = ((0.0, 3.0, 1.1, 3.1), (1.9, 3.0, 4.2, 3.1), (5.0, 3.0, 7.6, 3.1))
    walls = ((3.0, 0.0, 3.1, 3.0), (6.1, 0.0, 7.6, 3.0), (1.2, 0.0, 1.3, 1.3), (4.3, 0.0, 4.4, 1.3))
    home = room_home(
        7.6, 4.5, (*alcoves, *walls, (5.2, 0.0, 6.0, 0.9)), station=Pose(0.2, 3.8, math.pi)
    )
    robot = HeadlessMission(home, seed=3)
    for _ in range(40):
        robot.tick()
    robot.simulator.inject(Fault.LIFTED, 1.0)
    for _ in range(60):
        robot.tick()
    robot.simulator.put(Pose(3.6, 0.5, 1.0))
    robot.simulator.inject(Fault.LIFTED, 0.0)
    for _ in range(1200):
        robot.tick()
    assert robot.brain.localizer is not None
    assert robot.brain.localizer.estimate.knowledge is Knowledge.LOST
    robot.mission.clean(CleanRequest(CleanMode.SPOT), robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING), 30.0)
    assert robot.brain.localizer.estimate.knowledge is Knowledge.KNOWN
    assert robot.brain.pose.distance_to(robot.seen.pose.x, robot.seen.pose.y) < 0.05


def test_carried_elsewhere_it_finds_its_place_and_goes_on() -> None:
    robot = HeadlessMission(TWO_ROOMS)
    begun(30.0, robot)
    robot.simulator.inject(Fault.LIFTED, 1.0)
    robot.run()
    robot.simulator.put(Pose(3.0, 0.5, 2.0))
    wait(robot, 1.0)
    robot.simulator.inject(Fault.LIFTED, 0.0)
    wait(robot, 1.0)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_the_emergency_stop_holds_until_it_is_released_and_the_clean_goes_on_when_told() -> None:
    robot = begun()
    command(robot, Event.EMERGENCY, "a hand in the brush")
    assert_stands(robot)
    for event in (Event.DOCK, Event.UNDOCK, Event.PAUSE, Event.RESUME):
        with pytest.raises(
            CommandRefusedError, match=r"held by the emergency stop \(a hand in the brush\)"
        ):
            command(robot, event)
    with pytest.raises(CommandRefusedError, match="emergency stop"):
        robot.mission.clean(CleanRequest(), robot.senses())
    assert_stands(robot, 2.0)
    command(robot, Event.RELEASE)
    assert robot.mission.state.phase is Phase.PAUSED
    assert robot.mission.reason == RELEASED
    assert_stands(robot, 20.0)
    assert robot.mission.take_result() is None
    command(robot, Event.RESUME)
    assert robot.mission.message == ""
    assert_all_clean(robot, robot.run())


def test_what_was_swept_before_an_emergency_stop_is_not_swept_again() -> None:
    whole = HeadlessMission(HOME, IDEAL).clean().distance
    robot = begun(130.0, HeadlessMission(HOME, IDEAL))
    assert floor_clean(robot) > 0.4
    driven = robot.simulator.numbers["distance"]
    command(robot, Event.EMERGENCY, "a cat")
    wait(robot, 5.0)
    command(robot, Event.RELEASE)
    command(robot, Event.RESUME)
    assert robot.run().result.outcome is CleanOutcome.COMPLETED
    assert floor_clean(robot) >= FLOOR_TOO_LITTLE
    assert robot.simulator.numbers["distance"] - driven < 0.75 * whole


@pytest.mark.parametrize("is_released", [False, True])
def test_a_clean_that_an_emergency_stop_interrupted_is_ended_by_stop(is_released: bool) -> None:
    robot = begun()
    command(robot, Event.EMERGENCY, "a child")
    wait(robot, 2.0)
    if is_released:
        command(robot, Event.RELEASE)
    command(robot, Event.STOP)
    result = robot.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.STOPPED
    assert robot.mission.cleaning is None
    if not is_released:
        assert (robot.mission.state.phase, robot.mission.message) == (Phase.EMERGENCY, "a child")
        command(robot, Event.RELEASE)
    assert robot.mission.state.phase is Phase.IDLE
    assert_stands(robot)
    assert_all_clean(robot, robot.clean())


@pytest.mark.parametrize(
    "phase",
    [Phase.UNDOCKING, Phase.CLEANING, Phase.RETURNING, Phase.DOCKING],
)
def test_each_phase_goes_on_after_an_emergency_stop(phase: Phase) -> None:
    robot = HeadlessMission(HOME)
    request = CleanRequest(CleanMode.SPOT, spot=(2.0, 0.6))
    robot.mission.clean(request, robot.senses())
    until(robot, in_phase(robot, phase))
    for _ in range(20):
        robot.tick()
    command(robot, Event.EMERGENCY, "a child")
    assert_stands(robot)
    command(robot, Event.RELEASE)
    assert_stands(robot)
    command(robot, Event.RESUME)
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.fraction >= 0.99
    assert robot.is_home


def test_a_robot_that_was_held_and_carried_home_is_done_if_its_floor_was() -> None:
    robot = HeadlessMission(HOME)
    robot.mission.clean(CleanRequest(CleanMode.SPOT, spot=(2.0, 0.6)), robot.senses())
    until(robot, in_phase(robot, Phase.RETURNING))
    command(robot, Event.EMERGENCY, "a child")
    robot.simulator.put(STATION)
    wait(robot, 2.0)
    assert robot.mission.state.phase is Phase.EMERGENCY
    command(robot, Event.RELEASE)
    result = robot.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home


@pytest.mark.parametrize("event", [Event.DOCK, Event.UNDOCK])
def test_a_way_to_the_station_or_off_it_is_given_up_by_an_emergency_stop(event: Event) -> None:
    robot = HeadlessMission(HOME)
    if event is Event.DOCK:
        robot = begun()
    command(robot, event)
    wait(robot, 0.5)
    command(robot, Event.EMERGENCY, "a child")
    wait(robot, 1.0)
    command(robot, Event.RELEASE)
    assert robot.mission.state.phase in (Phase.IDLE, Phase.DOCKED)
    assert_stands(robot)
    with pytest.raises(CommandRefusedError, match="cannot resume now"):
        command(robot, Event.RESUME)


def test_released_on_its_station_it_is_docked() -> None:
    robot = HeadlessMission(HOME)
    robot.tick()
    command(robot, Event.EMERGENCY)
    robot.tick()
    assert not robot.is_home
    command(robot, Event.RELEASE)
    assert robot.is_home
