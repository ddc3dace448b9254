"""Outlines of masks and their straightening, against every border of every cell."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from fixtures.references.straight_ways import Mask, parts_of, runs_between_centres_that_fit
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.coverage.passes.contours import outlines, straightened

MASKS = arrays(
    np.bool_,
    st.tuples(st.integers(1, 9), st.integers(1, 9)),
    elements=st.integers(0, 3).map(lambda number: number > 0),
    fill=st.just(True),
)


def signed_area(chain: NDArray[np.int32]) -> float:
    """The area within a closed chain of cells, positive where it goes counter-clockwise."""
    points = [*chain.tolist(), chain[0].tolist()]
    doubled: int = sum(x * to_y - to_x * y for (x, y), (to_x, to_y) in pairwise(points))
    return doubled / 2


def border_cells(mask: Mask) -> set[tuple[int, int]]:
    """True cells, (x, y), with a side to one that is not, or to the outside."""
    padded = np.pad(mask, 1)
    return {
        (x, y)
        for y, x in np.argwhere(mask).tolist()
        if not (padded[y, x + 1] and padded[y + 2, x + 1] and padded[y + 1, x])
        or not padded[y + 1, x + 2]
    }


@given(MASKS)
@settings(max_examples=examples(100))
def test_chains_pass_all_cells_at_a_border_and_no_others_step_by_step(mask: Mask) -> None:
    chains = [[(x, y) for x, y in chain.tolist()] for chain in outlines(mask)]
    assert {cell for chain in chains for cell in chain} == border_cells(mask)
    for chain in chains:
        for (x, y), (to_x, to_y) in pairwise([*chain, chain[0]]):
            assert max(abs(to_x - x), abs(to_y - y)) == (1 if len(chain) > 1 else 0)


@given(MASKS)
@settings(max_examples=examples(100))
def test_each_part_has_one_chain_around_it_and_one_around_each_of_its_holes(mask: Mask) -> None:
    expected = 0
    for part in parts_of(mask):
        others = np.ones((mask.shape[0] + 2, mask.shape[1] + 2), np.bool_)
        for row, column in part:
            others[row + 1, column + 1] = False
        expected += len(parts_of(others, over_corners=True))
    assert len(outlines(mask)) == expected


@pytest.mark.parametrize("hole", [None, (4, 3)])
def test_what_is_true_lies_on_the_left(hole: tuple[int, int] | None) -> None:
    mask = np.ones((7, 9), np.bool_)
    if hole is not None:
        mask[hole] = False
    around, *within = outlines(mask)
    assert signed_area(around) == 6 * 8
    assert len(within) == (hole is not None)
    assert all(signed_area(chain) < 0.0 for chain in within)


CHAINS = st.lists(
    st.tuples(st.integers(-1, 1), st.integers(-1, 1)).filter(any), min_size=1, max_size=25
)


@given(CHAINS, st.sampled_from([0.2, 0.45, 1.1]), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(100))
def test_a_straightened_chain_fits_and_passes_all_its_cells(
    steps: list[tuple[int, int]], tolerance: float, seed: int
) -> None:
    chain = np.concatenate((np.zeros((1, 2)), np.cumsum(np.array(steps, np.float64), axis=0)))
    chain -= chain.min(axis=0)
    shape = tuple((chain.max(axis=0).astype(int) + 2)[::-1])
    fits = np.random.default_rng(seed).random(shape) < 0.8
    for x, y in chain.astype(int).tolist():
        fits[y, x] = True
    kept = straightened(fits, chain, tolerance).tolist()
    assert kept[0] == 0
    assert kept[-1] == len(chain) - 1
    assert kept == sorted(set(kept))
    # Neighbours of the chain need not fit: its diagonal steps pass between them, over the corner.
    for first, last in pairwise(kept):
        if last > first + 1:
            assert runs_between_centres_that_fit(fits, chain[[first, last]])
        for point in chain[first + 1 : last].tolist():
            assert distance(point, chain[first].tolist(), chain[last].tolist()) <= (
                math.sqrt(2.0) * tolerance + 1e-9
            )


@given(CHAINS, st.sampled_from([0.2, 0.45, 1.1]))
@settings(max_examples=examples(60))
def test_no_more_points_could_be_left_out(steps: list[tuple[int, int]], tolerance: float) -> None:
    chain = np.concatenate((np.zeros((1, 2)), np.cumsum(np.array(steps, np.float64), axis=0)))
    chain -= chain.min(axis=0)
    fits = np.ones(tuple((chain.max(axis=0).astype(int) + 2)[::-1]), np.bool_)
    kept = straightened(fits, chain, tolerance).tolist()
    for before, after in zip(kept, kept[2:], strict=False):
        one, two = chain[before].tolist(), chain[after].tolist()
        far = chain[before + 1 : after].tolist()
        assert one == two or max(distance(point, one, two) for point in far) > tolerance - 1e-9


def distance(point: list[float], start: list[float], end: list[float]) -> float:
    """How far a point is from a segment."""
    along = end[0] - start[0], end[1] - start[1]
    off = point[0] - start[0], point[1] - start[1]
    square = along[0] ** 2 + along[1] ** 2
    share = min(max((off[0] * along[0] + off[1] * along[1]) / max(square, 1e-12), 0.0), 1.0)
    return math.hypot(off[0] - share * along[0], off[1] - share * along[1])
