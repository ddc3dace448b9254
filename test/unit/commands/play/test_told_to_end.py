"""A signal raises, and is remembered."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest

from roomba.commands.play.told_to_end import ToldToEnd

NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


@pytest.fixture(autouse=True)
def handlers_kept() -> Iterator[None]:
    before = {each: signal.getsignal(each) for each in NUMBERS}
    yield
    for each, handler in before.items():
        signal.signal(each, handler)


@pytest.mark.parametrize("number", NUMBERS)
def test_a_signal_raises_and_is_remembered(number: signal.Signals) -> None:
    ending = ToldToEnd()
    assert not ending.is_told
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(number)
    assert ending.is_told


def test_a_lost_terminal_is_passed_over_where_it_was_before() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    ending = ToldToEnd()
    signal.raise_signal(signal.SIGHUP)
    assert not ending.is_told
