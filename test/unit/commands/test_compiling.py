from __future__ import annotations

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from roomba.commands.compiling import compiled_functions_told


def test_each_function_is_told_when_it_begins_to_be_compiled(
    capsys: pytest.CaptureFixture[str],
) -> None:
    @njit(nogil=True)
    def inner(values: NDArray[np.float64]) -> None:
        values += 1.0

    @njit(nogil=True)
    def outer(values: NDArray[np.float64]) -> None:
        inner(values)
        values *= 2.0

    values = np.zeros(1)
    with compiled_functions_told():
        outer(values)
        outer(values)  # compiled already
    assert values == 6.0
    outer(np.zeros(1, np.float32))  # compiled for other values, and not told
    told = capsys.readouterr().out.splitlines()
    assert [line.partition(": ")[0] for line in told] == ["1", "2"]
    assert [line.rpartition(".")[2] for line in told] == ["outer", "inner"]
