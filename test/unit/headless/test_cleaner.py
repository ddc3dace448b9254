"""Whole cleans of small homes: how they end, and what may come up meanwhile.

What is clean is counted by where the robot really was, never by what it believes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from fixtures.missions import (
    DEN,
    FLOOR_TOO_LITTLE,
    HALL,
    HOME,
    STATION,
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
from fixtures.worlds import IDEAL, NOISY

from roomba.configuration.docking import DockingConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.headless.cleaner import HeadlessMission
from roomba.headless.records import CleanRecord
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.cleaning.request import (
    CleanOutcome,
    CleanRefusedError,
    CleanRequest,
    MissReason,
)
from roomba.mission.commands import CommandRefusedError
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Errand, Event, Phase
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.vocabulary import CleanMode, FanLevel
from roomba.world.engine.state.arrays import Fault

THING = (1.0, 0.75, 0.10)
"""x, y and radius of something on the floor of HOME, m."""
BODY = NOISY.body.radius


def command(robot: HeadlessMission, event: Event, reason: str = "") -> None:
    robot.mission.command(event, robot.senses(), reason)


def begun(
    after: float = 40.0,
    robot: HeadlessMission | None = None,
    request: CleanRequest | None = None,
) -> HeadlessMission:
    """A robot that has cleaned for so many seconds, on the way out of its station included."""
    robot = robot or HeadlessMission(HOME)
    robot.mission.clean(request or CleanRequest(), robot.senses())
    wait(robot, after)
    return robot


def assert_all_clean(robot: HeadlessMission, record: CleanRecord) -> None:
    result = record.result
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert robot.is_home
    assert robot.seen.battery.is_docked
    assert floor_clean(robot) >= FLOOR_TOO_LITTLE
    # What it believes is about what is so.
    assert result.fraction == pytest.approx(floor_clean(robot), abs=0.002)


def assert_stands(robot: HeadlessMission, seconds: float = 5.0) -> None:
    """It comes to rest within half a second, and stays there."""
    wait(robot, 0.5)
    at = robot.simulator.pose
    wait(robot, seconds)
    assert robot.simulator.pose.distance_to(at.x, at.y) < 0.001


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
    until(robot, lambda: cleaning.stage_number == 1)
    assert floor_clean(robot, first) >= FLOOR_TOO_LITTLE
    assert floor_clean(robot, second) < 0.5
    assert_all_clean(robot, robot.run())


def test_rooms_not_in_order_begin_with_the_nearest() -> None:
    robot = HeadlessMission(TWO_ROOMS, rooms=two_rooms())
    robot.mission.clean(CleanRequest(CleanMode.ROOMS, rooms=(DEN, HALL)), robot.senses())
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    assert [stage.name for stage in cleaning.stages] == [HALL, DEN]


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
    assert robot.simulator.duty[1] == pytest.approx(robot.robot.fan.quiet)
    until(robot, in_phase(robot, Phase.RETURNING))
    assert robot.simulator.duty[1] == pytest.approx(robot.robot.fan.quiet)
    robot.run()
    robot.tick()
    # As on ROS the next one who drives finds it as it was.
    assert robot.simulator.duty[1] == pytest.approx(robot.robot.fan.duty)


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
def test_it_may_be_paused_whatever_it_does(phase: Phase) -> None:
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
    robot = begun(200.0)
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
    robot.simulator.inject(Fault.STATION_DEAD, 0.0)
    command(robot, Event.RESUME)
    assert robot.mission.message == ""
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home


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


def zoned(robot: HeadlessMission, *zones: Zone) -> PlanningContext:
    home = robot.simulator.home
    return PlanningContext(
        home.map,
        home.station,
        robot.robot,
        robot.config,
        DockingConfig(),
        robot.context.rooms,
        Zones(zones),
    )


def no_go(left: float, bottom: float, right: float, top: float) -> Zone:
    corners = ((left, bottom), (right, bottom), (right, top), (left, top))
    return Zone("rug", ZoneKind.NO_GO, corners)


def inside_by(record: CleanRecord, since: float, area: tuple[float, ...]) -> float:
    """Return how far the body's rim ever came into an area after a time, m."""
    rows = record.poses[record.poses[:, 0] > since]
    dx = np.maximum(np.maximum(area[0] - rows[:, 1], rows[:, 1] - area[2]), 0.0)
    dy = np.maximum(np.maximum(area[1] - rows[:, 2], rows[:, 2] - area[3]), 0.0)
    return BODY - float(np.hypot(dx, dy).min())


AREA = (1.9, 1.5, 3.0, 2.5)


def test_a_zone_from_the_beginning_is_never_entered() -> None:
    robot = HeadlessMission(HOME, zones=Zones((no_go(*AREA),)))
    record = robot.clean()
    assert_all_clean(robot, record)
    assert inside_by(record, 0.0, AREA) < 0.0
    bare = HeadlessMission(HOME).context
    assert record.result.wanted < np.count_nonzero(bare.coverable()) * 1e-4 - 0.9


@pytest.mark.parametrize("after", [20.0, 60.0, 100.0])
def test_a_zone_set_while_it_cleans_is_not_entered_any_more(after: float) -> None:
    robot = begun(after)
    pose = robot.simulator.pose
    # A corner of the room in which it does not stand.
    left, right = (2.0, 3.0) if pose.x < 1.4 else (0.9, 1.4) if pose.y > 1.0 else (0.0, 1.0)
    area = (left, 1.7, right, 2.5) if pose.y < 1.25 else (left, 0.0, right, 0.7)
    robot.mission.use_context(zoned(robot, no_go(*area)))
    since = robot.seen.time
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert inside_by(record, since, area) < 0.002
    floor = zoned(robot, no_go(*area)).coverable()
    assert floor_clean(robot, floor) >= FLOOR_TOO_LITTLE


def test_a_zone_that_is_set_around_it_is_left() -> None:
    robot = begun()
    until(robot, lambda: robot.simulator.pose.x > 2.4)
    pose = robot.simulator.pose
    area = (pose.x - 0.3, pose.y - 0.3, pose.x + 0.3, pose.y + 0.3)
    robot.mission.use_context(zoned(robot, no_go(*area)))
    since = robot.seen.time
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert inside_by(record, since + 10.0, area) < 0.002


def test_a_virtual_wall_before_the_rest_leaves_it_out() -> None:
    robot = begun(10.0, HeadlessMission(TWO_ROOMS))
    wall = Zone("wall", ZoneKind.WALL, ((WALL_X, 0.0), (WALL_X, 2.4)))
    context = zoned(robot, wall)
    robot.mission.use_context(context)
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert record.poses[:, 1].max() < WALL_X
    assert record.result.missed == ()
    assert floor_clean(robot, context.coverable()) >= FLOOR_TOO_LITTLE


def restarted(robot: HeadlessMission, values: dict[str, Any] | None = None) -> None:
    """The mission's process ended and begins again, with nothing but the checkpoint."""
    values = json.loads(json.dumps(values or robot.mission.checkpoint(robot.senses())))
    robot.things.forget()
    robot.mission = fresh(robot)
    robot.mission.restore(values, robot.senses())


def fresh(robot: HeadlessMission) -> Mission:
    return Mission(
        robot.context,
        robot.robot,
        robot.config,
        DockingConfig(),
        robot.things,
        robot.dirt,
        robot.senses(),
    )


@pytest.mark.parametrize("seed", range(4))
def test_ended_at_any_moment_a_new_mission_goes_on(seed: int) -> None:
    random = np.random.default_rng(seed)
    robot = HeadlessMission(HOME, seed=seed)
    robot.simulator.place_obstacle(*THING)
    request = CleanRequest(passes=1 + seed % 2)
    robot.mission.clean(request, robot.senses())
    ends = robot.seen.time + np.cumsum(random.exponential(30.0, 8))
    for at in ends:
        while robot.seen.time < at and not robot.is_home:
            robot.advance()
        if robot.mission.checkpoint(robot.senses()) is not None:
            restarted(robot)
    record = robot.run()
    result = record.result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert {missed.reason for missed in result.missed} <= {MissReason.THING}
    shadow = math.pi * (THING[2] + 0.1) ** 2
    assert floor_clean(robot) >= FLOOR_TOO_LITTLE - shadow / result.wanted
    # The ledgers go on, too.
    assert result.duration == pytest.approx(robot.seen.time, abs=1.0)
    assert result.dirt == pytest.approx(robot.seen.in_bin, rel=0.05)
    driven = robot.simulator.numbers["distance"]
    assert result.distance == pytest.approx(driven, rel=0.05)


def test_what_is_clean_is_not_cleaned_again_after_a_restart() -> None:
    whole = HeadlessMission(HOME, IDEAL).clean().distance
    robot = begun(130.0, HeadlessMission(HOME, IDEAL))
    assert floor_clean(robot) > 0.4
    driven = robot.simulator.numbers["distance"]
    restarted(robot)
    assert_all_clean(robot, robot.run())
    assert robot.simulator.numbers["distance"] - driven < 0.75 * whole


@pytest.mark.parametrize("phase", [Phase.UNDOCKING, Phase.CLEANING, Phase.RETURNING, Phase.DOCKING])
def test_each_phase_can_be_taken_up_again(phase: Phase) -> None:
    robot = HeadlessMission(HOME)
    request = CleanRequest(CleanMode.SPOT, spot=(2.0, 0.6))
    robot.mission.clean(request, robot.senses())
    until(robot, in_phase(robot, phase))
    for _ in range(20):
        robot.tick()
    restarted(robot)
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.fraction >= 0.99
    assert robot.is_home


def test_what_was_held_up_stays_so_after_a_restart() -> None:
    robot = begun()
    command(robot, Event.PAUSE)
    restarted(robot)
    assert robot.mission.state.phase is Phase.PAUSED
    assert_stands(robot)
    command(robot, Event.RESUME)
    wait(robot, 5.0)
    robot.simulator.inject(Fault.LIFTED, 1.0)
    robot.run()
    robot.simulator.inject(Fault.LIFTED, 0.0)
    wait(robot, 1.0)
    restarted(robot)
    assert robot.mission.state.phase is Phase.ERROR
    assert "wheel" in robot.mission.message
    assert_stands(robot)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_a_restart_while_it_charges_goes_on_charging() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    restarted(robot)
    wait(robot, 5.0)
    assert robot.mission.state.phase is Phase.CHARGING
    robot.simulator.set_charge(0.95)
    assert_all_clean(robot, robot.run())


def test_without_an_errand_there_is_nothing_to_remember() -> None:
    robot = HeadlessMission(HOME)
    assert robot.mission.checkpoint(robot.senses()) is None
    command(robot, Event.UNDOCK)
    assert robot.mission.checkpoint(robot.senses()) is None
    until(robot, in_phase(robot, Phase.IDLE))
    assert robot.mission.checkpoint(robot.senses()) is None


def test_on_its_way_home_by_command_it_goes_on_after_a_restart() -> None:
    robot = HeadlessMission(HOME, start=Pose(2.5, 0.6, 1.0))
    command(robot, Event.DOCK)
    wait(robot, 4.0)
    restarted(robot)
    until(robot, lambda: robot.is_home, 60.0)


def set_in(values: Any, path: str, new: object) -> None:
    """Set what is at a path of keys and numbers."""
    *way, last = path.split(".")
    for key in way:
        values = values[int(key) if isinstance(values, list) else key]
    values[int(last) if isinstance(values, list) else last] = new


@pytest.mark.parametrize(
    ("path", "junk"),
    [
        ("version", 99),
        ("version", None),
        ("phase", "DANCING"),
        ("phase", None),
        ("errand", "FLYING"),
        ("errand", []),
        ("resumes", 7),
        ("outcome", "SPLENDID"),
        ("cleaning", None),
        ("cleaning", 5),
        ("cleaning", {}),
        ("cleaning.request", {}),
        ("cleaning.request.mode", "thorough"),
        ("cleaning.request.passes", 0),
        ("cleaning.request.passes", "many"),
        ("cleaning.request.fan", "LOUD"),
        ("cleaning.request.zones", [[1.0, 2.0]]),
        ("cleaning.request.spot", ["here", "there"]),
        ("cleaning.stages", 3),
        ("cleaning.stages", [["whole"]]),
        ("cleaning.stages.0.1", "bm90IGEgbWFzaw=="),
        ("cleaning.stage_number", 7),
        ("cleaning.stage_number", -1),
        ("cleaning.stage_number", "one"),
        ("cleaning.wanted", "!"),
        ("cleaning.swept", ""),
        ("cleaning.swept", 12),
        ("cleaning.ever", None),
        ("ledger", [1.0, 2.0]),
        ("ledger", ["far", 0.0, 0.0]),
        ("ledger", None),
        ("duration", "long"),
    ],
)
def test_a_checkpoint_that_is_junk_is_refused(path: str, junk: object) -> None:
    robot = begun(12.0)
    values = json.loads(json.dumps(robot.mission.checkpoint(robot.senses())))
    set_in(values, path, junk)
    robot.mission = fresh(robot)
    with pytest.raises(CheckpointError, match="expected"):
        robot.mission.restore(values, robot.senses())
    assert robot.mission.cleaning is None
    assert not robot.mission.state.drives


def test_a_checkpoint_without_something_is_refused() -> None:
    robot = begun(12.0)
    values = robot.mission.checkpoint(robot.senses())
    assert values is not None
    for name in values:
        less = {key: value for key, value in values.items() if key != name}
        with pytest.raises(CheckpointError, match=name):
            fresh(robot).restore(less, robot.senses())
    for name in values["cleaning"]:
        less = {key: value for key, value in values["cleaning"].items() if key != name}
        with pytest.raises(CheckpointError, match=name):
            fresh(robot).restore({**values, "cleaning": less}, robot.senses())


def test_a_checkpoint_of_another_map_is_refused() -> None:
    values = begun(12.0).mission.checkpoint(begun(12.0).senses())
    assert values is not None
    other = HeadlessMission(TWO_ROOMS)
    with pytest.raises(CheckpointError, match="expected a grid of"):
        other.mission.restore(values, other.senses())


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


@pytest.mark.parametrize("event", [Event.STOP, Event.DOCK, Event.EMERGENCY])
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
    if event is Event.EMERGENCY:
        command(robot, Event.RELEASE)
    # The next one is told of itself alone.
    record = robot.clean(CleanRequest(CleanMode.SPOT, spot=(1.0, 0.6)))
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home


def test_charging_off_its_station_after_a_restart_it_looks_for_it() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    values = robot.mission.checkpoint(robot.senses())
    robot.simulator.put(Pose(1.0, 1.0, 0.0))
    robot.localizer.told(robot.simulator.pose, (0.05, 0.05))
    robot.simulator.set_charge(0.2)
    robot.tick()
    restarted(robot, values)
    until(robot, lambda: robot.seen.battery.is_docked, 120.0)


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


def test_shut_in_for_good_it_says_so_in_the_end() -> None:
    robot = HeadlessMission(TWO_ROOMS, start=Pose(2.8, 1.2, 0.0))
    shut_door(robot)
    robot.mission.clean(CleanRequest(CleanMode.SPOT, spot=(2.9, 0.7)), robot.senses())
    result = robot.run().result
    assert result.outcome is CleanOutcome.NOT_DOCKED
    assert "no way" in result.message
