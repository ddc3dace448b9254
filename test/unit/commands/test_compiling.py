from __future__ import annotations

import gc
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from roomba.commands.compiling import compiled_functions_told, compiling_counted


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


def test_compiling_is_told_in_words_and_what_is_compiled_is_not() -> None:
    @njit(nogil=True)
    def doubled(values: NDArray[np.float64]) -> None:
        values *= 2.0

    values, told = np.ones(1), list[str]()
    with compiling_counted(told.append):
        doubled(values)
        doubled(values)
    assert values == 4.0
    assert told == ["compiling, this once: function 1"]


def test_garbage_is_looked_for_as_usual_after_compiling() -> None:
    usual = gc.get_threshold()
    with compiled_functions_told():
        assert gc.get_threshold()[0] > usual[0]
    assert gc.get_threshold() == usual


def test_what_is_not_compiled_is_found(tmp_path: Path) -> None:
    """Of all, without a cache; one less, once that was called."""
    program = (
        "import sys; import numpy as np; from roomba.commands.compiling import left_to_compile; "
        "from roomba.raster.distance import distance_to_nearest; "
        "before = left_to_compile(); distance_to_nearest(np.eye(3, dtype=bool)); "
        "print(len(before), *(set(before) - set(left_to_compile())))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
        timeout=120.0,
    )
    count, *compiled = done.stdout.split()
    assert int(count) > 100
    assert compiled == ["roomba.raster.distance._transform"]
