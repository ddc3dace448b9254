"""Wishes are sent one after another, each within a deadline; stops are sent before the end."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.drivers.line import LineError
from roomba.errors import RoombaError
from roomba.headless.live.remote.teller import Teller
from roomba.robot.remote import RemoteWish, WishRefusedError

DEADLINE = 20.0
"""s of wall time."""


@pytest.fixture
def teller() -> Iterator[Teller]:
    made = Teller()
    yield made
    made.end()


def test_wishes_are_told_in_their_order(teller: Teller) -> None:
    told: list[str] = []
    teller.put(RemoteWish.PAUSE, lambda: told.append("pause"))
    teller.carry_out(RemoteWish.DOCK, lambda: told.append("dock"))
    assert told == ["pause", "dock"]


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (LineError("gone"), RobotUnavailableError),
        (WishRefusedError("no"), RequestRefusedError),
        (RequestRefusedError("held"), RequestRefusedError),
        (RobotUnavailableError("over"), RobotUnavailableError),
    ],
)
def test_what_is_refused_differs_from_what_is_not_reached(
    teller: Teller, error: RoombaError, expected: type[RoombaError]
) -> None:
    def tell() -> None:
        raise error

    with pytest.raises(expected, match=str(error)):
        teller.carry_out(RemoteWish.STOP, tell)


def test_a_wish_that_is_under_way_too_long_may_still_be_obeyed(
    teller: Teller, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.headless.live.remote.teller._DEADLINE", 0.05)
    may_end = threading.Event()
    with pytest.raises(RobotUnavailableError, match="may still"):
        teller.carry_out(RemoteWish.DOCK, lambda: assert_set(may_end))
    may_end.set()


def test_stops_that_take_too_long_do_not_hold_up_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roomba.headless.live.remote.teller._ENDING", 0.05)
    teller, may_end, told = Teller(), threading.Event(), list[str]()
    teller.put(RemoteWish.DOCK, lambda: assert_set(may_end))
    late = teller.put(RemoteWish.STOP, lambda: told.append("stop"))
    teller.end()
    assert late.cancelled()
    may_end.set()
    assert told == []


def assert_set(event: threading.Event) -> None:
    assert event.wait(DEADLINE)
