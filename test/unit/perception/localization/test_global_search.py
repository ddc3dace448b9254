"""One search of the whole map: found at once, by more views, or on the way; and what it says."""

from __future__ import annotations

import numpy as np
from fixtures.homes.corridors import STEP, TELLING, coarse_and_thick, half_of
from fixtures.robots.located import CONFIG, LIDAR, SQUARE, TWO_ROOMS, Eye

from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.belief.belief import unknown_belief
from roomba.perception.localization.global_search import FoundPlace, GlobalSearch
from roomba.perception.localization.learned_walls import LearnedWalls
from roomba.perception.localization.search.expecting import where_known
from roomba.perception.localization.search.relocation import Verdict
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField

HERE = Pose(5.2, 2.0, 0.4)
RECKONED = Pose(-3.0, 7.0, 2.0)
"""Dead reckoning's frame lies anywhere."""
SCAN = 0.2
"""s; from scan to scan."""


def search_in(occupancy: OccupancyMap, expected: Pose | None = None) -> GlobalSearch:
    """A search that began at 10 s."""
    config = CONFIG.localization
    walls = LearnedWalls(SurfaceField.of(occupancy), unknown_belief())
    expectation = where_known(expected, config, is_still=False) if expected else None
    return GlobalSearch("carried", 10.0, expectation, walls, config, CONFIG.body.radius)


def shown(
    search: GlobalSearch, view: ScanView, reckoned: Pose = RECKONED, newest: Pose = RECKONED
) -> FoundPlace | None:
    """Show one scan until it is found; for 4 s at most."""
    for number in range(20):
        found = search.see(10.0 + SCAN * number, view, reckoned, newest, Pose())
        if found is not None:
            return found
    return None


def test_a_place_like_no_other_is_found_by_one_scan() -> None:
    found = shown(search_in(TWO_ROOMS.map), LIDAR.view(Eye(TWO_ROOMS).scan(HERE)))
    assert found is not None
    assert found.pose.distance_to(HERE.x, HERE.y) < 0.02
    assert found.fit.agree > 0.9


def test_it_is_where_it_drove_since_the_scan() -> None:
    step = Pose(0.2, 0.1, 0.3)
    view = LIDAR.view(Eye(TWO_ROOMS).scan(HERE))
    found = shown(search_in(TWO_ROOMS.map), view, newest=RECKONED.compose(step))
    there = HERE.compose(step)
    assert found is not None
    assert found.pose.distance_to(there.x, there.y) < 0.02


def test_where_places_look_alike_all_are_told_and_more_views_are_wanted() -> None:
    search = search_in(SQUARE.map)
    assert search.hypotheses(RECKONED) == []
    assert search.verdict is Verdict.SEARCHING
    assert not search.needs_views(10.0)
    assert search.needs_views(10.1 + CONFIG.localization.searching.wait_before_moving)
    truth = Pose(1.9, 1.3, 2.0)
    assert shown(search, LIDAR.view(Eye(SQUARE).scan(truth))) is None
    assert search.verdict is Verdict.AMBIGUOUS
    assert search.needs_views(10.0)
    places = search.hypotheses(RECKONED)
    assert len(places) == 4
    assert min(each.distance_to(truth.x, truth.y) for each in places) < 0.03


def test_where_it_is_expected_it_is_found_among_places_that_look_alike() -> None:
    truth = Pose(1.9, 1.3, 2.0)
    search = search_in(SQUARE.map, expected=truth)
    view = LIDAR.view(Eye(SQUARE).scan(truth))
    found = None
    for number in range(20):
        found = found or search.see(10.0 + SCAN * number, view, RECKONED, RECKONED, truth)
    assert found is not None
    assert found.pose.distance_to(truth.x, truth.y) < 0.03


def test_in_another_map_it_begins_anew_in_the_time_that_is_left() -> None:
    search = search_in(SQUARE.map)
    view = LIDAR.view(Eye(TWO_ROOMS).scan(HERE))
    assert shown(search, view) is None
    search.use(LearnedWalls(SurfaceField.of(TWO_ROOMS.map), unknown_belief()))
    assert search.hypotheses(RECKONED) == []
    assert search.since == 10.0
    assert shown(search, view) is not None


def test_a_clock_that_was_set_begins_its_time_anew() -> None:
    search = search_in(SQUARE.map)
    search.clock_set(3.0)
    assert search.since == 3.0
    assert not search.needs_views(3.0)


def test_where_walls_are_drawn_so_thick_that_no_scan_fits_it_is_found_on_the_way() -> None:
    search, eye = search_in(coarse_and_thick(TELLING, 2)), Eye(TELLING)
    for number, x in enumerate(np.arange(2.0, 27.0, STEP).tolist()):
        truth = Pose(x, 1.0, 0.0)
        reckoned = Pose(x - 2.0, 0.0, 0.0)
        view = half_of(TELLING, truth, eye)
        found = search.see(10.0 + number, view, reckoned, reckoned, Pose())
        if found is not None:
            assert found.pose.distance_to(truth.x, truth.y) < 0.2
            return
    raise AssertionError("it was not found")
