"""Functions that Python calls, and their parts, with and without a runtime for references."""

from __future__ import annotations

import ast
import fcntl
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba.core.caching import IndexDataCacheFile
from numba.core.errors import NumbaError
from numpy.typing import NDArray

from roomba import compilation
from roomba.compilation import (
    allocating_entry,
    allocating_part,
    any_order_entry,
    any_order_part,
    entry,
    inlined_entry,
    inner_part,
    part,
)

SOURCES = Path(__file__).parents[2] / "src"
ALLOCATES_NOT = {"entry", "part", "inner_part", "inlined_entry", "any_order_part"}
ALLOCATES = {"allocating_entry", "allocating_part", "any_order_entry"}
SCALARS = {"bool", "float", "int", "None"}

Floats = NDArray[np.float64]


def doubled(values: Floats, out: Floats) -> float:
    total = 0.0
    for index in range(values.size):
        out[index] = 2.0 * values[index]
        total += out[index]
    return total


def copying() -> Callable[[Floats], float]:
    """A new function each time: what one is made for is remembered with it."""

    def copied(values: Floats) -> float:
        return float(values.copy()[0])

    return copied


@pytest.mark.parametrize("how", [entry, allocating_entry, any_order_entry, inlined_entry])
def test_an_entry_does_what_its_function_does(how: Callable[[object], object]) -> None:
    values, out = np.array([1.0, 2.5]), np.empty(2)
    compiled = how(doubled)
    assert hasattr(compiled, "py_func")  # Compiled, and not the function itself.
    assert compiled(values, out) == doubled(values, np.empty(2)) == 7.0  # type: ignore[operator]
    assert out.tolist() == [2.0, 5.0]


@pytest.mark.parametrize("how", [part, allocating_part, inner_part, any_order_part])
def test_a_part_is_compiled_in_an_entry_and_plain_python_elsewhere(
    how: Callable[[object], Callable[[Floats, Floats], float]],
) -> None:
    inner = how(doubled)

    def twice(values: Floats, out: Floats) -> float:
        return 2.0 * inner(values, out)

    assert inner is doubled
    assert entry(twice)(np.array([1.0, 2.5]), np.empty(2)) == 14.0


@pytest.mark.parametrize("how", [entry, inlined_entry])
def test_an_entry_that_must_not_allocate_is_refused_if_it_does(
    how: Callable[[object], Callable[[Floats], float]],
) -> None:
    with pytest.raises(NumbaError):
        how(copying())(np.ones(3))


@pytest.mark.parametrize("how", [part, inner_part, any_order_part])
def test_a_part_that_must_not_allocate_is_refused_in_any_entry(
    how: Callable[[object], Callable[[Floats], float]],
) -> None:
    inner = how(copying())

    def called(values: Floats) -> float:
        return inner(values)

    with pytest.raises(NumbaError):
        allocating_entry(called)(np.ones(3))


def test_a_part_may_allocate_in_an_entry_that_does_not() -> None:
    inner = allocating_part(copying())

    def called(values: Floats) -> float:
        return inner(values)

    assert entry(called)(np.array([2.5])) == 2.5


def test_no_function_without_references_is_given_a_new_array() -> None:
    """Nothing would free it."""
    functions = [
        (path, function, how)
        for path in SOURCES.rglob("*.py")
        for function in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(function, ast.FunctionDef)
        for how in function.decorator_list
        if isinstance(how, ast.Name) and how.id in ALLOCATES | ALLOCATES_NOT
    ]
    givers = {
        function.name for _, function, how in functions if how.id in ALLOCATES and gives(function)
    }
    assert len(givers) > 10
    leaks = [
        f"{path.relative_to(SOURCES)}: {function.name} calls {call.func.id}"
        for path, function, how in functions
        if how.id in ALLOCATES_NOT
        for call in ast.walk(function)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in givers
    ]
    assert leaks == []


AT_START = """
import sys
import roomba.compilation
print("scipy.linalg" in sys.modules)

import numba
import numpy as np
numba.njit(lambda values: values[0])(np.ones(2))
print("scipy.linalg" in sys.modules)
print(numba.njit(lambda one, other: one @ other)(2.0 * np.eye(2), np.ones((2, 2))).tolist())
"""


def test_linear_algebra_is_read_when_it_is_needed_and_not_at_each_start() -> None:
    told = subprocess.run(
        [sys.executable, "-c", AT_START],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
    ).stdout
    assert told.split("\n")[:3] == ["False", "False", "[[2.0, 2.0], [2.0, 2.0]]"]


def gives(function: ast.FunctionDef) -> bool:
    """Whether a function returns more than numbers."""
    assert function.returns is not None
    names = [node for node in ast.walk(function.returns) if isinstance(node, ast.Name)]
    return not all(node.id in SCALARS | {"tuple"} for node in names)


def test_code_is_kept_by_one_process_at_a_time(tmp_path: Path) -> None:
    """Of two at once one could take the other's code for its own."""
    of_numba: Any = IndexDataCacheFile
    kept = of_numba(str(tmp_path), "loops", "of these sources")
    saving = threading.Thread(target=kept.save, args=("signature", "code"))
    with open(compilation.__file__, "rb") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        saving.start()
        saving.join(0.1)
        assert saving.is_alive()
    saving.join(5.0)
    assert kept.load("signature") == "code"
