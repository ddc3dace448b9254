import numpy as np
import pytest
from fixtures.homes.free_walls import home_with, straight_wall
from fixtures.homes.rooms import room_home

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import HomeError
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.gym.floor import Coverage, FloorDistances
from roomba.world.fleet import Fleet
from roomba.world.home.turned import turned_home
from roomba.world.layers.layer import load_home

CONFIG = SimulatedRobotConfig()


def test_the_brush_does_not_reach_the_walls() -> None:
    floor = FloorDistances.of(room_home(3.0, 2.0), CONFIG)
    # The body's middle stays 0.174 m away, of which the brush covers 0.1 m: no first row of cells.
    inner = (3.0 - 2 * 0.05) * (2.0 - 2 * 0.05)
    assert floor.reachable.sum() * 0.05**2 == pytest.approx(inner, rel=0.01)
    x, y = floor.places.T
    assert (x.min(), x.max()) == pytest.approx((0.175, 2.825))
    assert (y.min(), y.max()) == pytest.approx((0.175, 1.825))


def test_what_lies_behind_a_wall_is_not_reached() -> None:
    parted = room_home(blocks=[(2.0, 0.0, 2.1, 4.0)])
    assert FloorDistances.of(parted, CONFIG).places[:, 0].max() < 2.0
    gap = room_home(blocks=[(2.0, 0.0, 2.1, 3.5)])
    assert FloorDistances.of(gap, CONFIG).places[:, 0].max() > 4.5


def test_what_lies_behind_a_wall_free_of_the_grid_is_not_reached_in_a_turned_home_either() -> None:
    parted = home_with([straight_wall([(2.4, -0.1), (2.6, 4.1)])])
    floor = FloorDistances.of(parted, CONFIG)
    assert 2.0 < floor.places[:, 0].max() < 2.6
    turned = FloorDistances.of(turned_home(parted.exact, 0.5), CONFIG)
    assert np.array_equal(turned.places, floor.places)
    assert np.array_equal(turned.reachable, floor.reachable)


def test_a_station_without_floor_before_it_is_refused() -> None:
    with pytest.raises(HomeError, match=r"within 0\.5 m of the docked robot"):
        FloorDistances.of(room_home(blocks=[(0.0, 0.0, 2.0, 2.0)]), CONFIG)


def test_covering_every_place_covers_all() -> None:
    floor = FloorDistances.of(room_home(3.0, 2.0), CONFIG)
    coverage = Coverage(floor, robots=2)
    for x, y in floor.places.tolist():
        coverage.add(np.array([[x, y, 0.0], [1.0, 1.0, 0.0]]))
    everything, a_spot = coverage.shares.tolist()
    assert everything == 1.0
    # At the corner of four cells: 4 by 4 without their corners lie within 0.1 m.
    assert a_spot == pytest.approx(12 / floor.reachable.sum())
    coverage.forget(0)
    assert coverage.shares.tolist() == [0.0, a_spot]


@pytest.mark.parametrize("name", ["apartment", "flat", "studio", "family", "lshape"])
def test_the_robot_fits_wherever_it_may_start(name: str) -> None:
    home = load_home(name, HOMES)
    floor, fleet = FloorDistances.of(home, CONFIG), Fleet([home], CONFIG)
    places = floor.places[:: max(1, len(floor.places) // 40)]
    fits = 0
    for x, y in places.tolist():
        try:
            fleet.put(0, Pose(x, y, 0.0))
            fits += 1
        except HomeError:
            continue
    assert fits > 0.9 * len(places)
