"""Paths of the planner are the shortest: compared with a search over all pairs of places."""

from __future__ import annotations

import heapq
import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from fixtures.homes.planned_rooms import occupancy

from roomba.arrays import Mask
from roomba.geometry import Point
from roomba.planning.path.planner import NoPathError, NoPathReason, Path, PathPlanner


def is_floor(fits: Mask, start: Point, end: Point) -> bool:
    """Whether a segment between (x, y) in cells stays on the floor, in exact arithmetic."""
    (x, y), (to_x, to_y) = ((Fraction(a), Fraction(b)) for a, b in (start, end))
    cuts = {Fraction(0), Fraction(1)}
    for low, high in ((x, to_x), (y, to_y)):
        for line in range(math.ceil(min(low, high)), math.floor(max(low, high)) + 1):
            if low != high:
                cuts.add((line - low) / (high - low))
    ordered = sorted(cuts)
    for first, last in pairwise(ordered):
        middle = (first + last) / 2
        at_x, at_y = x + (to_x - x) * middle, y + (to_y - y) * middle
        for row in {math.floor(at_y), math.ceil(at_y)}:
            for column in {math.floor(at_x), math.ceil(at_x)}:
                if not (0 <= row < fits.shape[0] and 0 <= column < fits.shape[1]):
                    return False
                if not fits[row, column]:
                    return False
    return True


def shortest_by_brute_force(fits: Mask, start: Point, goals: list[Point]) -> list[float]:
    places = [(float(column), float(row)) for row, column in np.argwhere(fits)]
    places += [point for point in (start, *goals) if point not in places]
    found = {start: 0.0}
    done = set()
    heap = [(0.0, start)]
    while heap:
        cost, place = heapq.heappop(heap)
        if place in done:
            continue
        done.add(place)
        for other in places:
            reached = cost + math.dist(place, other)
            if reached < found.get(other, math.inf) and is_floor(fits, place, other):
                found[other] = reached
                heapq.heappush(heap, (reached, other))
    return [found.get(goal, math.inf) for goal in goals]


def assert_shortest(path: Path, length: float) -> None:
    """The search is exact; only ends next door to each other may be joined past the floor's rim."""
    straight = math.dist(path.points[0], path.points[-1])
    if straight <= 4.0 and len(path.points) == 2:
        assert straight <= length + 1e-4
    else:
        assert path.length == pytest.approx(length, abs=1e-4)


@pytest.mark.parametrize("closed", [0.05, 0.1, 0.2, 0.3, 0.4])
@pytest.mark.parametrize("seed", range(8))
def test_paths_between_centres_are_the_shortest(closed: float, seed: int) -> None:
    """The body is smaller than a cell, so it fits exactly on the cells that are free."""
    random = np.random.default_rng([seed, int(100 * closed)])
    solid = random.random(random.integers(4, 10, 2)) < closed
    map = occupancy(solid, resolution=1.0)
    planner = PathPlanner(map, 0.2, 0.0, 0.0)
    cells = [(float(column), float(row)) for row, column in np.argwhere(~solid)]
    start, goals = cells[0], cells[1:]
    expected = shortest_by_brute_force(~solid, start, goals)
    for goal, length in zip(goals, expected, strict=True):
        from_centre, to_centre = (
            map.frame.centre_of(int(row), int(column)) for column, row in (start, goal)
        )
        if math.isinf(length):
            with pytest.raises(NoPathError) as refused:
                planner.plan(from_centre, to_centre)
            assert refused.value.reason is NoPathReason.GOAL_UNREACHABLE
        else:
            assert_shortest(planner.plan(from_centre, to_centre), length)


@pytest.mark.parametrize("seed", range(25))
def test_paths_between_any_points_are_the_shortest(seed: int) -> None:
    random = np.random.default_rng(seed)
    solid = random.random((9, 9)) < random.choice([0.05, 0.12, 0.2])
    map = occupancy(solid, resolution=1.0)
    planner = PathPlanner(map, 0.2, 0.0, 0.0)
    squares = [
        (row, column)
        for row, column in np.ndindex(8, 8)
        if not solid[row : row + 2, column : column + 2].any()
    ]
    points = [
        (column + int(random.integers(1, 8)) / 8, row + int(random.integers(1, 8)) / 8)
        for row, column in (squares[i] for i in random.integers(len(squares), size=8))
    ]
    start, goals = points[0], points[1:]
    for goal, length in zip(goals, shortest_by_brute_force(~solid, start, goals), strict=True):
        from_point, to_point = ((x - 0.5, y - 1.5) for x, y in (start, goal))
        if math.isinf(length):
            with pytest.raises(NoPathError):
                planner.plan(from_point, to_point)
        else:
            assert_shortest(planner.plan(from_point, to_point), length)
