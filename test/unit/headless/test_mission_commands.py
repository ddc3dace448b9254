"""A robot that cleans is paused, stopped, sent home, lifted, carried; the emergency stop holds."""

from __future__ import annotations

import pytest
from fixtures.robots.headless_cleans import assert_all_clean, assert_stands, begun, command
from fixtures.robots.missions import HOME, STATION, TWO_ROOMS, in_phase, until, wait

from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.request import (
    CleanOutcome,
    CleanRequest,
    MissReason,
)
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Event
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


def test_the_emergency_stop_holds_until_it_is_released() -> None:
    robot = begun()
    command(robot, Event.EMERGENCY, "a hand in the brush")
    result = robot.run().result
    assert result.outcome is CleanOutcome.FAULT
    assert "a hand in the brush" in result.message
    assert_stands(robot)
    for event in (Event.DOCK, Event.UNDOCK, Event.PAUSE, Event.RESUME, Event.STOP):
        with pytest.raises(CommandRefusedError, match=r"emergency stop.*a hand in the brush"):
            command(robot, event)
    with pytest.raises(CommandRefusedError, match="emergency stop"):
        robot.mission.clean(CleanRequest(), robot.senses())
    assert_stands(robot, 2.0)
    command(robot, Event.RELEASE)
    assert robot.mission.state.phase is Phase.IDLE
    assert_stands(robot, 2.0)
    robot.truth.cells[:] = 1
    assert_all_clean(robot, robot.clean())


def test_released_on_its_station_it_is_docked() -> None:
    robot = HeadlessMission(HOME)
    robot.tick()
    command(robot, Event.EMERGENCY)
    robot.tick()
    assert not robot.is_home
    command(robot, Event.RELEASE)
    assert robot.is_home
