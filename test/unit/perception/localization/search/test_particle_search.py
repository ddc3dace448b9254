"""The search on the way: corridors that look alike, coarse maps of another day, other homes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.corridors import ALIKE, STEP, TELLING, coarse_and_thick, half_of
from fixtures.robots.located import CONFIG, FURNISHED, Eye

from roomba.geometry import Pose, wrap_angle
from roomba.grid import OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.localization.search.particle_search import ParticleSearch
from roomba.perception.matching.scan_view import ScanView
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home


def driven(
    home: Home, search: ParticleSearch, start: Pose, way: float, drift: float = 0.0
) -> tuple[Pose, list[float]]:
    """Drive straight on; return where it is, and the errors, m, of what was believed meanwhile.

    Dead reckoning turns by ``drift``, rad per m, and tells 3 % too much.
    """
    eye, reckoned, pose, errors = Eye(home), Pose(), start, []
    for _ in range(round(way / STEP) + 1):
        search.see(half_of(home, pose, eye), reckoned)
        found = search.found
        if found is not None:
            errors.append(found.distance_to(pose.x, pose.y))
        pose = pose.compose(Pose(STEP, 0.0, 0.0))
        reckoned = reckoned.compose(Pose(1.03 * STEP, 0.0, drift * STEP))
    return pose, errors


def searched(occupancy: OccupancyMap) -> ParticleSearch:
    return ParticleSearch(SurfaceField.of(occupancy), CONFIG.body.radius)


@pytest.mark.parametrize("drift", [0.0, 0.01, -0.01])
def test_it_is_found_once_the_way_has_told_the_place(drift: float) -> None:
    search = searched(TELLING.map)
    _, errors = driven(TELLING, search, Pose(8.0, 0.9, 0.0), 16.0, drift)
    assert len(errors) > 5
    assert max(errors) < 0.5


def test_where_all_looks_alike_no_place_is_believed() -> None:
    """Between the ends of the corridor each pillar may be any other."""
    search = searched(ALIKE.map)
    _, errors = driven(ALIKE, search, Pose(8.0, 0.9, 0.0), 12.0)
    assert errors == []


def test_on_a_map_of_another_home_no_place_is_believed() -> None:
    search = searched(FURNISHED.map)
    _, errors = driven(TELLING, search, Pose(8.0, 0.9, 0.0), 16.0)
    assert errors == []


def test_walls_that_a_coarse_map_draws_too_thick_do_no_harm() -> None:
    search = searched(coarse_and_thick(TELLING))
    _, errors = driven(TELLING, search, Pose(8.0, 0.9, 0.0), 16.0)
    assert len(errors) > 5
    assert max(errors) < 0.5


@pytest.mark.parametrize("crowded", [0.0, 0.6])
def test_where_most_beams_meet_what_the_map_does_not_show_no_place_is_believed(
    crowded: float,
) -> None:
    """The likeliest place is the right one; but so much of it may be elsewhere as well."""
    crowd, start = np.random.default_rng(3), Pose(0.8, 1.0, 0.0)
    search, eye, believed = searched(FURNISHED.map), Eye(FURNISHED), 0
    for x in [*np.arange(0.0, 1.1, STEP), *np.arange(1.0, -0.1, -STEP)] * 6:
        moved = Pose(float(x), 0.0, 0.0)
        view = half_of(FURNISHED, start.compose(moved), eye)
        ends = view.ends.copy()
        in_crowd = crowd.random(len(ends)) < crowded
        ends[in_crowd, :2] *= crowd.uniform(0.1, 0.8, (np.count_nonzero(in_crowd), 1))
        search.see(ScanView(ends, view.mount), moved)
        believed += search.found is not None
    assert (believed == 0) == (crowded > 0.0)


def test_a_robot_that_stands_learns_nothing_more() -> None:
    search = searched(TELLING.map)
    view = half_of(TELLING, Pose(19.0, 0.9, 0.0))
    for _ in range(100):
        search.see(view, Pose())
    assert search.found is None


def test_the_same_drive_gives_the_same() -> None:
    found = []
    for _ in range(2):
        search = searched(TELLING.map)
        driven(TELLING, search, Pose(12.0, 0.9, 0.0), 12.0)
        found.append((search.found, search.reckoned))
    assert found[0] == found[1]
    assert found[0][0] is not None


def test_without_room_on_the_map_it_goes_on_and_finds_nothing() -> None:
    solid = np.full((20, 20), OCCUPIED, np.int8)
    search = searched(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 20, 20), solid))
    _, errors = driven(TELLING, search, Pose(8.0, 0.9, 0.0), 2.0)
    assert errors == []


def test_driven_into_a_wall_it_begins_again() -> None:
    """Dead reckoning that leads out of the map says that all was wrong."""
    search = searched(FURNISHED.map)
    view = half_of(FURNISHED, Pose(1.5, 1.0, 0.0))
    search.see(view, Pose())
    search.see(view, Pose(50.0, 0.0, 0.0))
    assert search.found is None
    _, errors = driven(FURNISHED, search, Pose(1.2, 1.2, 0.0), 1.0)
    assert errors == []


def test_headings_are_wrapped() -> None:
    search = searched(TELLING.map)
    pose, _ = driven(TELLING, search, Pose(24.0, 1.0, math.pi), 9.0)
    found = search.found
    assert found is not None
    assert abs(found.theta) <= math.pi
    assert abs(wrap_angle(found.theta - pose.theta)) < 0.2
