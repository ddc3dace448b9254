import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray
from scipy import ndimage

from roomba.raster.regions import dilated, join, large_regions, numbered_regions, root_of

masks = arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, max_side=20))


def disc(span: int, radius: float) -> NDArray[np.bool_]:
    offsets = np.arange(-span, span + 1)
    return np.hypot(offsets[:, None], offsets) <= radius


@given(masks, st.integers(0, 5), st.floats(-1.0, 1.0))
def test_growing_by_a_disc_agrees_with_opencv(
    mask: NDArray[np.bool_], span: int, share: float
) -> None:
    # Smaller than its square as well: then the rim of that is empty.
    reach = disc(span, max(span + share, 0.0))
    theirs = cv2.dilate(
        mask.astype(np.uint8),
        reach.astype(np.uint8),
        borderType=cv2.BORDER_CONSTANT,
        borderValue=0,
    )
    assert np.array_equal(dilated(mask, reach), theirs.astype(bool))


@given(masks, st.booleans())
def test_regions_agree_with_opencv_up_to_their_numbers(
    mask: NDArray[np.bool_], by_corners: bool
) -> None:
    ours = numbered_regions(mask, by_corners=by_corners)
    connectivity = 8 if by_corners else 4
    count, theirs = cv2.connectedComponents(mask.astype(np.uint8), connectivity=connectivity)
    pairs = set(zip(ours.ravel().tolist(), theirs.ravel().tolist(), strict=True))
    assert len(pairs) == len({a for a, _ in pairs}) == len({b for _, b in pairs})
    assert ours.max(initial=0) == count - 1
    assert np.array_equal(ours > 0, mask)


@pytest.mark.parametrize("seed", range(5))
def test_large_regions_are_those_that_scipy_finds(seed: int) -> None:
    mask = np.random.default_rng(seed).random((60, 80)) < 0.55
    labels, count = ndimage.label(mask)
    expected = np.zeros_like(mask)
    for label in range(1, count + 1):
        if np.count_nonzero(labels == label) >= 20:
            expected |= labels == label
    resolution = 0.02
    assert np.array_equal(large_regions(mask, resolution, 19.5 * resolution**2), expected)
    assert 0 < np.count_nonzero(expected) < np.count_nonzero(mask)


def test_cells_that_meet_at_a_corner_may_be_one_large_region() -> None:
    mask = np.eye(4, dtype=np.bool_)
    assert not large_regions(mask, 1.0, 2.0).any()
    assert np.array_equal(large_regions(mask, 1.0, 4.0, by_corners=True), mask)


def test_no_region_is_large_in_an_empty_mask() -> None:
    assert not large_regions(np.zeros((3, 3), np.bool_), 1.0, 0.0).any()


@given(st.lists(st.tuples(st.integers(0, 19), st.integers(0, 19)), max_size=30))
def test_labels_that_were_joined_have_the_least_of_them_as_root(
    pairs: list[tuple[int, int]],
) -> None:
    parents = np.arange(20, dtype=np.int32)
    groups = [{label} for label in range(20)]
    for one, other in pairs:
        together = groups[one] | groups[other]
        for label in together:
            groups[label] = together
        assert join(parents, one, other) == min(together)
    assert [root_of(parents, label) for label in range(20)] == [min(group) for group in groups]
