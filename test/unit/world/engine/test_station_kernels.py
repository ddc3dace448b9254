"""The station's halo and beams, and the contacts of the docked robot."""

from __future__ import annotations

import math

import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.sensors import StationConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose, Twist
from roomba.world.catalogue.furniture import STATION_GAP
from roomba.world.engine.state.arrays import Fault, Infrared
from roomba.world.observation import Observation
from roomba.world.simulator import Simulator

CONFIG = SimulatedRobotConfig()
HALO, GREEN, RED = Infrared.HALO, Infrared.GREEN, Infrared.RED
NONE = Infrared(0)
FRONT = CONFIG.body.radius + STATION_GAP
"""m; from the docked robot's middle to the station's front."""


def world_with_station(theta: float = 0.7, **others: object) -> Simulator:
    station = Pose(4.0, 4.0, theta)
    home = room_home(8.0, 8.0, station=station, **others)  # type: ignore[arg-type]
    return Simulator(home, start=Pose(0.5, 0.5, 0.0))


def seen_at(world: Simulator, away: float, degrees: float, heading: float = 0.0) -> Observation:
    """Stand so far from the station's front, at an angle to the left as it looks."""
    front = world.home.station.compose(Pose(FRONT, 0.0, math.pi))
    angle = math.radians(degrees)
    place = front.compose(Pose(away * math.cos(angle), away * math.sin(angle), heading))
    world.put(place)
    return world.step(Twist(), 0.025)


@pytest.mark.parametrize("theta", [0.0, 0.7, -2.5, math.pi])
@pytest.mark.parametrize(
    ("away", "degrees", "expected"),
    [
        (0.8, 0.0, RED | GREEN),
        (0.8, 1.9, RED | GREEN),
        (0.8, -1.9, RED | GREEN),
        (0.8, 2.1, RED),
        (0.8, 19.9, RED),
        (0.8, 20.1, NONE),
        (0.8, -2.1, GREEN),
        (0.8, -19.9, GREEN),
        (0.8, -20.1, NONE),
        (0.8, 180.0, NONE),
        (0.99, 10.0, RED),
        (1.01, 10.0, NONE),
        (0.61, 90.0, NONE),
        (0.59, 90.0, HALO),
        (0.59, -90.0, HALO),
        (0.59, 180.0, HALO),
        (0.59, 10.0, HALO | RED),
        (0.59, -10.0, HALO | GREEN),
        (0.3, 0.0, HALO | RED | GREEN),
    ],
)
def test_red_lies_to_its_left_green_to_its_right_and_the_halo_all_around(
    theta: float, away: float, degrees: float, expected: Infrared
) -> None:
    world = world_with_station(theta)
    for heading in (0.0, 2.0):
        assert seen_at(world, away, degrees, heading).infrared == expected


def test_a_halo_may_reach_farther_than_the_beams() -> None:
    config = SimulatedRobotConfig(station=StationConfig(halo=2.0, beam=1.0))
    world = Simulator(world_with_station().home, config, start=Pose(0.5, 0.5, 0.0))
    assert seen_at(world, 1.9, 5.0).infrared == HALO
    assert seen_at(world, 2.01, 5.0).infrared == NONE


def test_nothing_is_seen_behind_a_wall() -> None:
    # The station looks to -x; a wall stands 0.3 to 0.4 m before it.
    front = 4.0 + FRONT
    wall = (front - 0.4, 3.0, front - 0.3, 5.0)
    for blocks, expected in (((), RED | GREEN), ((wall,), NONE)):
        world = world_with_station(0.0, blocks=blocks)
        assert seen_at(world, 0.8, 0.0).infrared == expected


def test_a_dead_station_sends_nothing_and_charges_no_robot() -> None:
    world = Simulator(room_home())
    seen = world.step(Twist(), 0.025)
    assert seen.infrared == HALO | RED | GREEN
    assert seen.battery.is_docked
    world.inject(Fault.STATION_DEAD, 1.0)
    seen = world.step(Twist(), 0.025)
    assert seen.infrared == NONE
    assert not seen.battery.is_docked
    assert not seen.battery.is_charging


@settings(max_examples=examples(60))
@given(st.floats(-0.02, 0.02), st.floats(-0.02, 0.02), st.floats(-12.0, 12.0))
def test_contacts_touch_near_the_docked_pose_only(dx: float, dy: float, degrees: float) -> None:
    world = world_with_station()
    station = world.home.station
    theta = station.theta + math.radians(degrees)
    world.put(Pose(station.x + dx, station.y + dy, theta))
    is_near = math.hypot(dx, dy) <= CONFIG.simulation.station.position_tolerance
    is_straight = abs(degrees) <= CONFIG.simulation.station.angle_tolerance
    assert world.step(Twist(), 0.025).battery.is_docked == (is_near and is_straight)


def test_a_docked_robot_charges_until_it_is_full_and_leaves_by_driving() -> None:
    world = world_with_station()
    drive(world, 0.0, 0.0, 600.0, 10.0)
    world.put(world.home.station)
    charging = world.step(Twist(), 1.0)
    assert charging.battery.is_docked
    assert charging.battery.is_charging
    assert charging.battery.current > 0.0
    full = drive(world, 0.0, 0.0, 3600.0, 10.0)
    assert full.battery.is_full
    assert not full.battery.is_charging
    assert full.battery.current == 0.0
    away = drive(world, -0.3, 0.0, 1.0)
    assert not away.battery.is_docked
    assert away.battery.current < 0.0
