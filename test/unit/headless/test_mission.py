"""Whole cleans of small homes: how they end, and what may come up meanwhile.

Clean floor is counted by the robot's true poses, never by its believed ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL, NOISY
from fixtures.robots.headless_cleans import THING, assert_all_clean, begun, command
from fixtures.robots.missions import (
    DEN,
    FLOOR_TOO_LITTLE,
    HALL,
    HOME,
    TABLE,
    TWO_ROOMS,
    WALL_X,
    Clocked,
    floor_clean,
    in_phase,
    shut_door,
    two_rooms,
    until,
    wait,
)

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.mission.phases.machine import Event
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.coverage.planner import CoveragePlanner
from roomba.vocabulary import CleanMode, FanLevel, Phase
from roomba.world.engine.state.arrays import Fault


@pytest.mark.parametrize("width", [0.75, 0.8, 1.0])
def test_a_room_with_hardly_any_room_before_the_station_is_cleaned_without_a_hit(
    width: float,
) -> None:
    """The place before the station, 0.65 m off, would be in the wall."""
    station = Pose(IDEAL.body.radius + 0.035, 0.4, math.pi)
    robot = HeadlessMission(room_home(width, 0.8, station=station), NOISY, seed=1)
    record = robot.clean()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.hits == 0
    assert record.result.duration < 60.0


@pytest.mark.parametrize("config", [IDEAL, NOISY], ids=["ideal", "noisy"])
def test_it_cleans_all_the_floor_without_a_hit_and_docks(config: SimulatedRobotConfig) -> None:
    robot = HeadlessMission(HOME, config, seed=1)
    record = robot.clean()
    assert_all_clean(robot, record)
    assert record.hits == 0
    result = record.result
    assert result.missed == ()
    cells = np.count_nonzero(robot.context.coverable())
    assert result.wanted == pytest.approx(cells * robot.context.frame.resolution**2)
    # All but the table, and the strip along walls that a round body's tool cannot reach.
    strip = NOISY.body.radius - 0.5 * robot.context.tool_width
    assert result.wanted == pytest.approx(3.0 * 2.5 - 0.5 * 0.3 - 12.6 * strip, abs=0.15)
    poses = record.poses
    assert result.duration == pytest.approx(robot.seen.time, abs=0.1)
    way = float(np.hypot(*np.diff(poses[:, 1:3], axis=0).T).sum())
    assert result.distance == pytest.approx(way, rel=0.02)
    assert record.distance == pytest.approx(way, rel=0.02)
    used = (1.0 - robot.seen.battery.level) * robot.seen.battery.capacity
    assert result.energy == pytest.approx(used, rel=0.05)
    assert result.dirt == pytest.approx(robot.seen.in_bin)
    assert result.dirt > 0.5
    # Never faster than the speed wanted, and each tick is there.
    assert np.diff(poses[:, 0]) == pytest.approx(0.05)
    speed = np.hypot(*np.diff(poses[:, 1:3], axis=0).T) / 0.05
    assert speed.max() <= 1.02 * robot.config.driving.speed


def test_the_same_seed_gives_the_same_trace_and_another_one_another() -> None:
    def trace(seed: int) -> tuple[bytes, str]:
        robot = HeadlessMission(HOME, seed=seed)
        robot.simulator.place_obstacle(*THING)
        record = robot.clean()
        return record.poses.tobytes(), robot.simulator.digest()

    assert trace(3) == trace(3)
    assert trace(3) != trace(4)


def test_of_each_clean_its_own_plans_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[int] = []
    plan = CoveragePlanner.plan

    def counted(*given: Any, **named: Any) -> CoveragePlan:
        made.append(1)
        return plan(*given, **named)

    monkeypatch.setattr(CoveragePlanner, "plan", counted)
    robot = HeadlessMission(HOME)
    for _ in range(2):
        made.clear()
        record = robot.clean()
        assert record.plans == len(made) >= 1


def test_it_may_begin_off_its_station() -> None:
    robot = HeadlessMission(HOME, start=Pose(2.5, 0.6, 1.0))
    assert robot.mission.state.phase is Phase.IDLE
    assert_all_clean(robot, robot.clean())


def test_rooms_are_cleaned_and_no_others() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    record = robot.clean(CleanRequest(CleanMode.ROOMS, rooms=(DEN,)))
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert floor_clean(robot, robot.context.in_room(DEN)) >= FLOOR_TOO_LITTLE
    assert floor_clean(robot, robot.context.in_room(HALL)) < 0.5


@pytest.mark.parametrize("names", [(DEN, HALL), (HALL, DEN)])
def test_rooms_in_order_are_cleaned_one_after_the_other(names: tuple[str, ...]) -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    request = CleanRequest(CleanMode.ROOMS, rooms=names, in_order=True)
    robot.mission.clean(request, robot.senses())
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    first, second = (robot.context.in_room(name) for name in names)
    until(robot, lambda: cleaning.ledger.stage_number == 1)
    assert floor_clean(robot, first) >= FLOOR_TOO_LITTLE
    assert floor_clean(robot, second) < 0.5
    assert_all_clean(robot, robot.run())


def test_rooms_not_in_order_begin_with_the_nearest() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    robot.mission.clean(CleanRequest(CleanMode.ROOMS, rooms=(DEN, HALL)), robot.senses())
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    assert [stage.name for stage in cleaning.ledger.stages] == [HALL, DEN]


def test_zones_are_cleaned_and_little_else() -> None:
    robot = HeadlessMission(HOME)
    zone = (1.0, 0.3, 1.6, 0.9)
    record = robot.clean(CleanRequest(CleanMode.ZONES, zones=(zone,)))
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert record.result.wanted == pytest.approx(0.36, rel=0.01)
    frame = robot.context.frame
    wanted = np.zeros(frame.shape, np.bool_)
    low, left = frame.cell_of(zone[0] + 1e-6, zone[1] + 1e-6)
    high, right = frame.cell_of(zone[2] - 1e-6, zone[3] - 1e-6)
    wanted[low:high, left:right] = True
    assert floor_clean(robot, wanted) >= FLOOR_TOO_LITTLE
    assert floor_clean(robot) < 0.35


def test_a_spot_is_a_square_around_a_point_or_the_robot() -> None:
    for spot, start in (((2.2, 1.7), None), (None, Pose(2.2, 1.7, 0.0))):
        robot = HeadlessMission(HOME, start=start)
        record = robot.clean(CleanRequest(CleanMode.SPOT, spot=spot))
        assert record.result.outcome is CleanOutcome.COMPLETED
        assert robot.is_home
        frame = robot.context.frame
        row, column = frame.cell_of(2.2, 1.7)
        wanted = np.zeros(frame.shape, np.bool_)
        wanted[row - 74 : row + 74, column - 74 : column + 74] = True
        assert floor_clean(robot, wanted) >= FLOOR_TOO_LITTLE
        assert floor_clean(robot) < 0.6


def test_edges_are_cleaned_and_the_middle_is_not() -> None:
    robot = HeadlessMission(HOME)
    record = robot.clean(CleanRequest(CleanMode.EDGES))
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    floor = robot.context.coverable()
    along = np.zeros(floor.shape, np.bool_)
    inside = np.argwhere(floor)
    (top, left), (bottom, right) = inside.min(axis=0), inside.max(axis=0)
    along[top : top + 8, left + 20 : right - 20] = True
    along[bottom - 8 : bottom, left + 20 : right - 20] = True
    assert floor_clean(robot, along) >= 0.98
    assert record.distance < 25.0
    assert floor_clean(robot) < 0.8


def test_two_passes_go_over_everything_twice() -> None:
    once = HeadlessMission(HOME, IDEAL).clean().distance
    robot = HeadlessMission(HOME, IDEAL)
    record = robot.clean(CleanRequest(passes=2))
    assert_all_clean(robot, record)
    assert record.distance > 1.7 * once


def test_the_fan_runs_as_asked_for() -> None:
    robot = HeadlessMission(HOME)
    request = CleanRequest(CleanMode.SPOT, spot=(1.0, 0.6), fan=FanLevel.QUIET)
    robot.mission.clean(request, robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING))
    assert robot.simulator.duty[1] == pytest.approx(robot.robot_config.fan.quiet)
    until(robot, in_phase(robot, Phase.RETURNING))
    assert robot.simulator.duty[1] == pytest.approx(robot.robot_config.fan.quiet)
    robot.run()
    robot.tick()
    # As on ROS the next one who drives finds it as it was.
    assert robot.simulator.duty[1] == pytest.approx(robot.robot_config.fan.duty)


def test_a_thing_that_the_map_does_not_show_is_gone_around_and_told() -> None:
    robot = HeadlessMission(HOME)
    robot.simulator.place_obstacle(*THING)
    record = robot.clean()
    result = record.result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert record.hits == 0
    (missed,) = result.missed
    assert missed.reason is MissReason.THING
    assert math.dist((missed.x, missed.y), THING[:2]) < 0.1
    # All but its shadow: the disc, and what the tool cannot reach around it.
    shadow = math.pi * THING[2] ** 2
    assert shadow < missed.area < 4.0 * shadow
    floor = np.count_nonzero(robot.context.coverable()) * robot.context.frame.resolution**2
    assert floor_clean(robot) * floor > FLOOR_TOO_LITTLE * floor - missed.area


def test_a_low_thing_that_the_lidar_does_not_see_is_felt_and_gone_around() -> None:
    robot = HeadlessMission(HOME, seed=2)
    robot.simulator.inject(Fault.BUMPER_STUCK, 0.0)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING))
    wait(robot, 20.0)
    robot.simulator.inject(Fault.BUMPER_STUCK, 1.0)
    wait(robot, 0.3)
    robot.simulator.inject(Fault.BUMPER_STUCK, 0.0)
    robot.run()
    assert robot.is_home


def test_behind_a_shut_door_the_floor_is_told_as_shut() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    shut_door(robot)
    record = robot.clean()
    result = record.result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert record.hits == 0
    behind = [missed for missed in result.missed if missed.reason is MissReason.SHUT]
    assert sum(missed.area for missed in behind) == pytest.approx(1.4 * 2.4, abs=0.5)
    assert behind[0].room == DEN
    hall = robot.context.in_room(HALL)
    hall[:, robot.context.frame.cell_of(WALL_X - 0.45, 0.0)[1] :] = False
    assert floor_clean(robot, hall) >= FLOOR_TOO_LITTLE


def test_a_door_that_is_opened_meanwhile_is_found_open() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    shut_door(robot)
    begun(60.0, robot)
    robot.simulator.remove_obstacles()
    assert_all_clean(robot, robot.run())


@pytest.mark.parametrize("jump", [-1e5, -30.0, 30.0, 1e5])
def test_a_clock_that_is_set_changes_little(jump: float) -> None:
    robot = begun(robot=Clocked(HOME))
    assert isinstance(robot, Clocked)
    robot.simulator.place_obstacle(*THING)
    phases: list[Callable[[], bool]] = [
        in_phase(robot, Phase.CLEANING),
        in_phase(robot, Phase.RETURNING),
        in_phase(robot, Phase.DOCKING),
    ]
    for is_so in phases:
        until(robot, is_so)
        robot.clock += jump
        robot.tick()
    record = robot.run()
    result = record.result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert floor_clean(robot) >= 0.97
    assert result.duration == pytest.approx(robot.seen.time, abs=3.0)


def test_a_wheel_that_is_held_makes_it_say_that_it_is_stuck() -> None:
    robot = begun()
    robot.simulator.inject(Fault.STALL_LEFT, 1.0)
    robot.simulator.inject(Fault.STALL_RIGHT, 1.0)
    result = robot.run().result
    assert result.outcome is CleanOutcome.STUCK
    assert "stuck" in result.message
    assert robot.seen.time < 200.0
    robot.simulator.inject(Fault.STALL_LEFT, 0.0)
    robot.simulator.inject(Fault.STALL_RIGHT, 0.0)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


@pytest.mark.parametrize("event", [Event.STOP, Event.DOCK])
def test_a_clean_that_failed_can_be_ended_for_good(event: Event) -> None:
    robot = begun()
    robot.simulator.inject(Fault.LIFTED, 1.0)
    assert robot.run().result.outcome is CleanOutcome.FAULT
    robot.simulator.inject(Fault.LIFTED, 0.0)
    wait(robot, 1.0)
    command(robot, event)
    ended = robot.mission.take_result()
    assert ended is None or ended.outcome is not CleanOutcome.COMPLETED
    assert robot.mission.cleaning is None
    assert not robot.mission.sweeps
    wait(robot, 3.0)
    assert robot.mission.take_result() is None
    # The next one is told of itself alone.
    record = robot.clean(CleanRequest(CleanMode.SPOT, spot=(1.0, 0.6)))
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home


def test_a_request_without_any_floor_is_refused_and_the_old_clean_goes_on() -> None:
    robot = begun()
    middle = ((TABLE[0] + 0.1, TABLE[1] + 0.1, TABLE[2] - 0.1, TABLE[3] - 0.1),)
    with pytest.raises(CleanRefusedError, match="furniture"):
        robot.mission.clean(CleanRequest(CleanMode.ZONES, zones=middle), robot.senses())
    assert_all_clean(robot, robot.run())


def test_rooms_are_refused_on_a_map_without_and_by_names_that_are_none() -> None:
    robot = HeadlessMission(HOME)
    with pytest.raises(CleanRefusedError, match="map with rooms"):
        robot.clean(CleanRequest(CleanMode.ROOMS, rooms=(DEN,)))
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    with pytest.raises(CleanRefusedError, match=r"'cellar'.*den, hall"):
        robot.clean(CleanRequest(CleanMode.ROOMS, rooms=("cellar",)))
    assert not robot.mission.state.drives


def test_how_long_it_still_takes_is_told() -> None:
    robot = HeadlessMission(HOME)
    assert robot.mission.seconds_to_go() == 0.0
    begun(20.0, robot)
    told = robot.mission.seconds_to_go()
    began = robot.seen.time
    robot.run()
    assert 0.5 < told / (robot.seen.time - began) < 1.5
    assert robot.mission.seconds_to_go() == 0.0


def test_shut_in_a_room_it_waits_for_the_door_and_goes_home() -> None:
    robot = HeadlessMission(TWO_ROOMS, start=Pose(2.8, 1.2, 0.0))
    shut_door(robot)
    robot.mission.clean(CleanRequest(CleanMode.SPOT, spot=(2.9, 0.7)), robot.senses())
    until(robot, lambda: "waits" in robot.mission.message, 900.0)
    # Be it to clean on or to go home: it needs a way out for both.
    assert robot.mission.state.phase in (Phase.CLEANING, Phase.RETURNING)
    wait(robot, 120.0)
    assert robot.mission.state.phase in (Phase.CLEANING, Phase.RETURNING)
    assert robot.mission.take_result() is None
    robot.simulator.remove_obstacles()
    until(robot, in_phase(robot, Phase.DOCKED), 900.0)
    result = robot.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.mission.message == ""


@pytest.mark.thorough
def test_shut_in_for_good_it_says_so_in_the_end() -> None:
    robot = HeadlessMission(TWO_ROOMS, start=Pose(2.8, 1.2, 0.0))
    shut_door(robot)
    robot.mission.clean(CleanRequest(CleanMode.SPOT, spot=(2.9, 0.7)), robot.senses())
    result = robot.run().result
    assert result.outcome is CleanOutcome.NOT_DOCKED
    assert "no way" in result.message
