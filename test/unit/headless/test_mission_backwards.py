"""A robot whose contacts are behind it, before a station without beams: a Neato, simulated."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.commands.trials.runs import mission_config
from roomba.configuration.simulation import SimulatedRobotConfig, load_simulated_config
from roomba.files.shipped import CONFIGURATION, HOMES
from roomba.geometry import Pose, wrap_angle
from roomba.headless.body import lidar_model
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator


@pytest.fixture(scope="module")
def neato() -> SimulatedRobotConfig:
    robots = CONFIGURATION / "robots"
    return load_simulated_config(robots / "neato.yaml", CONFIGURATION / "simulation.yaml")


@pytest.fixture(scope="module")
def home(neato: SimulatedRobotConfig) -> Home:
    return load_home("studio", HOMES, neato.body)


def test_it_cleans_and_docks_with_its_back_ahead(neato: SimulatedRobotConfig, home: Home) -> None:
    robot = HeadlessMission(home, neato, mission_config(neato), seed=1)
    record = robot.clean()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.covered >= 0.97 * record.result.wanted
    assert robot.is_home
    assert robot.seen.battery.is_docked
    turned = wrap_angle(robot.seen.pose.theta - home.station.theta)
    assert abs(turned) == pytest.approx(math.pi, abs=math.radians(8.0))


def test_its_contacts_touch_with_its_back_to_the_station_alone(
    neato: SimulatedRobotConfig, home: Home
) -> None:
    world = Simulator(home, neato, seed=1)
    world.advance(world.observe().odometry_twist, 0.025, 1)
    assert world.observe().battery.is_docked
    world.put(home.station)
    world.advance(world.observe().odometry_twist, 0.025, 1)
    assert not world.observe().battery.is_docked


def test_a_station_without_beams_sends_out_nothing(neato: SimulatedRobotConfig, home: Home) -> None:
    world = Simulator(home, neato, seed=1)
    for away in (0.3, 0.5, 0.8):
        world.put(home.station.compose(Pose(-away, 0.0, math.pi)))
        world.advance(world.observe().odometry_twist, 0.025, 1)
        assert not world.observe().infrared


def test_its_lidar_sits_behind_the_wheels(neato: SimulatedRobotConfig, home: Home) -> None:
    ideal = neato.with_sensors("ideal")
    still = ideal.lidar.model_copy(update={"sweep_time": 0.0, "mount_ahead": -0.1})
    middle = still.model_copy(update={"mount_ahead": 0.0})
    place = home.station.compose(Pose(-1.0, 0.0, 0.0))
    behind = place.compose(Pose(-0.1, 0.0, 0.0))
    seen = []
    for lidar, pose in ((still, place), (middle, behind)):
        world = Simulator(home, ideal.model_copy(update={"lidar": lidar}), seed=1, start=pose)
        world.advance(world.observe().odometry_twist, 0.025, 20)
        seen.append(world.ranges.copy())
    both = np.isfinite(seen[0]) & np.isfinite(seen[1])
    assert both.sum() > 200
    assert np.abs(seen[0][both] - seen[1][both]).max() < 0.002
    assert lidar_model(still).mount.tolist() == [-0.1, 0.0, 0.0]
