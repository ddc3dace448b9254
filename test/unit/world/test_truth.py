"""The truth about a home, with the changes that were made to it."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.rooms import room_home

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.geometry import STANDSTILL
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.doors import with_leaves
from roomba.world.home.home import Home
from roomba.world.home.turned import turned_home, with_steps
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator
from roomba.world.truth import HomeTruth


@pytest.fixture(scope="module")
def home() -> Home:
    return with_leaves(load_home("flat", HOMES))


@pytest.fixture
def world(home: Home) -> Simulator:
    return Simulator(home, SimulatedRobotConfig(), seed=1)


def test_what_is_put_down_is_told_by_its_outline(home: Home, world: Simulator) -> None:
    truth = HomeTruth(home)
    before = truth.now(world)
    world.place_obstacle(1.5, 1.5, 0.1)
    (ring,) = set(truth.now(world).things) - set(before.things)
    assert np.hypot(*(np.array(ring) - (1.5, 1.5)).T) == pytest.approx(0.1)
    world.remove_obstacles()
    assert truth.now(world) == before


def test_doors_tell_where_they_are_and_whether_they_are_shut(home: Home, world: Simulator) -> None:
    truth = HomeTruth(home)
    assert truth.has_doors
    doors = truth.now(world).doors
    assert [door.name for door in doors] == [door.name for door in home.doors]
    assert not any(door.is_shut for door in doors)
    left, low, right, high = doors[0].opening
    assert left < right
    assert low < high
    world.set_door(doors[0].name, is_shut=True)
    world.advance(STANDSTILL, 0.025, 4)
    assert [door.is_shut for door in truth.now(world).doors].count(True) == 1


def test_a_lifted_robot_is_told(home: Home, world: Simulator) -> None:
    world.inject(Fault.LIFTED, 1.0)
    assert HomeTruth(home).now(world).is_lifted


def test_dirt_is_a_share_of_the_dirtiest_floor(home: Home, world: Simulator) -> None:
    truth = HomeTruth(home)
    before = truth.dirt(world)
    assert before is not None
    world.spill(1.5, 1.5, 0.2, 20.0)
    told = truth.dirt(world)
    assert told is not None
    frame, share = told
    assert share.shape == frame.shape
    assert share.min() >= 0.0
    assert share.max() == 1.0
    row, column = np.argwhere(share > before[1] + 0.2).mean(axis=0)
    assert frame.origin_x + (column + 0.5) * frame.resolution == pytest.approx(1.5, abs=0.1)
    assert frame.origin_y + (row + 0.5) * frame.resolution == pytest.approx(1.5, abs=0.1)


def test_a_home_with_free_walls_tells_its_dirt_and_a_turned_one_does_not() -> None:
    slanted, turned = with_steps(room_home()), turned_home(room_home(), 0.3)
    told = HomeTruth(slanted).dirt(Simulator(slanted))
    assert told is not None
    assert told[0].extent == slanted.frame.extent
    assert HomeTruth(turned).dirt(Simulator(turned)) is None
