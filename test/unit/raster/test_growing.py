"""Arrays that grow keep what they hold."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from roomba.raster.growing import with_room


@pytest.mark.parametrize("kind", [np.int32, np.float64])
@pytest.mark.parametrize("is_compiled", [False, True])
def test_a_longer_array_begins_with_what_there_was(kind: type, is_compiled: bool) -> None:
    rows: NDArray[Any] = np.arange(12).reshape(4, 3).astype(kind)
    longer = (
        njit(lambda rows: with_room(rows, 3, 9))(rows) if is_compiled else with_room(rows, 3, 9)
    )
    assert longer.shape == (9, 3)
    assert longer.dtype == kind
    assert np.array_equal(longer[:3], rows[:3])
    longer[0, 0] = 7
    assert rows[0, 0] == 0
