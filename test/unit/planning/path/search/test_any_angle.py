"""Any-angle paths over tiny floors, against Dijkstra over all pairs that see each other."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from fixtures.references.any_angle import Mask, Place, Sights, length_of, stays_on_floor
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.path.search.any_angle import AnyAngleSearch, FreeSpace, Joints

FLOORS = arrays(
    np.bool_,
    st.tuples(st.integers(1, 6), st.integers(1, 6)),
    elements=st.integers(0, 4).map(lambda number: number > 0),
    fill=st.just(True),
)


def joined_to(cells: list[tuple[int, int]], legs: list[float]) -> Joints:
    return Joints(np.array(cells, np.int64).reshape(-1, 2), np.array(legs, np.float64))


NOT_JOINED = joined_to([], [])


def on_centre(x: float, y: float) -> Joints:
    return joined_to([(int(y), int(x))], [0.0])


def search_over(fits: Mask) -> AnyAngleSearch:
    rows, columns = fits.shape
    return AnyAngleSearch((rows, columns))


def searched(
    fits: Mask,
    start: Place,
    goal: Place,
    start_joints: Joints = NOT_JOINED,
    goal_joints: Joints = NOT_JOINED,
) -> NDArray[np.float64] | None:
    search = search_over(fits)
    floor = FreeSpace.of(fits)
    return search.shortest_path(floor, start, start_joints, goal, goal_joints)


@given(FLOORS, st.data())
@settings(max_examples=examples(60))
def test_between_centres_the_path_is_legal_and_the_shortest(
    fits: Mask, data: st.DataObject
) -> None:
    assume(fits.any())
    sights = Sights(fits)
    start = data.draw(st.sampled_from(sights.centres))
    search, floor = search_over(fits), FreeSpace.of(fits)
    for goal in sights.centres:
        bends = search.shortest_path(floor, start, on_centre(*start), goal, on_centre(*goal))
        expected = sights.shortest(start, goal)
        if bends is None:
            assert expected == math.inf
            continue
        path = [start, *((x, y) for x, y in bends.tolist()), goal]
        assert length_of(path) == pytest.approx(expected, abs=1e-4)
        assert all(stays_on_floor(fits, one, other) for one, other in pairwise(path))


@given(FLOORS, st.data())
@settings(max_examples=examples(80))
def test_ends_inside_open_squares_see_all_around(fits: Mask, data: st.DataObject) -> None:
    rows, columns = fits.shape
    squares = [
        (x, y) for y, x in np.ndindex(rows - 1, columns - 1) if fits[y : y + 2, x : x + 2].all()
    ]
    assume(squares)
    # Well inside, so that rays pass centres exactly or by far, as fan_kernels.EPSILON asks for.
    inner = st.tuples(st.integers(1, 7), st.integers(1, 7)).map(lambda at: (at[0] / 8, at[1] / 8))
    ends: list[Place] = []
    for _ in range(2):
        x, y = data.draw(st.sampled_from(squares))
        off_x, off_y = data.draw(inner)
        ends.append((x + off_x, y + off_y))
    start, goal = ends
    bends = searched(fits, start, goal)
    expected = Sights(fits).shortest(start, goal)
    if bends is None:
        assert expected == math.inf
        return
    path = [start, *((x, y) for x, y in bends.tolist()), goal]
    assert length_of(path) == pytest.approx(expected, abs=1e-4)
    assert all(stays_on_floor(fits, one, other) for one, other in pairwise(path))


def test_of_several_joints_the_best_pair_is_taken() -> None:
    """A wall of centres parts a floor but for its upper end; joints lie far from both ends."""
    fits = np.ones((6, 7), np.bool_)
    fits[:5, 3] = False
    # Both ends lie off the floor, below it.
    start, goal = (0.0, -2.0), (6.0, -2.0)
    starts = joined_to([(0, 0), (2, 2)], [2.0, 4.5])
    goals = joined_to([(0, 6), (1, 4)], [2.0, 3.7])
    bends = searched(fits, start, goal, starts, goals)
    sights = Sights(fits)
    ways = {
        (one, other): leg + sights.shortest(one, other) + last
        for one, leg in {(0.0, 0.0): 2.0, (2.0, 2.0): 4.5}.items()
        for other, last in {(6.0, 0.0): 2.0, (4.0, 1.0): 3.7}.items()
    }
    assert bends is not None
    best = min(ways, key=ways.__getitem__)
    assert (tuple(bends[0]), tuple(bends[-1])) == best


def test_a_joint_that_is_not_on_the_floor_does_not_count() -> None:
    fits = np.ones((3, 5), np.bool_)
    fits[:, 2] = False
    closed, far = (2.0, 0.0), (4.0, 2.0)
    assert searched(fits, closed, far, on_centre(*closed), on_centre(*far)) is None
    assert searched(fits, far, closed, on_centre(*far), on_centre(*closed)) is None
    assert searched(fits, (-2.0, 0.0), far, NOT_JOINED, on_centre(*far)) is None


@pytest.mark.parametrize("seed", range(3))
def test_what_was_searched_before_leaves_nothing_behind(seed: int) -> None:
    """Among many centres the work arrays grow; paths stay those of a new search."""
    random = np.random.default_rng(seed)
    shape = (40, 30)
    search = AnyAngleSearch(shape)
    for _ in range(4):
        fits = random.random(shape) > 0.3
        cells = [(float(x), float(y)) for y, x in np.argwhere(fits).tolist()]
        start, goal = (cells[random.integers(len(cells))] for _ in range(2))
        joints = on_centre(*start), on_centre(*goal)
        floor = FreeSpace.of(fits)
        flags = floor.flags.copy()
        found = search.shortest_path(floor, start, joints[0], goal, joints[1])
        fresh = AnyAngleSearch(shape).shortest_path(floor, start, joints[0], goal, joints[1])
        assert (found is None) == (fresh is None)
        if found is not None and fresh is not None:
            assert np.array_equal(found, fresh)
        assert np.array_equal(floor.flags, flags)
