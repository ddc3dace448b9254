"""One clean, piece by piece, with a robot that is wherever its path leads."""

from __future__ import annotations

import json

import numpy as np
import pytest
from fixtures.robots.driven_cleans import HERE, ahead, cleaning, context, drive, finish
from fixtures.robots.missions import DEN, HALL, HOME, TWO_ROOMS

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.mission import MissionConfig
from roomba.mission.cleaning.result import MissReason
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.perception.swept.dirt_map import DirtMap
from roomba.vocabulary import CleanMode


def test_one_path_driven_exactly_is_all() -> None:
    clean = cleaning()
    assert clean.ledger.coverage.fraction == 0.0
    wanted = clean.ledger.left
    assert wanted == pytest.approx(clean.ledger.coverage.wanted_area)
    assert finish(clean, []) == 1
    assert clean.ledger.coverage.fraction > 0.995
    assert clean.ledger.left == 0.0
    assert clean.missed([], True) == ()


def test_what_was_not_driven_is_planned_again() -> None:
    clean = cleaning()
    points = clean.next_path(HERE, [])
    assert points is not None
    here = drive(clean, points, 0.5)
    clean.interrupted(ahead(1.0))
    left = clean.ledger.left
    assert 0.1 < left / clean.ledger.coverage.wanted_area < 0.9
    again = clean.next_path(here, [])
    assert again is not None
    # Not everything anew.
    length = [float(np.hypot(*np.diff(way, axis=0).T).sum()) for way in (points, again)]
    assert length[1] < 0.9 * length[0]
    drive(clean, again)
    assert clean.ledger.coverage.fraction > 0.995


def test_rounds_that_gain_nothing_come_to_an_end() -> None:
    clean = cleaning()
    rounds = 0
    while clean.next_path(HERE, []) is not None and rounds < 20:
        rounds += 1
    assert clean.ledger.stage is None
    assert 1 <= rounds <= MissionConfig().cleaning.most_rounds + 1
    (missed,) = clean.missed([], True)
    assert missed.reason is MissReason.LEFT_OVER
    assert missed.area == pytest.approx(clean.ledger.coverage.wanted_area)
    assert clean.missed([], False)[0].reason is MissReason.STOPPED


def test_a_path_that_was_given_up_is_no_round() -> None:
    clean = cleaning()
    for _ in range(MissionConfig().cleaning.most_rounds + 3):
        assert clean.next_path(HERE, []) is not None
        clean.cut_off()
    paths = 0
    while clean.next_path(HERE, []) is not None and paths < 100:
        clean.cut_off()
        paths += 1
    assert 0 < paths < 50


def test_rooms_are_its_stages() -> None:
    place = context(TWO_ROOMS)
    request = CleanRequest(CleanMode.ROOMS, rooms=(DEN, HALL, DEN), in_order=True)
    clean = cleaning(request, place)
    assert [stage.name for stage in clean.ledger.stages] == [DEN, HALL]
    assert (clean.ledger.stages[0].floor == (place.coverable() & place.in_room(DEN))).all()
    one = cleaning(CleanRequest(CleanMode.ROOMS, rooms=(DEN,)), place)
    assert (one.ledger.coverage.wanted == clean.ledger.stages[0].floor).all()


def test_passes_are_stages_and_each_sweeps_all_anew() -> None:
    clean = cleaning(CleanRequest(passes=3))
    wanted = clean.ledger.coverage.wanted_area
    assert clean.ledger.left == pytest.approx(3.0 * wanted)
    for number in range(3):
        assert clean.ledger.stage_number == number
        points = clean.next_path(HERE, [])
        assert points is not None
        assert clean.ledger.coverage.fraction == 0.0
        drive(clean, points)
        assert clean.ledger.coverage.fraction > 0.995
        assert np.count_nonzero(clean.ledger.clean) > 0.995 * clean.ledger.coverage.wanted_cells
        if number < 2:
            assert clean.next_path(HERE, []) is not None
            assert clean.ledger.stage_number == number + 1
            # What was clean once stays told as clean.
            assert np.count_nonzero(clean.ledger.clean) > 0.995 * clean.ledger.coverage.wanted_cells
            clean.interrupted(ahead(1.0))
    assert clean.next_path(HERE, []) is None


def test_the_dirtiest_room_comes_first_and_all_are_cleaned() -> None:
    place = context(TWO_ROOMS)
    for dirty, x in ((DEN, 3.0), (HALL, 0.5)):
        dirt = DirtMap(place.occupancy)
        dirt.note(x, 1.0, 500.0, 0.3)
        dirt.end_run()
        clean = cleaning(CleanRequest(CleanMode.DIRTIEST), place, dirt)
        assert clean.ledger.stages[0].name == dirty
        floor = np.logical_or.reduce([stage.floor for stage in clean.ledger.stages])
        assert (floor == place.coverable()).all()


def test_along_edges_there_is_less_to_do() -> None:
    edges, whole = cleaning(CleanRequest(CleanMode.EDGES)), cleaning()
    assert 0.2 < edges.ledger.coverage.wanted_area / whole.ledger.coverage.wanted_area < 0.7
    assert not (edges.ledger.coverage.wanted & ~whole.ledger.coverage.wanted).any()
    assert finish(edges, []) <= 3
    assert edges.ledger.coverage.fraction > 0.95


def test_zones_are_cut_to_the_floor_that_there_is() -> None:
    clean = cleaning(CleanRequest(CleanMode.ZONES, zones=((-5.0, -5.0, 1.0, 5.0),)))
    x = HOME.map.frame.origin_x + (np.nonzero(clean.ledger.coverage.wanted)[1] + 0.5) * 0.01
    assert x.max() < 1.0
    assert not (clean.ledger.coverage.wanted & ~context().coverable()).any()


@pytest.mark.parametrize(
    "request_",
    [
        CleanRequest(CleanMode.ZONES, zones=((9.0, 9.0, 10.0, 10.0),)),
        CleanRequest(CleanMode.SPOT, spot=(20.0, 20.0)),
    ],
)
def test_nothing_to_clean_is_refused(request_: CleanRequest) -> None:
    with pytest.raises(CleanRefusedError, match="got none"):
        cleaning(request_)


def test_with_another_context_it_goes_on_and_wants_less() -> None:
    clean = cleaning()
    points = clean.next_path(HERE, [])
    assert points is not None
    drive(clean, points, 0.3)
    swept = clean.ledger.coverage.swept.copy()
    wall = Zone("wall", ZoneKind.WALL, ((1.5, 0.0), (1.5, 2.5)))
    walled = context(zones=Zones((wall,)))
    clean.use_context(walled, DirtMap(walled.occupancy))
    clean.interrupted(ahead(1.0))
    assert (clean.ledger.coverage.swept == swept).all()
    assert not (clean.ledger.coverage.wanted & ~walled.coverable()).any()
    assert finish(clean, []) >= 1
    assert clean.ledger.coverage.fraction > 0.99
    assert clean.ledger.coverage.swept_cells == np.count_nonzero(
        clean.ledger.coverage.swept & clean.ledger.coverage.wanted
    )


@pytest.mark.parametrize("passes", [1, 2])
def test_values_bring_all_of_it_back(passes: int) -> None:
    clean = cleaning(CleanRequest(passes=passes))
    for _ in range(passes):
        points = clean.next_path(HERE, [])
        assert points is not None
        drive(clean, points, 0.6 if clean.ledger.stage_number == passes - 1 else 1.0)
    again = cleaning(clean.ledger.request)
    again.restore(json.loads(json.dumps(clean.values())))
    assert (again.ledger.coverage.cells == clean.ledger.coverage.cells).all()
    assert again.ledger.coverage.swept_cells == clean.ledger.coverage.swept_cells
    assert (again.ledger.clean == clean.ledger.clean).all()
    assert again.ledger.stage_number == clean.ledger.stage_number
    assert again.ledger.left == pytest.approx(clean.ledger.left)
    assert [(s.name, s.again) for s in again.ledger.stages] == [
        (s.name, s.again) for s in clean.ledger.stages
    ]
    assert finish(again, []) >= 1
    assert again.ledger.coverage.fraction > 0.99
