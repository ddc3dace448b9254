"""The first signal raises, and is remembered; later ones do not interrupt the end."""

from __future__ import annotations

import signal
import subprocess
import sys
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


@pytest.mark.parametrize("number", NUMBERS)
def test_a_signal_while_it_ends_interrupts_nothing(number: signal.Signals) -> None:
    ending = ToldToEnd()
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    for _ in range(9):
        signal.raise_signal(number)
    assert ending.is_told


def test_a_lost_terminal_is_passed_over_where_it_was_before() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    ending = ToldToEnd()
    signal.raise_signal(signal.SIGHUP)
    assert not ending.is_told


HANGING = """
import signal
from roomba.commands.play.told_to_end import ToldToEnd
ending = ToldToEnd(patience=0.0)
try:
    signal.raise_signal(signal.SIGTERM)
except KeyboardInterrupt:
    signal.raise_signal(signal.SIGINT)
print("it went on")
"""


def test_an_end_that_hangs_is_ended_by_a_late_signal() -> None:
    done = subprocess.run([sys.executable, "-c", HANGING], capture_output=True, timeout=60.0)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, b"", b"")
