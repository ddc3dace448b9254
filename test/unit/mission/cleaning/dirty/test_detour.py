"""A detour inserted into a path: against plain loops over its points, with made-up plans."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.geometry import Point
from roomba.mission.cleaning.dirty.detour import nearest_station, with_detour
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError, NoPathReason
from roomba.planning.path.polyline import Path

PATH = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0)])
BESIDE = np.array([(2.0, -0.5), (2.2, -0.5)])
"""Nearest to the path at 2 to 2.2 m."""


def there_and_back(at: Point) -> CoveragePlan:
    """Straight to the first place, and back."""
    return CoveragePlan(np.array([at, BESIDE[0], at]))


@pytest.mark.parametrize("ahead", [1.0, 3.0, 50.0])
@pytest.mark.parametrize("seed", range(5))
def test_the_nearest_place_ahead_is_found(seed: int, ahead: float) -> None:
    random = np.random.default_rng(seed)
    path = Path(random.uniform(0.0, 5.0, (8, 2)))
    floor = random.uniform(0.0, 5.0, (3, 2))
    steps = np.linspace(0.0, min(ahead, path.length), 2000)
    away = [min(math.dist(path.point_at(s), place) for place in floor.tolist()) for s in steps]
    found = nearest_station(path, floor, ahead)
    assert found <= ahead + 0.05
    told = min(math.dist(path.point_at(found), place) for place in floor.tolist())
    assert told == pytest.approx(min(away), abs=0.03)


def test_a_way_branches_off_where_it_takes_the_least() -> None:
    longer = with_detour(PATH, BESIDE, there_and_back, 25.0, 2.0)
    assert longer is not None
    branch = longer[1]
    assert branch == pytest.approx((2.0, 0.0), abs=0.2)
    assert longer == pytest.approx(np.vstack((PATH[:1], branch, BESIDE[:1], branch, PATH[1:])))
    assert Path(longer).length == pytest.approx(Path(PATH).length + 1.0, abs=0.05)


def test_it_branches_off_at_once_where_no_way_leads_from_there() -> None:
    def plan(at: Point) -> CoveragePlan:
        if at[0] > 1.0:
            raise NoPathError(at, NoPathReason.START_BLOCKED, None)
        return there_and_back(at)

    longer = with_detour(PATH, BESIDE, plan, 25.0, 5.0)
    assert longer is not None
    assert longer == pytest.approx(np.vstack((PATH[:1], BESIDE[:1], PATH)))


def test_a_way_that_is_too_long_is_not_put_in() -> None:
    assert with_detour(PATH, BESIDE, there_and_back, 25.0, 0.9) is None
    # Farther ahead than it looks it would be short enough.
    assert with_detour(PATH, BESIDE, there_and_back, 0.5, 2.0) is None


def test_where_nothing_can_be_swept_the_path_stays() -> None:
    assert with_detour(PATH, BESIDE, lambda at: CoveragePlan(np.array([at])), 25.0, 5.0) is None
