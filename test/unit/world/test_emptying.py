"""A station that empties the bin: when it works, what it takes, and what a full bag does."""

from __future__ import annotations

import numpy as np

from roomba.configuration.simulation import SimulatedStation
from roomba.world.emptying import EmptyingStation

STEP = 0.05
CONFIG = SimulatedStation(bag=10.0)


def passed(
    station: EmptyingStation, seconds: float, in_bin: float, *, docked: bool = True
) -> float:
    """Return what it took out of a bin in so long, g."""
    taken = 0.0
    for _ in range(round(seconds / STEP)):
        taken += station.pass_time(STEP, in_bin - taken, is_docked=docked)
    return taken


def test_it_takes_all_out_once_after_its_time() -> None:
    station = EmptyingStation(CONFIG)
    assert passed(station, 60.0, 4.0) == 0.0
    station.is_wanted = True
    assert passed(station, CONFIG.emptying_time - 0.5, 4.0) == 0.0
    assert station.is_at_work
    assert passed(station, 30.0, 4.0) == 4.0
    assert not station.is_at_work
    assert (station.in_bag, station.bag) == (4.0, 0.4)


def test_a_robot_that_leaves_keeps_its_dirt() -> None:
    station = EmptyingStation(CONFIG)
    station.is_wanted = True
    passed(station, CONFIG.emptying_time - 0.5, 4.0)
    assert passed(station, 1.0, 4.0, docked=False) == 0.0
    assert not station.is_at_work
    assert passed(station, 1.0, 4.0) == station.in_bag == 0.0


def test_the_bag_takes_what_it_has_room_for_and_a_full_one_begins_nothing() -> None:
    station = EmptyingStation(CONFIG)
    station.is_wanted = True
    assert passed(station, 20.0, 25.0) == 10.0
    station.is_wanted = False
    passed(station, 1.0, 15.0)
    station.is_wanted = True
    assert passed(station, 20.0, 15.0) == 0.0
    assert (station.bag, station.is_at_work) == (1.0, False)
    station.replace_bag()
    assert passed(station, 20.0, 15.0) == 10.0


def test_what_was_saved_goes_on_as_it_would_have() -> None:
    station, other = EmptyingStation(CONFIG), EmptyingStation(CONFIG)
    station.is_wanted = True
    for seconds in (0.0, 0.5 * CONFIG.emptying_time, CONFIG.emptying_time + 1.0):
        passed(station, seconds, 4.0)
        saved = station.save()
        other.restore(saved)
        assert np.array_equal(other.save(), saved, equal_nan=True)
        assert (other.in_bag, other.is_at_work) == (station.in_bag, station.is_at_work)
        other.restore(saved)
        assert passed(other, 7.0, 4.0) == passed(station, 7.0, 4.0)
        station.restore(saved)
