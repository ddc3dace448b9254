"""Whole explorations of small homes: the map that comes of it, and what happens meanwhile.

The quality of a map is measured against the true home, never against the robot's belief.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from fixtures.homes.free_walls import home_with, straight_wall
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import IDEAL, NOISY
from fixtures.robots.mapped import CUPBOARD, SHELF, wrong_cells
from fixtures.robots.missions import HOME, TWO_ROOMS

from roomba.configuration.mapping import MappingConfig
from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.grid import FREE
from roomba.headless.mission import HeadlessMission
from roomba.headless.records import ExploreRecord
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.phases.machine import Event
from roomba.perception.localization.estimate import Knowledge
from roomba.vocabulary import Phase
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.home import Home

HOMES = [pytest.param(HOME, id="one room"), pytest.param(TWO_ROOMS, id="two rooms")]
WORST = 0.03
"""m; farther from its true place it never is."""


def free_area(home: Home) -> float:
    return float((~home.solid).sum()) * home.frame.resolution**2


def assert_explored(robot: HeadlessMission, record: ExploreRecord, home: Home) -> None:
    assert (record.result.outcome, record.result.message) == (CleanOutcome.COMPLETED, "")
    assert robot.mission.state.phase is Phase.DOCKED
    assert robot.seen.battery.is_docked
    assert wrong_cells(record.occupancy, home) == (0, 0)
    # The walls are drawn where they are, so the floor is as large as it is.
    known = (record.occupancy.values == FREE).sum() * record.occupancy.frame.resolution**2
    assert known == pytest.approx(free_area(home), rel=0.03)
    assert record.result.known == pytest.approx(known, rel=0.05)
    away = np.hypot(*(record.poses[:, 1:3] - record.believed[:, 1:3]).T)
    assert away.max() < WORST


@pytest.mark.parametrize("seed", [1, 2])
def test_a_mirror_that_it_drove_against_is_the_end_of_the_room(seed: int) -> None:
    mirror = straight_wall([(0.8, 3.98), (2.6, 3.98)], "mirror", 0.02)
    home = home_with([mirror], [CUPBOARD, SHELF], Pose(0.2, 2.5, np.pi))
    robot = HeadlessMission(home, NOISY, known=MappingConfig(), seed=seed)
    record = robot.explore()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert wrong_cells(record.occupancy, home) == (0, 0)
    assert record.result.known == pytest.approx(free_area(home), rel=0.05)
    # It did not know the mirror before, and once it did it had no wish to get behind it.
    assert 1 <= record.hits <= 3


def until(robot: HeadlessMission, is_so: Callable[[], bool], seconds: float = 300.0) -> None:
    ends = robot.seen.time + seconds
    while not is_so():
        assert robot.seen.time < ends, f"not within {seconds} s: {robot.mission.state}"
        robot.tick()


def in_phase(robot: HeadlessMission, phase: Phase) -> Callable[[], bool]:
    return lambda: robot.mission.state.phase is phase


@pytest.mark.parametrize("config", [IDEAL, NOISY], ids=["ideal", "noisy"])
@pytest.mark.parametrize("home", HOMES)
def test_it_maps_the_home_without_a_hit_and_docks(home: Home, config: SimulatedRobotConfig) -> None:
    robot = HeadlessMission(home, config, seed=1, known=MappingConfig())
    record = robot.explore()
    assert_explored(robot, record, home)
    assert record.hits == 0
    assert record.wall > 0.0
    assert robot.mission.context.is_growing
    poses = record.poses
    assert np.diff(poses[:, 0]) == pytest.approx(0.05)
    way = float(np.hypot(*np.diff(poses[:, 1:3], axis=0).T).sum())
    assert record.result.distance == pytest.approx(way, rel=0.03)
    assert record.result.duration == pytest.approx(poses[-1, 0] - poses[0, 0], abs=1.0)
    speed = np.hypot(*np.diff(poses[:, 1:3], axis=0).T) / 0.05
    assert speed.max() <= 1.02 * robot.config.exploring.speed


def test_it_goes_into_all_rooms() -> None:
    """Three in a row: of the last one nothing is seen from the station."""
    walls = [(x, low, x + 0.1, high) for x, low, high in ((1.6, 0.0, 0.9), (1.6, 1.7, 2.4))]
    walls += [(x, low, x + 0.1, high) for x, low, high in ((3.3, 0.0, 1.6), (3.3, 2.35, 2.4))]
    home = room_home(5.0, 2.4, walls, station=Pose(0.2, 1.2, np.pi))
    robot = HeadlessMission(home, seed=2, known=MappingConfig())
    record = robot.explore()
    assert_explored(robot, record, home)
    assert record.poses[:, 1].max() > 2.6


def test_the_same_seed_gives_the_same_trace_and_another_one_another() -> None:
    records = [
        HeadlessMission(HOME, seed=seed, known=MappingConfig()).explore() for seed in (3, 3, 4)
    ]
    traces = [record.poses.tobytes() for record in records]
    assert traces[0] == traces[1]
    assert traces[0] != traces[2]
    assert records[0].occupancy.values.tobytes() == records[1].occupancy.values.tobytes()
    assert records[0].believed.tobytes() == records[1].believed.tobytes()


def test_with_a_low_battery_it_goes_home_charges_and_goes_on() -> None:
    robot = HeadlessMission(TWO_ROOMS, seed=1, known=MappingConfig())
    mission = robot.mission
    mission.explore(robot.senses())
    until(robot, in_phase(robot, Phase.EXPLORING))
    robot.simulator.set_charge(robot.config.energy.reserve + 0.0001)
    until(robot, in_phase(robot, Phase.RETURNING))
    began = robot.seen.time
    until(robot, in_phase(robot, Phase.CHARGING))
    # It turned and drove home at once, though the map grew meanwhile.
    assert robot.seen.time - began < 40.0
    assert robot.seen.battery.is_docked
    assert mission.take_exploration() is None
    robot.simulator.set_charge(robot.config.energy.full_enough)
    until(robot, in_phase(robot, Phase.EXPLORING))
    until(robot, in_phase(robot, Phase.DOCKED))
    result = mission.take_exploration()
    assert result is not None
    assert result.outcome is CleanOutcome.COMPLETED
    made = robot.mapper.finish()
    assert wrong_cells(made, TWO_ROOMS) == (0, 0)
    assert (made.values == FREE).sum() * 0.05**2 == pytest.approx(free_area(TWO_ROOMS), rel=0.03)


def test_paused_and_resumed_it_maps_all() -> None:
    robot = HeadlessMission(TWO_ROOMS, seed=2, known=MappingConfig())
    mission = robot.mission
    mission.explore(robot.senses())
    until(robot, in_phase(robot, Phase.EXPLORING))
    mission.command(Event.PAUSE, robot.senses())
    for _ in range(20):
        robot.tick()
    at = robot.simulator.pose
    for _ in range(40):
        robot.tick()
    assert robot.simulator.pose.distance_to(at.x, at.y) < 0.002
    mission.command(Event.RESUME, robot.senses())
    until(robot, in_phase(robot, Phase.DOCKED))
    made = robot.mapper.finish()
    assert (made.values == FREE).sum() * 0.05**2 == pytest.approx(free_area(TWO_ROOMS), rel=0.03)


def test_stopped_it_stands_and_what_it_mapped_stays() -> None:
    robot = HeadlessMission(TWO_ROOMS, seed=2, known=MappingConfig())
    robot.mission.explore(robot.senses())
    until(robot, in_phase(robot, Phase.EXPLORING))
    robot.mission.command(Event.STOP, robot.senses())
    result = robot.mission.take_exploration()
    assert result is not None
    assert result.outcome is CleanOutcome.STOPPED
    for _ in range(20):
        robot.tick()
    assert robot.mission.state.phase is Phase.IDLE
    assert wrong_cells(robot.mapper.occupancy(), TWO_ROOMS)[1] == 0
    # It may be told to go on from there.
    record = robot.explore()
    assert_explored(robot, record, TWO_ROOMS)


@pytest.mark.parametrize("lidar", [EXACT_LIDAR, "lds_02", "rplidar_a1"])
@pytest.mark.parametrize(("place", "seed"), [((1.4, 1.9), 1), ((1.4, 1.9), 2), ((1.8, 1.7), 1)])
def test_things_that_stand_about_are_mapped_like_walls(
    place: tuple[float, float], seed: int, lidar: str
) -> None:
    """And not touched, though their round sides stand before the cells that the map has of them."""
    config = SimulatedRobotConfig().with_lidar(lidar)
    robot = HeadlessMission(HOME, config, seed=seed, known=MappingConfig())
    robot.simulator.place_obstacle(*place, 0.12)
    record = robot.explore()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.hits == 0
    row, column = record.occupancy.frame.cell_of(*place)
    assert (record.occupancy.values[row - 3 : row + 4, column - 3 : column + 4] > FREE).sum() >= 4


def test_a_lidar_that_fails_for_a_while_does_not_spoil_the_map() -> None:
    robot = HeadlessMission(TWO_ROOMS, seed=1, known=MappingConfig())
    robot.mission.explore(robot.senses())
    until(robot, in_phase(robot, Phase.EXPLORING))
    robot.simulator.inject(Fault.LIDAR_BLOCKED, 1.0)
    for _ in range(30):
        robot.tick()
    assert robot.mapper.estimate.knowledge is Knowledge.ROUGH
    robot.simulator.inject(Fault.LIDAR_BLOCKED, 0.0)
    until(robot, in_phase(robot, Phase.DOCKED))
    assert wrong_cells(robot.mapper.finish(), TWO_ROOMS) == (0, 0)


def test_a_dead_robot_refuses_and_drives_nowhere() -> None:
    robot = HeadlessMission(HOME, known=MappingConfig())
    robot.mission.command(Event.EMERGENCY, robot.senses(), "pressed")
    with pytest.raises(CommandRefusedError, match="cannot explore now"):
        robot.explore()
