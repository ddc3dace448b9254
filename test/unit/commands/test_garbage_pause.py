"""The collector skips objects that imports made, and collects later garbage."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest

from roomba.commands.garbage_pause import nothing_thrown_away


class Thing:
    """One that refers to itself."""

    def __init__(self) -> None:
        self.own = self


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    yield
    gc.unfreeze()


def test_nothing_is_looked_through_meanwhile_nor_what_was_made_then() -> None:
    with nothing_thrown_away():
        assert not gc.isenabled()
        kept = [Thing() for _ in range(10)]
    assert gc.isenabled()
    assert gc.get_freeze_count() >= len(kept)
    assert not any(each is thing for each in gc.get_objects() for thing in kept)


def test_garbage_of_later_is_thrown_away_as_ever() -> None:
    with nothing_thrown_away():
        pass
    seen = weakref.ref(Thing())
    gc.collect()
    assert seen() is None


def test_a_collector_that_was_off_stays_off() -> None:
    gc.disable()
    try:
        with pytest.raises(ImportError), nothing_thrown_away():
            raise ImportError
        assert not gc.isenabled()
    finally:
        gc.enable()
