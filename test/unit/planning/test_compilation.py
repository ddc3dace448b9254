"""Inner loops are compiled without a runtime for references."""

from __future__ import annotations

import numpy as np
import pytest
from numba.core.errors import NumbaError
from numpy.typing import NDArray

from roomba.planning.compilation import part


def doubled(values: NDArray[np.float64], out: NDArray[np.float64]) -> float:
    total = 0.0
    for index in range(values.size):
        out[index] = 2.0 * values[index]
        total += out[index]
    return total


def copied(values: NDArray[np.float64]) -> float:
    return float(values.copy()[0])


def test_a_part_does_what_its_function_does() -> None:
    values, out = np.array([1.0, 2.5]), np.empty(2)
    assert part(doubled)(values, out) == doubled(values, np.empty(2)) == 7.0
    assert out.tolist() == [2.0, 5.0]


def test_a_part_that_allocates_is_refused() -> None:
    with pytest.raises(NumbaError):
        part(copied)(np.ones(3))
