"""Parts: compiled once for each kind of arguments, and made into machine code in entries only."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from numba.core import event
from numba.core.codegen import JITCodeLibrary
from numpy.typing import NDArray

from roomba.compilation import (
    allocating_entry,
    allocating_part,
    any_order_entry,
    compiled,
    entry,
    inlined_entry,
    inner_part,
    part,
)

Floats = NDArray[np.float64]

ENTRY = {"error_model": "numpy", "_nrt": False}
"""Options of an entry of which no code is kept: it is compiled in each test."""
ALLOCATING_ENTRY = {**ENTRY, "_nrt": True, "nogil": True}


class Compiled(event.Listener):
    """Notes names of what is compiled."""

    def __init__(self) -> None:
        """Have noted nothing."""
        self.names: list[str] = []

    def on_start(self, event: Any) -> None:
        """Note a function."""
        self.names.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event: Any) -> None:
        """Note nothing."""


@pytest.fixture
def names() -> Iterator[list[str]]:
    with event.install_listener("numba:compile", listener := Compiled()):
        yield listener.names


def test_a_part_is_compiled_once_for_all_kinds_of_callers(names: list[str]) -> None:
    @part
    def shared(values: Floats, factor: int) -> float:
        return float(values[0] * factor)

    @inner_part
    def inner(values: Floats) -> float:
        return shared(values, 2) + shared(values, 3)

    @allocating_part
    def allocating(values: Floats) -> float:
        return shared(values, 4)

    @compiled(**ALLOCATING_ENTRY)
    def first(values: Floats) -> float:
        return inner(values) + allocating(values) + shared(values, 5)

    @compiled(**ENTRY)
    def second(values: Floats) -> float:
        return inner(values) + shared(values, values.size)

    assert first(np.ones(1)) == 14.0
    assert second(np.ones(1)) == 6.0
    assert sorted(names) == ["allocating", "first", "inner", "second", "shared"]


def test_machine_code_is_made_of_entries_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    finish: Any = JITCodeLibrary._finalize_specific

    def noted(library: JITCodeLibrary) -> None:
        made.append(library.name)
        finish(library)

    monkeypatch.setattr(JITCodeLibrary, "_finalize_specific", noted)

    @part
    def halved(values: Floats) -> float:
        return float(0.5 * values[0])

    @compiled(**ENTRY)
    def quarter(values: Floats) -> float:
        return 0.5 * halved(values)

    assert quarter(np.ones(1)) == 0.25
    assert [name.rpartition(".")[2] for name in made] == ["quarter"]


def test_a_part_may_raise_what_it_makes_of_its_arguments() -> None:
    @allocating_part
    def checked(value: int) -> int:
        if value < 0:
            raise ValueError("expected 0 or more, got", value)
        return value

    @compiled(**ALLOCATING_ENTRY)
    def called(value: int) -> int:
        return checked(value)

    assert called(3) == 3
    with pytest.raises(ValueError, match="expected 0 or more, got") as raised:
        called(-4)
    assert raised.value.args[1] == -4


@pytest.mark.parametrize("how", [entry, allocating_entry, any_order_entry, inlined_entry])
def test_an_entry_takes_over_nothing_of_its_first_caller(how: Callable[[Any], Any]) -> None:
    """Else it would be another one by what was compiled first."""
    options = how(lambda values: values[0]).targetoptions
    assert {"error_model", "fastmath", "forceinline", "_nrt"} <= set(options)
