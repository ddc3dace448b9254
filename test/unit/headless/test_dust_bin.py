"""Cleans with a dust bin that fills: what the robot reports, and the truth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import NOISY
from fixtures.robots.headless_cleans import assert_stands, command
from fixtures.robots.missions import FLOOR_TOO_LITTLE, STATION, TABLE, floor_clean, in_phase, until

from roomba.clean_request import CleanRequest
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Event
from roomba.mission.transitions import BIN_FULL, RELEASED
from roomba.robot.readings import Readings
from roomba.vocabulary import Hindrance, Phase
from roomba.world.home.home import DirtSource

DUST = DirtSource("dust", 1.5, 1.25, 2.2, 4.0, 0.0)
HOME = room_home(3.0, 2.5, (TABLE,), station=STATION, sources=(DUST,))
"""One room with dust everywhere."""
FEW_GRAMS = 1.0
"""What the small bin takes."""


def with_bin(grams: float) -> SimulatedRobotConfig:
    brush = NOISY.brush.model_copy(update={"bin_capacity": grams})
    return NOISY.model_copy(update={"brush": brush})


class Unmeasured(HeadlessMission):
    """Its bin has no level sensor."""

    def readings(self) -> Readings:
        return replace(super().readings(), in_bin=0.0)


def test_a_full_bin_is_emptied_and_the_rest_is_cleaned() -> None:
    plain = HeadlessMission(HOME, NOISY, seed=1).clean()
    robot = HeadlessMission(HOME, with_bin(FEW_GRAMS), seed=1)
    record = robot.clean()
    result = record.result
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert robot.is_home
    assert len(robot.emptied) >= 2
    assert min(robot.emptied) >= 0.97 * FEW_GRAMS
    # What it tells is what was really picked up.
    really = sum(robot.emptied) + robot.seen.in_bin
    assert result.dirt == pytest.approx(really, rel=1e-6)
    assert result.dirt == pytest.approx(plain.result.dirt, rel=0.1)
    assert floor_clean(robot) >= FLOOR_TOO_LITTLE
    ways_home = len(robot.emptied) * 6.0
    assert result.distance < 1.15 * plain.result.distance + ways_home


def test_what_is_told_as_clean_was_swept_with_room_in_the_bin() -> None:
    robot = HeadlessMission(HOME, with_bin(FEW_GRAMS), seed=2, empties_bin_after=1e6)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.BIN_FULL), 1200.0)
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    told = cleaning.ledger.coverage.swept & cleaning.ledger.coverage.wanted
    assert 0.05 < cleaning.ledger.coverage.fraction < 0.95
    assert np.count_nonzero(told & ~robot.truth.swept) < 0.01 * np.count_nonzero(told)
    robot.simulator.empty_bin()
    robot.look()
    until(robot, in_phase(robot, Phase.CLEANING), 60.0)


@pytest.mark.thorough
def test_it_is_the_same_with_and_without_bursts() -> None:
    runs = []
    for longest in (0, 100):
        robot = HeadlessMission(HOME, with_bin(FEW_GRAMS), seed=3, longest_burst=longest)
        record = robot.clean()
        told = round(record.result.dirt, 6), record.result.covered, record.result.missed
        runs.append((told, robot.seen.pose, robot.seen.time, robot.emptied))
    assert runs[0] == runs[1]


def test_without_a_level_sensor_the_grains_tell_and_what_was_swept_in_vain_is_swept_again() -> None:
    robot = Unmeasured(HOME, with_bin(1.9), seed=1, longest_burst=0)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.BIN_FULL), 1200.0)
    assert robot.seen.in_bin == pytest.approx(1.9, rel=1e-3)
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    told = cleaning.ledger.coverage.swept & cleaning.ledger.coverage.wanted
    assert np.count_nonzero(told & ~robot.truth.swept) < 0.02 * np.count_nonzero(told)


def test_a_full_bin_is_told_after_an_emergency_stop_and_it_does_not_drive_out_with_it() -> None:
    robot = HeadlessMission(HOME, with_bin(FEW_GRAMS), seed=1, empties_bin_after=1e6)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.BIN_FULL), 1200.0)
    command(robot, Event.EMERGENCY, "a child")
    assert_stands(robot)
    command(robot, Event.RELEASE)
    assert robot.mission.state.phase is Phase.PAUSED
    assert robot.mission.message == f"{BIN_FULL.text}; {RELEASED.text}"
    assert robot.mission.reason.hindrance is Hindrance.BIN_FULL
    command(robot, Event.RESUME)
    until(robot, in_phase(robot, Phase.BIN_FULL), 1.0)
    assert robot.seen.battery.is_docked
    command(robot, Event.EMERGENCY, "a child")
    command(robot, Event.RELEASE)
    robot.simulator.empty_bin()
    robot.look()
    robot.mission.command(Event.EMPTIED, robot.senses())
    assert robot.mission.reason == RELEASED
    command(robot, Event.RESUME)
    until(robot, in_phase(robot, Phase.CLEANING), 60.0)


def at_emptying_station(grams: float) -> HeadlessMission:
    config = with_bin(grams)
    station = config.station.model_copy(update={"empties": True})
    return HeadlessMission(HOME, config.model_copy(update={"station": station}), seed=1)


def test_a_station_empties_a_full_bin_and_the_clean_goes_on_by_itself() -> None:
    robot = at_emptying_station(FEW_GRAMS)
    robot.mission.clean(CleanRequest(), robot.senses())
    told = NOISY.simulation.station
    until(robot, in_phase(robot, Phase.EMPTYING), 1200.0)
    began = robot.seen.time
    until(robot, lambda: robot.simulator.noise_level == told.emptying_noise, 1.0)
    until(robot, in_phase(robot, Phase.CHARGING), 60.0)
    lasted = robot.seen.time - began
    assert lasted == pytest.approx(told.emptying_time, abs=0.2)
    assert robot.simulator.noise_level < told.emptying_noise
    assert robot.seen.in_bin == 0.0
    result = robot.run().result
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert not robot.emptied
    station = robot.simulator.emptying
    assert station is not None
    assert result.dirt == pytest.approx(station.in_bag + robot.seen.in_bin, rel=1e-6)


def test_a_station_empties_a_bin_after_an_emergency_stop() -> None:
    robot = at_emptying_station(FEW_GRAMS)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.EMPTYING), 1200.0)
    command(robot, Event.EMERGENCY, "a child")
    assert_stands(robot)
    command(robot, Event.RELEASE)
    command(robot, Event.RESUME)
    result = robot.run().result
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert not robot.emptied


def test_a_full_bag_is_told_and_an_empty_one_helps() -> None:
    robot = at_emptying_station(FEW_GRAMS)
    robot.is_emptied_at_station = False
    station = robot.simulator.emptying
    assert station is not None
    station.in_bag = 1e6
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.BIN_FULL), 1200.0)
    with pytest.raises(CommandRefusedError, match="bag of its station is full"):
        robot.mission.command(Event.EMPTY, robot.senses())
    station.replace_bag()
    robot.tick()
    robot.mission.command(Event.EMPTY, robot.senses())
    until(robot, in_phase(robot, Phase.CHARGING), 60.0)
    assert station.in_bag == pytest.approx(FEW_GRAMS, rel=0.05)


def test_a_station_without_that_empties_no_bin_and_says_so() -> None:
    robot = HeadlessMission(HOME, NOISY, seed=1)
    until(robot, in_phase(robot, Phase.DOCKED), 5.0)
    with pytest.raises(CommandRefusedError, match="empty it by hand"):
        robot.mission.command(Event.EMPTY, robot.senses())
