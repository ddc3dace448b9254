"""Homes that a seed makes."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.commands.trials.homes import rooms_of, with_doors_shut
from roomba.configuration.body import BodyConfig
from roomba.world.home.raster import largest_component, where_body_fits
from roomba.world.random.home import random_home
from roomba.world.random.walls import random_openings, random_rooms

BODY = BodyConfig()
SEEDS = range(6)


def test_the_same_seed_makes_the_same_home_and_another_one_another() -> None:
    one, again, other = random_home(3, BODY), random_home(3, BODY), random_home(4, BODY)
    assert np.array_equal(one.solid, again.solid)
    assert one.station == again.station
    assert one.furniture == again.furniture
    assert one.dirt_sources == again.dirt_sources
    assert one.solid.shape != other.solid.shape or not np.array_equal(one.solid, other.solid)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_home_has_floor_rooms_furniture_and_a_station_with_room_for_the_body(seed: int) -> None:
    home = random_home(seed, BODY)
    assert 8.0 < np.count_nonzero(~home.solid) * home.frame.resolution**2 < 130.0
    assert home.rooms
    assert len(home.furniture) > 1
    row, column = home.frame.cell_of(home.station.x, home.station.y)
    fits = where_body_fits(home.frame, home.solid, BODY.radius)
    assert fits[row, column]
    assert largest_component(fits)[row, column]
    assert set(rooms_of(home).names) == {room.name for room in home.rooms}


def test_doors_lead_to_every_room() -> None:
    for seed in range(200):
        random = np.random.default_rng(seed)
        rooms = random_rooms(random)
        reached, openings = {0}, random_openings(rooms, random)
        for _ in rooms:
            for door in openings:
                if reached & {door.first, door.second}:
                    reached |= {door.first, door.second}
        assert reached == set(range(len(rooms))), seed


def test_shut_doors_are_solid_and_the_map_does_not_know() -> None:
    home = next(home for seed in SEEDS if (home := random_home(seed, BODY)).doors)
    shut = with_doors_shut(home)
    assert np.count_nonzero(shut.solid) > np.count_nonzero(home.solid)
    assert np.array_equal(shut.map.values, home.map.values)
    assert not any(door.is_open for door in shut.doors)
