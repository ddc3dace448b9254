"""What is felt again and again and never seen: joined, counted, offered, ignored."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.mission import LowThingsConfig
from roomba.geometry import Pose
from roomba.perception.rooms.low_things import MOST_LOW_THINGS, LowThing, LowThings
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones

CONFIG = LowThingsConfig(same=0.25, longest=1.5, offered=3, margin=0.08)
places = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def felt(*at: tuple[float, float]) -> LowThings:
    things = LowThings()
    for x, y in at:
        things = things.felt_at(x, y, CONFIG)
    return things


def test_touches_beside_each_other_are_of_one_thing() -> None:
    (thing,) = felt((1.0, 1.0), (1.2, 1.1), (1.4, 1.0)).all
    assert (thing.x0, thing.y0, thing.x1, thing.y1, thing.times) == (1.0, 1.0, 1.4, 1.1, 3)
    assert len(felt((1.0, 1.0), (1.3, 1.0)).all) == 2


def test_what_lies_between_two_things_joins_them() -> None:
    (thing,) = felt((1.0, 1.0), (1.4, 1.0), (1.2, 1.2)).all
    assert (thing.x0, thing.y0, thing.x1, thing.y1, thing.times) == (1.0, 1.0, 1.4, 1.2, 3)
    ignored = felt((1.0, 1.0), (1.4, 1.0)).ignoring(1.0, 1.0).felt_at(1.2, 1.0, CONFIG)
    assert sorted((each.times, each.is_ignored) for each in ignored.all) == [(1, False), (2, True)]


def test_a_thing_grows_no_longer_than_things_are() -> None:
    line = [(0.2 * number, 0.0) for number in range(20)]
    things = felt(*line).all
    assert len(things) > 1
    assert max(thing.longest for thing in things) <= CONFIG.longest


@given(st.lists(places, max_size=60))
def test_every_touch_is_counted_once_within_the_thing_that_it_is_of(
    touches: list[tuple[float, float]],
) -> None:
    things = felt(*touches)
    assert sum(thing.times for thing in things.all) == len(touches)
    for x, y in touches:
        here = LowThing(x, y, x, y)
        assert min(thing.away(here) for thing in things.all) == 0.0


def test_what_was_felt_often_is_offered_with_a_margin() -> None:
    twice = felt((1.0, 1.0), (1.2, 1.0))
    assert twice.offers(Zones(), CONFIG) == ()
    (offer,) = twice.felt_at(1.1, 1.0, CONFIG).offers(Zones(), CONFIG)
    assert offer.times == 3
    assert offer.corners[0] == pytest.approx((0.92, 0.92))
    assert offer.corners[2] == pytest.approx((1.28, 1.08))
    zone = Zone("cable", ZoneKind.NO_GO, offer.corners)
    assert twice.felt_at(1.1, 1.0, CONFIG).offers(Zones((zone,)), CONFIG) == ()
    carpet = Zone("rug", ZoneKind.CARPET, offer.corners)
    assert twice.felt_at(1.1, 1.0, CONFIG).offers(Zones((carpet,)), CONFIG) != ()


def test_a_single_place_makes_a_zone_that_is_one() -> None:
    (offer,) = felt(*[(1.0, 1.0)] * 3).offers(Zones(), CONFIG)
    Zone("cable", ZoneKind.NO_GO, offer.corners)


def test_what_is_ignored_is_never_offered_again() -> None:
    things = felt(*[(1.0, 1.0)] * 3, *[(2.0, 2.0)] * 3).ignoring(1.0, 1.0)
    for _ in range(5):
        things = things.felt_at(1.1, 1.0, CONFIG)
    (offer,) = things.offers(Zones(), CONFIG)
    assert offer.corners[0][0] > 1.5
    with pytest.raises(ValueError, match="within something that was felt"):
        things.ignoring(0.0, 0.0)
    with pytest.raises(ValueError, match="within something"):
        LowThings().ignoring(0.0, 0.0)


def test_of_too_many_those_go_that_were_felt_the_fewest_times() -> None:
    often = LowThing(-9.0, 0.0, -9.0, 0.0, 7)
    refused = LowThing(-8.0, 0.0, -8.0, 0.0, 1, is_ignored=True)
    things = LowThings((often, refused))
    for number in range(2 * MOST_LOW_THINGS):
        things = things.felt_at(float(number), 0.0, CONFIG)
    assert len(things.all) == MOST_LOW_THINGS
    assert {often, refused} < set(things.all)


def test_in_another_frame_a_thing_is_where_it_was() -> None:
    moved = Pose(1.0, 2.0, 0.05)
    (thing,) = felt((1.0, 1.0), (1.2, 1.1)).ignoring(1.1, 1.0).moved(moved).all
    for x, y in ((1.0, 1.0), (1.2, 1.1)):
        there = moved.compose(Pose(x, y))
        assert thing.x0 - 1e-9 <= there.x <= thing.x1 + 1e-9
        assert thing.y0 - 1e-9 <= there.y <= thing.y1 + 1e-9
    assert thing.longest < 0.22
    assert (thing.times, thing.is_ignored) == (2, True)
