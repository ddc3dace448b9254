"""The compiled search by itself: its outcome, its roots and its cost, against plain Dijkstra."""

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

from roomba.planning.path.search.any_angle import FreeSpace
from roomba.planning.path.search.fan_kernels import BEFORE_GOAL, GOAL_SQUARE, Work
from roomba.planning.path.search.path_kernels import FOUND, FULL, NO_PATH, START, search

FLOORS = arrays(
    np.bool_,
    st.tuples(st.integers(2, 6), st.integers(2, 6)),
    elements=st.integers(0, 3).map(lambda number: number > 0),
    fill=st.just(True),
)
Legs = list[tuple[Place, float]]
"""Centres with the lengths of the ways that join an end to them."""


def work_over(fits: Mask, capacity: int = 4096) -> Work:
    floor = FreeSpace.of(fits)
    size = floor.fits.size
    state = np.array([0, 0, 1, 0, -1], np.int64)
    assert state[GOAL_SQUARE] == -1
    return Work(
        floor.fits,
        floor.open_squares,
        floor.flags,
        np.zeros(size, np.int32),
        np.zeros(size),
        np.zeros(size, np.int32),
        np.zeros(capacity),
        np.zeros(capacity, np.int32),
        np.zeros(capacity, np.int32),
        np.zeros((capacity, 7)),
        state,
        np.zeros(5),
    )


def searched(work: Work, entries: Legs, exits: Legs) -> int:
    """Search between two ends that are off the floor, and so tied to their joints."""
    columns = work.fits.shape[1]
    roots, legs = [], []
    for joints in (entries, exits):
        numbers = [int(y + 1) * columns + int(x + 1) for (x, y), _ in joints]
        roots.append(np.array(numbers, np.int32))
        legs.append(np.array([leg for _, leg in joints]))
    # What is estimated to the goal may not be more than the way there: it lies on an exit.
    work.ends[:2] = entries[0][0][0] + 1.0, entries[0][0][1] + 1.0
    work.ends[2:4] = exits[0][0][0] + 1.0, exits[0][0][1] + 1.0
    return search(work, roots[0], legs[0], roots[1], legs[1], False)


def roots_of(work: Work) -> list[Place]:
    columns = work.fits.shape[1]
    roots, root = [], int(work.state[BEFORE_GOAL])
    while root != START:
        roots.append((float(root % columns - 1), float(root // columns - 1)))
        root = int(work.before[root])
    return roots[::-1]


@given(FLOORS, st.data())
@settings(max_examples=examples(80))
def test_cost_and_roots_are_those_of_the_shortest_way(fits: Mask, data: st.DataObject) -> None:
    assume(fits.any())
    sights = Sights(fits)
    centre = st.sampled_from(sights.centres)
    entries = [(data.draw(centre), 0.0)]
    goal = data.draw(centre)
    # All exits are as far from the goal as they say, so that no estimate is too long.
    exits = [(goal, 0.0)]
    other = data.draw(centre)
    if other != goal:
        exits.append((other, math.dist(goal, other)))
    work = work_over(fits)
    flags = work.flags.copy()
    outcome = searched(work, entries, exits)
    reached = sights.lengths(dict(entries))
    expected = min(reached.get(at, math.inf) + leg for at, leg in exits)
    assert np.array_equal(work.flags, flags)
    if outcome == NO_PATH:
        assert expected == math.inf
        return
    assert outcome == FOUND
    roots = roots_of(work)
    assert roots[0] == entries[0][0]
    legs = dict(exits)
    assert work.ends[4] == pytest.approx(expected)
    assert length_of(roots) + legs[roots[-1]] == pytest.approx(expected)
    assert all(stays_on_floor(fits, one, two) for one, two in pairwise(roots))


def test_too_small_arrays_are_told_and_the_flags_are_left_as_they_were() -> None:
    fits = np.random.default_rng(5).random((14, 14)) > 0.25
    fits[0] = fits[:, -1] = True
    entries, exits = [((0.0, 0.0), 0.0)], [((13.0, 13.0), 0.0)]
    work = work_over(fits, 60)
    flags = work.flags.copy()
    assert searched(work, entries, exits) == FULL
    assert np.array_equal(work.flags, flags)
    assert searched(work_over(fits), entries, exits) == FOUND
