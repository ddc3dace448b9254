"""Crumbs fall around their sources, at their rates, on the floor."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import EXACT, drive
from numpy.typing import NDArray

from roomba.configuration.simulation import (
    SimulatedRobotConfig,
    SimulatedSurroundings,
    SimulationConfig,
)
from roomba.world.home.home import DirtSource
from roomba.world.simulator import Simulator

HOUR = 3600.0
CRUMB = SimulatedSurroundings().crumb


def fallen(world: Simulator, hours: float) -> NDArray[np.int64]:
    """Let time pass while the robot stands and its brush is off; return what fell, by cells."""
    before = world.dirt.micrograms.copy()
    drive(world, 0.0, 0.0, hours * HOUR, 60.0)
    return world.dirt.micrograms - before


@pytest.mark.parametrize("rate", [0.5, 30.0])
def test_each_source_has_its_rate_and_its_spread(rate: float) -> None:
    world = Simulator(
        room_home(10.0, 8.0, sources=[DirtSource("one", 5.0, 4.0, 0.5, 0.0, rate)]), EXACT
    )
    hours = 4000.0 / (rate / 0.002)
    fell = fallen(world, hours)
    assert fell.sum() == pytest.approx(hours * rate * 1e6, rel=0.06)
    assert not (fell % CRUMB).any()
    rows, columns = np.nonzero(fell)
    x, y = world.dirt.frame.centre_of(rows, columns)  # type: ignore[arg-type]
    weights = fell[rows, columns]
    middle = np.average(x, weights=weights), np.average(y, weights=weights)
    assert middle == pytest.approx((5.0, 4.0), abs=0.03)
    spread = np.average((x - 5.0) ** 2, weights=weights) ** 0.5
    assert spread == pytest.approx(0.5, rel=0.06)


def test_a_source_without_a_rate_lets_nothing_fall() -> None:
    world = Simulator(room_home(sources=[DirtSource("once", 2.0, 2.0, 0.3, 5.0, 0.0)]), EXACT)
    assert world.brought_in == 5_000_000
    assert not fallen(world, 1000.0).any()
    assert world.brought_in == 5_000_000


def test_crumbs_lie_on_free_floor_only_and_all_are_counted() -> None:
    home = room_home(
        blocks=((2.0, 1.0, 3.0, 3.0),),
        stairs=((3.5, 0.0, 5.0, 4.0),),
        sources=[DirtSource("wide", 3.2, 2.0, 0.6, 0.0, 50.0)],
    )
    world = Simulator(home, EXACT)
    fell = fallen(world, 1.0)
    assert fell.sum() == world.brought_in > 40_000_000
    assert not fell[~world.dirt.floor].any()


def test_how_much_has_fallen_does_not_depend_on_the_step() -> None:
    sources = [DirtSource("one", 2.0, 2.0, 0.3, 0.0, 40.0)]
    brought = []
    for dt in (0.5, 5.0, 60.0):
        world = Simulator(room_home(sources=sources), EXACT, seed=4)
        drive(world, 0.0, 0.0, 600.0, dt)
        brought.append((world.brought_in, world.dirt.micrograms.tobytes()))
    assert brought[0] == brought[1] == brought[2]
    assert brought[0][0] > 0


def test_crumbs_are_as_large_as_configured() -> None:
    surroundings = SimulatedSurroundings(crumb=700)
    config = SimulatedRobotConfig(simulation=SimulationConfig(surroundings=surroundings))
    sources = [DirtSource("one", 2.0, 2.0, 0.3, 0.0, 30.0)]
    fell = fallen(Simulator(room_home(sources=sources), config), 1.0)
    assert fell.sum() == pytest.approx(30e6, rel=0.1)
    assert not (fell % 700).any()
