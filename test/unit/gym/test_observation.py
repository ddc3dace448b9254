import numpy as np
import pytest
from fixtures.homes.rooms import room_home

from roomba.configuration.sensors import LidarConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.gym import RoombaClean
from roomba.gym.observation import (
    BATTERY,
    BIN,
    BUMPER,
    CLIFF,
    GRAINS,
    GYRO,
    LIDAR,
    SIZE,
    STATION,
    VELOCITY,
    Observer,
)
from roomba.world.engine.state.arrays import Fault
from roomba.world.fleet import Fleet
from roomba.world.home.home import DirtSource

PARTS = (LIDAR, BUMPER, CLIFF, VELOCITY, GYRO, BATTERY, GRAINS, BIN, STATION)


def environment(sensors: str = "noisy") -> RoombaClean:
    home = room_home(sources=(DirtSource("dust", 2.5, 2.0, 3.0, 5.0, 0.0),))
    return RoombaClean(home=home, sensors=sensors)


def test_the_parts_are_the_whole_observation() -> None:
    places = [place for part in PARTS for place in range(SIZE)[part]]
    assert places == list(range(SIZE))


def test_the_lidars_sectors_look_ahead_left_back_and_right() -> None:
    seen, _ = environment().reset(seed=0, options={"start": (1.0, 1.5, 0.0)})
    ahead, left, back, right = seen[LIDAR][[0, 9, 18, 27]]
    assert (ahead, left, back, right) == pytest.approx((4.0, 2.5, 1.0, 1.5), abs=0.06)


def test_a_sector_tells_its_nearest_beam_and_numbers_for_what_has_none() -> None:
    fleet = Fleet([room_home()])
    senses = Observer(fleet, max_speed=0.5)
    fleet.ranges[:] = 3.0
    fleet.ranges[0, [355, 84, 95]] = 1.0, 2.0, 0.5
    fleet.ranges[0, 175:185] = np.inf
    fleet.ranges[0, 200] = -np.inf
    lidar = senses.read()[0, LIDAR]
    expected = np.full(36, 3.0)
    expected[[0, 8, 10, 18, 20]] = 1.0, 2.0, 0.5, fleet.config.lidar.max_range, 0.0
    assert lidar == pytest.approx(expected)


def test_a_lidar_that_cannot_be_shared_out_is_refused() -> None:
    config = SimulatedRobotConfig(lidar=LidarConfig(beams=100))
    with pytest.raises(ValueError, match="multiple of 36"):
        RoombaClean(home=room_home(), config=config)


def test_driving_is_told_by_encoders_gyro_and_dirt_sensor() -> None:
    robot = environment("ideal")
    robot.reset(seed=0, options={"start": (1.0, 2.0, 0.0)})
    for _ in range(5):
        seen = robot.step(np.array([0.5, 0.25], np.float32))[0]
    assert seen[VELOCITY] == pytest.approx((0.25, 0.25 * 4.25), rel=1e-3)
    assert seen[GYRO] == pytest.approx(0.25 * 4.25, rel=1e-3)
    assert seen[GRAINS] > 0.0
    assert 0.0 < seen[BIN] < 0.01
    assert 0.99 < seen[BATTERY] < 1.0


def test_bumps_are_felt() -> None:
    robot = environment()
    robot.reset(seed=0, options={"start": (4.6, 2.0, 0.0)})
    for _ in range(5):
        seen = robot.step(np.array([1.0, 0.0], np.float32))[0]
    assert seen[BUMPER].tolist() == [1.0, 1.0]


def test_drops_are_seen() -> None:
    robot = environment()
    robot.reset(seed=0, options={"start": (2.0, 2.0, 0.0)})
    robot.fleet.inject(0, Fault.CLIFF_DIRTY, 1.0)
    assert robot.step(np.zeros(2, np.float32))[0][CLIFF].tolist() == [1.0] * 4


def test_the_stations_beams_are_seen_before_it() -> None:
    robot = environment()
    near, _ = robot.reset(seed=0, options={"start": (0.4, 0.5, 0.0)})
    far, _ = robot.reset(seed=0, options={"start": (4.0, 3.0, 0.0)})
    assert near[STATION].tolist() == [1.0, 1.0, 1.0]
    assert far[STATION].tolist() == [0.0, 0.0, 0.0]
