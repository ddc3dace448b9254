import math

import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray

from roomba.raster.distance import distance_to_nearest


@given(arrays(np.bool_, array_shapes(min_dims=2, max_dims=2, max_side=25)))
def test_it_is_the_smallest_of_all_distances(targets: NDArray[np.bool_]) -> None:
    found = distance_to_nearest(targets)
    there = np.argwhere(targets)
    for cell in np.ndindex(*targets.shape):
        nearest = min((math.dist(cell, other) for other in there), default=math.inf)
        assert math.isclose(found[cell], nearest, rel_tol=1e-6)


@given(st.integers(0, 100))
def test_it_agrees_with_opencv(seed: int) -> None:
    targets = np.random.default_rng(seed).random((80, 120)) < 0.01
    targets[3, 5] = True
    theirs = cv2.distanceTransform((~targets).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    assert np.allclose(distance_to_nearest(targets), theirs, atol=1e-4)
