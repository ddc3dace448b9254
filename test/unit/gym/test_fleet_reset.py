"""A world that is reset must be as one of that seed in a new fleet, and no other may notice."""

import numpy as np
import pytest

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.world.fleet import Fleet
from roomba.world.layers.layer import load_home

CONFIG = SimulatedRobotConfig().with_wheels("worn")
"""Of which more is by the seed than of a new robot: carpets pull it another way in each world."""


@pytest.mark.parametrize("robots", [1, 2])
def test_a_reset_world_is_as_new(robots: int) -> None:
    family, flat = load_home("family", HOMES), load_home("flat", HOMES)
    homes = [family, flat, family]
    new = Fleet(homes, CONFIG, robots_per_home=robots, seeds=[1, 2, 3])
    used = Fleet(homes, CONFIG, robots_per_home=robots, seeds=[7, 8, 9])
    used.put_discs(0, np.array([[2.0, 1.0, 0.05]]))
    twists = np.tile([0.3, 0.4], (3 * robots, 1))
    used.step(twists, 0.05, 600)
    for world, seed in enumerate((1, 2, 3)):
        used.reset_world(world, seed)
    assert used.digest() == new.digest()
    assert used.seeds == new.seeds
    used.step(twists, 0.05, 100)
    new.step(twists, 0.05, 100)
    assert used.digest() == new.digest()


def test_other_worlds_do_not_notice() -> None:
    home = load_home("family", HOMES)
    fleets = [Fleet([home] * 3, CONFIG) for _ in range(2)]
    twists = np.tile([0.3, 0.4], (3, 1))
    for fleet in fleets:
        fleet.step(twists, 0.05, 100)
    fleets[0].reset_world(1, 5)
    for fleet in fleets:
        fleet.step(twists, 0.05, 100)
    reset, other = (fleet.poses.copy() for fleet in fleets)
    assert np.array_equal(reset[[0, 2]], other[[0, 2]])
    assert not np.array_equal(reset[1], other[1])


def test_a_negative_seed_is_refused() -> None:
    with pytest.raises(ValueError, match="seed of 0 or more"):
        Fleet([load_home("studio", HOMES)]).reset_world(0, -1)
