"""What floor was swept: the kernel against plain numpy, and the counts kept beside it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba.perception.swept.coverage_bits import SWEPT, WANTED
from roomba.perception.swept.coverage_kernels import LONGEST_STEP, sweep
from roomba.perception.swept.coverage_map import GRANTED, CoverageMap, patches_of

FRAME = GridFrame(0.02, -0.5, 0.3, 40, 60)
LEFT, RIGHT, LOW, HIGH = FRAME.extent
RADIUS = 0.0917
"""m; of the tool, and what its map grants."""
Mask = NDArray[np.bool_]


def middles(frame: GridFrame = FRAME) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    x = frame.origin_x + (np.arange(frame.columns) + 0.5) * frame.resolution
    y = frame.origin_y + (np.arange(frame.rows) + 0.5) * frame.resolution
    grid_x, grid_y = np.meshgrid(x, y)
    return grid_x, grid_y


def off_way(start: tuple[float, float], end: tuple[float, float]) -> NDArray[np.float64]:
    """Return how far each cell's middle is from a straight way, m."""
    x, y = middles()
    way = np.array(end) - start
    length = float(way @ way)
    share = ((x - start[0]) * way[0] + (y - start[1]) * way[1]) / length if length else 0.0 * x
    share = np.clip(share, 0.0, 1.0)
    off: NDArray[np.float64] = np.hypot(
        x - start[0] - share * way[0], y - start[1] - share * way[1]
    )
    return off


def everything() -> Mask:
    return np.ones(FRAME.shape, np.bool_)


places = st.tuples(st.floats(LEFT - 0.3, RIGHT + 0.3), st.floats(LOW - 0.3, HIGH + 0.3))


@given(places, places, st.floats(0.005, 0.3), st.integers(0, 2**32 - 1))
def test_the_kernel_sweeps_what_numpy_says(
    start: tuple[float, float], end: tuple[float, float], radius: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    before = random.integers(0, 4, FRAME.shape).astype(np.uint8)
    cells = before.copy()
    place = np.array([*FRAME.centre_of(0, 0), FRAME.resolution])
    found = sweep(cells, place, *start, *end, radius)
    off = off_way(start, end)
    is_near, is_far = off < radius - 1e-9, off > radius + 1e-9
    was_swept = (before & SWEPT) > 0
    assert ((cells & SWEPT) > 0)[is_near | was_swept].all()
    assert not ((cells & SWEPT) > 0)[is_far & ~was_swept].any()
    assert ((cells & WANTED) == (before & WANTED)).all()
    new = ((cells & SWEPT) > 0) & ~was_swept & ((before & WANTED) > 0)
    assert found == np.count_nonzero(new)


def test_beginning_anywhere_it_has_swept_what_is_below_it() -> None:
    coverage = CoverageMap(FRAME, everything(), 2.0 * (RADIUS - GRANTED))
    assert coverage.fraction == 0.0
    coverage.sweep(0.0, 0.7)
    assert (coverage.swept == (off_way((0.0, 0.7), (0.0, 0.7)) <= RADIUS)).all()
    assert coverage.swept_area == pytest.approx(math.pi * RADIUS**2, rel=0.05)


def test_from_where_it_last_was_it_sweeps_all_the_way() -> None:
    coverage = CoverageMap(FRAME, everything(), 2.0 * (RADIUS - GRANTED))
    coverage.sweep(0.0, 0.7)
    coverage.sweep(0.2, 0.8)
    assert (coverage.swept == (off_way((0.0, 0.7), (0.2, 0.8)) <= RADIUS)).all()


def test_carried_or_lifted_it_has_not_swept_the_way() -> None:
    far = (0.0 + LONGEST_STEP + 0.05, 0.7)
    carried = CoverageMap(FRAME, everything(), 2.0 * (RADIUS - GRANTED))
    carried.sweep(0.0, 0.7)
    carried.sweep(*far)
    lifted = CoverageMap(FRAME, everything(), 2.0 * (RADIUS - GRANTED))
    lifted.sweep(0.0, 0.7)
    lifted.lift()
    lifted.sweep(0.2, 0.7)
    for coverage, end in ((carried, far), (lifted, (0.2, 0.7))):
        expected = (off_way((0.0, 0.7), (0.0, 0.7)) <= RADIUS) | (off_way(end, end) <= RADIUS)
        assert (coverage.swept == expected).all()


ways = st.lists(st.tuples(st.floats(LEFT, RIGHT), st.floats(LOW, HIGH)), min_size=1, max_size=12)


@given(ways, st.integers(0, 2**32 - 1))
def test_counts_kept_are_those_of_the_cells(ways: list[tuple[float, float]], seed: int) -> None:
    wanted = np.random.default_rng(seed).random(FRAME.shape) < 0.6
    coverage = CoverageMap(FRAME, wanted, 2.0 * (RADIUS - GRANTED))
    for x, y in ways:
        coverage.sweep(x, y)
    kept = coverage.wanted_cells, coverage.swept_cells
    assert (coverage.wanted == wanted).all()
    assert kept[1] == np.count_nonzero(wanted & coverage.swept)
    assert (coverage.missed == (wanted & ~coverage.swept)).all()
    assert coverage.fraction == pytest.approx(kept[1] / kept[0])
    assert coverage.wanted_area == pytest.approx(kept[0] * 0.0004)
    coverage.count_again()
    assert (coverage.wanted_cells, coverage.swept_cells) == kept
    coverage.cells[:, :10] = WANTED
    coverage.count_again()
    assert coverage.wanted_cells == np.count_nonzero(coverage.wanted)
    assert coverage.swept_cells == np.count_nonzero(coverage.wanted & coverage.swept)


def test_along_a_way_is_what_numpy_says_and_changes_nothing() -> None:
    coverage = CoverageMap(FRAME, everything(), 0.18)
    way = [(LEFT + 0.1, LOW + 0.1), (RIGHT - 0.1, LOW + 0.3), (RIGHT - 0.2, HIGH)]
    expected = np.minimum(off_way(*way[:2]), off_way(*way[1:])) <= coverage.radius
    assert (coverage.along(np.array(way)) == expected).all()
    assert not coverage.along(np.array(way[:1])).any()
    assert coverage.swept_cells == 0
    assert not coverage.swept.any()


def test_after_kernels_swept_its_cells_it_goes_on_as_if_it_had_itself() -> None:
    own, theirs = (CoverageMap(FRAME, everything(), 0.2) for _ in range(2))
    way = ((0.0, 0.5), (0.2, 0.6), (0.3, 0.9))
    for place in way:
        own.sweep(*place)
    theirs.sweep(*way[0])
    swept = sweep(theirs.cells, theirs.place, *way[0], *way[1], theirs.radius)
    theirs.resumed(swept, way[1])
    theirs.sweep(*way[2])
    assert np.array_equal(theirs.cells, own.cells)
    assert (theirs.swept_cells, theirs.at) == (own.swept_cells, own.at)


def test_all_of_nothing_is_clean() -> None:
    assert CoverageMap(FRAME, ~everything(), 0.18).fraction == 1.0


def test_a_mask_of_another_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"\(40, 60\).*\(60, 40\)"):
        CoverageMap(FRAME, everything().T, 0.18)


def test_patches_are_told_from_the_largest_on() -> None:
    mask = ~everything()
    mask[2:6, 3:9] = True  # 24 cells
    mask[20:30, 40:50] = True  # 100
    mask[35, 5] = True  # 1
    patches = patches_of(mask, FRAME, 2.5 * 0.0004)
    assert [round(patch.area / 0.0004) for patch in patches] == [100, 24]
    assert patches[0].x == pytest.approx(LEFT + 45 * 0.02, abs=0.011)
    assert patches[0].y == pytest.approx(LOW + 25 * 0.02, abs=0.011)
    assert (patches[0].cells | patches[1].cells | (mask & False)).sum() == 124
    assert len(patches_of(mask, FRAME, 0.0)) == 3
    assert patches_of(~everything(), FRAME, 0.0) == []


def test_the_middle_of_a_bent_patch_lies_in_it() -> None:
    mask = ~everything()
    mask[5:30, 10:12] = mask[5:7, 10:40] = mask[5:30, 38:40] = True
    (patch,) = patches_of(mask, FRAME, 0.0)
    assert mask[FRAME.cell_of(patch.x, patch.y)]


def test_what_was_missed_is_told_in_patches() -> None:
    coverage = CoverageMap(FRAME, everything(), 2.0 * (RADIUS - GRANTED))
    coverage.sweep(LEFT, 0.5 * (LOW + HIGH))
    coverage.sweep(LEFT + 0.2, 0.5 * (LOW + HIGH))
    (patch,) = coverage.patches(0.01)
    assert (patch.cells == coverage.missed).all()
