"""The brain in a body that is not simulated: ticked with readings made by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import DEN, HALL, HOME, STATION, TWO_ROOMS, two_rooms

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import DrivingConfig, MissionConfig
from roomba.errors import ConfigError, RoombaError
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.grid import OccupancyMap
from roomba.headless.body import SimulatedBody
from roomba.mission.commands import CommandRefusedError
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.phases.machine import Errand, Event, MissionState
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.planning.path.planner import NoPathError
from roomba.robot.brain import Brain
from roomba.robot.command import Command
from roomba.robot.readings import CliffReading, Readings
from roomba.vocabulary import CleanMode, FanLevel, Phase, RoomWay

ON_FLOOR = Pose(0.9, 0.5, 0.0)
DOCKED = Readings(0.0, Pose(), battery=Battery(1.0, 26.0, is_docked=True))


def brain(known: OccupancyMap | MappingConfig, mission: MissionConfig | None = None) -> Brain:
    return Brain(known, STATION, NOISY, mission or MissionConfig(), DockingConfig())


def first_scan() -> Readings:
    """What the body tells once its first scan came."""
    body = SimulatedBody(HOME, NOISY, 1, None, None)
    readings = body.read()
    while readings.scan is None:
        body.act(Command())
        readings = body.read()
    return readings


def test_on_a_known_map_it_is_ready_at_once_and_stands() -> None:
    robot = brain(HOME.map)
    assert robot.tick(DOCKED) == Command()
    assert robot.mission.state.phase is Phase.DOCKED
    assert robot.pose == STATION


def test_before_it_was_told_anything_it_knows_nothing() -> None:
    robot = brain(HOME.map)
    with pytest.raises(RoombaError, match="nothing was told"):
        robot.senses()
    with pytest.raises(RoombaError, match="no map yet"):
        _ = robot.mission


def test_without_a_map_it_stands_until_its_first_scan() -> None:
    robot = brain(MappingConfig())
    assert robot.tick(DOCKED) == Command()
    assert not robot.is_ready
    with pytest.raises(RoombaError, match="no map yet"):
        _ = robot.things
    robot.tick(first_scan())
    assert robot.is_ready
    assert robot.mission.context.is_growing


@pytest.mark.parametrize("fan", [FanLevel.QUIET, FanLevel.STRONG])
def test_told_to_clean_it_drives_off_with_the_fan_that_is_asked_for(fan: FanLevel) -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.mission.clean(CleanRequest(fan=fan), robot.senses())
    commands = [robot.tick(replace(DOCKED, time=0.05 * tick)) for tick in range(1, 4)]
    assert commands[-1].twist != STANDSTILL
    assert commands[-1].fan == robot.robot_config.fan.duty_at(fan)


def test_each_room_is_cleaned_with_the_fan_that_it_is_given() -> None:
    robot = Brain(
        TWO_ROOMS.map,
        TWO_ROOMS.station,
        NOISY,
        MissionConfig(),
        DockingConfig(),
        rooms=two_rooms(),
    )
    robot.tick(DOCKED)
    ways = RoomWay(1, FanLevel.STRONG), RoomWay(1, FanLevel.QUIET)
    order = CleanRequest(CleanMode.ROOMS, (HALL, DEN), in_order=True, each=ways)
    robot.mission.clean(order, robot.senses())
    commands = [robot.tick(replace(DOCKED, time=0.05 * tick)) for tick in range(1, 4)]
    assert commands[-1].fan == robot.robot_config.fan.duty_at(FanLevel.STRONG)


def test_no_command_is_faster_than_the_robot() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.limit_speed(0.07)
    assert robot.mission.max_speed == 0.07
    robot.mission.clean(CleanRequest(), robot.senses())
    twists = [robot.tick(replace(DOCKED, time=0.05 * tick)).twist for tick in range(1, 9)]
    assert max(abs(twist.linear) for twist in twists) == pytest.approx(0.07)


def test_a_speed_that_its_body_cannot_do_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"driving\.speed.*0\.5 m/s.*got 0\.8"):
        brain(HOME.map, MissionConfig(driving=DrivingConfig(speed=0.8)))


def test_readings_are_told_without_a_step() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    low = replace(DOCKED, battery=Battery(0.1, 26.0, is_docked=False))
    robot.told(low)
    assert robot.senses().battery.level == 0.1
    assert robot.mission.state.phase is Phase.DOCKED


def test_the_same_readings_give_the_same_commands() -> None:
    commands = []
    for _ in range(2):
        robot = brain(HOME.map)
        robot.tick(DOCKED)
        robot.mission.clean(CleanRequest(), robot.senses())
        ticks = np.arange(1, 40) * 0.05
        commands.append([robot.tick(replace(DOCKED, time=float(now))) for now in ticks])
    assert commands[0] == commands[1]


@pytest.mark.parametrize(
    "hazard", [{"bumper_left": True}, {"cliff": CliffReading(right=True)}, {"dropped_left": True}]
)
def test_steered_or_on_a_walk_it_does_not_drive_into_a_hazard(hazard: dict[str, Any]) -> None:
    robot = Brain(HOME.map, STATION, NOISY, MissionConfig(), DockingConfig(), start=ON_FLOOR)
    free = Readings(0.0, Pose(), battery=Battery(1.0, 26.0))
    robot.sense(free)
    assert robot.steer(Twist(0.9, 0.0)).twist.linear == NOISY.body.max_speed
    robot.walk(ON_FLOOR.x + 1.0, ON_FLOOR.y)
    robot.tick(free)
    assert robot.tick(replace(free, time=0.05)).twist.linear > 0.0
    felt = replace(free, time=0.1, **hazard)
    assert robot.tick(felt).twist.linear <= 0.0
    assert robot.steer(Twist(0.3, 0.0)).twist.linear <= 0.0


@pytest.mark.parametrize("is_steered", [False, True])
@pytest.mark.parametrize(
    "hazard", [{"bumper_left": True}, {"cliff": CliffReading(front_left=True)}, {}]
)
def test_under_the_emergency_stop_it_stands_whatever_its_sensors_tell(
    hazard: dict[str, Any], is_steered: bool
) -> None:
    robot = Brain(HOME.map, STATION, NOISY, MissionConfig(), DockingConfig(), start=ON_FLOOR)
    free = Readings(0.0, Pose(), battery=Battery(1.0, 26.0))
    robot.tick(free)
    robot.mission.clean(CleanRequest(), robot.senses())
    robot.tick(replace(free, time=0.05))
    assert robot.mission.state.drives
    robot.mission.command(Event.EMERGENCY, robot.senses(), "pressed")
    for tick in range(2, 8):
        robot.sense(replace(free, time=0.05 * tick, **hazard))
        now = robot.steer(Twist(0.2, 0.5)) if is_steered else robot.decide()
        assert now.twist == STANDSTILL


@pytest.mark.parametrize("phase", [Phase.DOCKED, Phase.PAUSED, Phase.IDLE])
def test_at_rest_it_stands_though_a_cliff_sensor_is_dirty(phase: Phase) -> None:
    robot = Brain(HOME.map, STATION, NOISY, MissionConfig(), DockingConfig(), start=ON_FLOOR)
    free = Readings(0.0, Pose(), battery=Battery(1.0, 26.0, is_docked=phase is Phase.DOCKED))
    robot.tick(free)
    if phase is Phase.PAUSED:
        robot.mission.clean(CleanRequest(), robot.senses())
        robot.tick(replace(free, time=0.05))
        robot.mission.command(Event.PAUSE, robot.senses())
    assert robot.mission.state.phase is phase
    for tick in range(2, 20):
        felt = replace(free, time=0.05 * tick, cliff=CliffReading(front_left=True))
        assert robot.tick(felt).twist == STANDSTILL


def test_a_walk_pauses_the_errand_under_way() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.mission.clean(CleanRequest(), robot.senses())
    robot.tick(replace(DOCKED, time=0.05))
    robot.walk(1.0, 0.5)
    assert robot.mission.state.phase is Phase.PAUSED
    assert robot.walking.is_under_way


@pytest.mark.parametrize("is_amid_a_clean", [False, True])
def test_a_walk_forgets_where_the_floor_ended_but_not_amid_an_errand(
    is_amid_a_clean: bool,
) -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    if is_amid_a_clean:
        robot.mission.clean(CleanRequest(), robot.senses())
    edge = Senses(0.05, Pose(3.0, 3.0), cliff_left=True)
    robot.mission.obstacles.feel(edge)
    robot.walk(1.0, 0.5)
    assert bool(robot.mission.obstacles.edges()) is is_amid_a_clean
    robot.mission.clean(CleanRequest(), robot.senses())
    assert robot.mission.obstacles.edges() == []


def test_a_walk_while_it_charges_for_a_clean_pauses_that() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.mission.clean(CleanRequest(), robot.senses())
    robot.mission._transitions.state = MissionState(Phase.CHARGING, Errand.CLEAN)
    robot.walk(1.0, 0.5)
    robot.tick(replace(DOCKED, time=0.05, battery=Battery(1.0, 26.0)))
    assert robot.mission.state == MissionState(Phase.PAUSED, Errand.CLEAN, Phase.CHARGING)
    assert robot.walking.is_under_way


def test_a_walk_is_refused_while_the_emergency_stop_holds_and_its_release_drives_nowhere() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.mission.command(Event.EMERGENCY, robot.senses(), "a child")
    with pytest.raises(CommandRefusedError, match=r"holds the drive \(a child\); release it first"):
        robot.walk(1.0, 0.5)
    robot.mission.command(Event.RELEASE, robot.senses())
    assert robot.tick(replace(DOCKED, time=0.05)).twist == STANDSTILL
    assert not robot.walking.is_under_way


def test_a_walk_that_has_no_way_leaves_the_errand_alone() -> None:
    robot = brain(HOME.map)
    robot.tick(DOCKED)
    robot.mission.clean(CleanRequest(), robot.senses())
    with pytest.raises(NoPathError):
        robot.walk(99.0, 99.0)
    assert robot.mission.state.drives
    assert not robot.walking.is_under_way
    with pytest.raises(RoombaError, match="there was none"):
        _ = robot.walking.newest


def test_zones_stay_where_they_are_when_the_map_is_turned_to_be_whole() -> None:
    aslant = Pose(STATION.x, STATION.y, STATION.theta + 0.05)
    robot = Brain(MappingConfig(), aslant, NOISY, MissionConfig(), DockingConfig())
    robot.tick(first_scan())
    zone = Zone("mat", ZoneKind.NO_GO, ((1.0, 0.5), (1.6, 0.5), (1.6, 1.0)))
    robot.use_rooms(None, Zones((zone,)))
    robot.finish_map()
    station = robot.mission.context.station
    assert station.theta != aslant.theta
    before = aslant.inverse().transform(np.array(zone.points))
    (after,) = robot.zones.all
    assert station.inverse().transform(np.array(after.points)) == pytest.approx(before)
    assert robot.mission.context.zones == robot.zones


@pytest.mark.parametrize("lidar", ["lds_01", "neato"])
def test_by_a_lidar_that_turns_a_thing_is_seen_where_it_stands(lidar: str) -> None:
    robot, body = turning(HOME.map, lidar)
    x, y, radius = 1.3, 2.0, 0.05
    body.simulator.place_obstacle(x, y, radius)
    turn(robot, body)
    seen = np.array(robot.things.obstacles())
    assert len(seen) > 0
    assert (np.hypot(seen[:, 0] - x, seen[:, 1] - y) < radius + 0.06).all()


@pytest.mark.parametrize("known", [HOME.map, MappingConfig()], ids=["mapped", "mapping"])
def test_a_scan_is_placed_where_its_beams_meet_the_walls(
    known: OccupancyMap | MappingConfig,
) -> None:
    robot, body = turning(known, "neato")
    turn(robot, body)
    placed = robot.keeper.place.placed
    assert placed is not None
    at = np.array([placed.pose.x, placed.pose.y, placed.pose.theta])
    fit = placed.lidar.view(placed.ranges).fit(SurfaceField.of(HOME.map), at)
    assert fit.agree > 0.97


def turning(known: OccupancyMap | MappingConfig, lidar: str) -> tuple[Brain, SimulatedBody]:
    """Return a robot that turns on the spot on the floor, and its body."""
    robot = NOISY.with_lidar(lidar)
    mission, docking = MissionConfig(), DockingConfig()
    body = SimulatedBody(HOME, robot, 1, None, ON_FLOOR)
    return Brain(known, STATION, robot, mission, docking, start=ON_FLOOR), body


def turn(robot: Brain, body: SimulatedBody) -> None:
    robot.sense(body.read())
    for _ in range(120):
        body.act(Command(Twist(0.0, 1.5)))
        robot.sense(body.read())
