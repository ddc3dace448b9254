"""Floor in parts: connected over sides, and parted at its narrow places."""

from __future__ import annotations

import numpy as np
from fixtures.references.straight_ways import connected_to
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.arrays import Mask
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.floor.regions import mask_of, regions
from roomba.raster.regions import numbered_regions

CONFIG = CoverageConfig()


@given(arrays(np.bool_, st.tuples(st.integers(1, 40), st.integers(1, 40))))
@settings(max_examples=examples(60), derandomize=True, deadline=None)
def test_small_floor_is_parted_where_it_does_not_hang_together(floor: Mask) -> None:
    found = regions(floor, CONFIG.narrow, CONFIG.least_part)
    labels = numbered_regions(floor)
    assert found.sizes.tolist() == np.bincount(labels.ravel())[1:].tolist()
    for region in range(len(found.sizes)):
        top, bottom, left, right = found.bounds[region].tolist()
        whole = np.zeros_like(floor)
        whole[top : bottom + 1, left : right + 1] = mask_of(found, region)
        assert np.array_equal(whole, labels == region + 1)


def test_two_wide_places_with_a_narrow_one_between_are_two_regions() -> None:
    floor = np.zeros((240, 520), np.bool_)
    floor[10:230, 10:250] = floor[10:230, 270:510] = True
    floor[110:140, 250:270] = True
    found = regions(floor, CONFIG.narrow, CONFIG.least_part)
    assert len(found.sizes) == 2
    assert found.sizes.sum() == floor.sum()
    assert abs(found.sizes[0] - found.sizes[1]) < 0.05 * floor.sum()


@given(st.integers(0, 2**32 - 1), st.integers(60, 130), st.integers(60, 220))
@settings(max_examples=examples(15))
def test_each_cell_is_of_one_region_and_each_region_is_connected(
    seed: int, rows: int, columns: int
) -> None:
    """Floors with walls across, so wide between them that parts are told apart."""
    random = np.random.default_rng(seed)
    floor = np.ones((rows, columns), np.bool_)
    for _ in range(int(random.integers(0, 4))):
        column = int(random.integers(columns))
        floor[: int(random.integers(rows)), column : column + int(random.integers(1, 20))] = False
    found = regions(floor, CONFIG.narrow, CONFIG.least_part)
    regions_of = np.zeros(floor.shape, np.int64)
    for region, (top, bottom, left, right) in enumerate(found.bounds.tolist()):
        mask = mask_of(found, region)
        assert mask[[0, -1]].any(axis=1).all()
        assert mask[:, [0, -1]].any(axis=0).all()
        regions_of[top : bottom + 1, left : right + 1] += mask
        assert mask.sum() == found.sizes[region]
        row, column = np.argwhere(mask)[0].tolist()
        assert len(connected_to(mask, (row, column))) == mask.sum()
    assert np.array_equal(regions_of, floor.astype(np.int64))
