"""SIGINT and SIGTERM end the server of a page, at any moment."""

from __future__ import annotations

import os
import signal
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fixtures.robots.able_robot import AbleRobot

from roomba.commands.play import serving
from roomba.commands.play.told_to_end import ToldToEnd
from roomba.ui.web.server import PageServer, ServerError, listen

DEADLINE = 15
"""s; a page that is still served then heard nothing."""
SOON = 5.0
"""s; so long ending takes at most."""


def _too_late(*_: object) -> None:
    raise AssertionError(f"it is still served after {DEADLINE} s")


@pytest.fixture(autouse=True)
def told_to_end() -> Iterator[None]:
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
    before = {each: signal.getsignal(each) for each in numbers}
    signal.signal(signal.SIGALRM, _too_late)
    signal.alarm(DEADLINE)
    yield
    signal.alarm(0)
    for each, handler in before.items():
        signal.signal(each, handler)


@pytest.fixture
def bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[socket.socket]:
    monkeypatch.setenv("ROOMBA_TOKEN_FILE", str(tmp_path / "token"))
    with listen("127.0.0.1", 0, is_fixed=True) as bound:
        yield bound


def tell(number: signal.Signals) -> None:
    os.kill(os.getpid(), number)


def serve(bound: socket.socket, ending: ToldToEnd) -> None:
    serving.serve_page(AbleRobot(), bound, "A robot. Its page:", ending, is_opened=False)


def expect_no_page() -> None:
    for thread in threading.enumerate():
        if thread.name == "page":
            thread.join(SOON)
            assert not thread.is_alive()


MOMENTS = {
    "while the page is made": (serving, "create_app"),
    "as it begins to serve": (PageServer, "start"),
    "while the address is printed": (serving, "_tell"),
    "while it serves": (PageServer, "has_ended"),
}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("moment", MOMENTS)
def test_told_to_end_at_any_moment_it_ends_and_serves_no_more(
    bound: socket.socket, monkeypatch: pytest.MonkeyPatch, number: signal.Signals, moment: str
) -> None:
    owner, name = MOMENTS[moment]
    plain = getattr(owner, name)
    told_at: list[float] = []

    def told_then(*arguments: Any, **named: Any) -> Any:
        told_at.append(time.monotonic())
        threading.Timer(0.005, tell, [number]).start()
        return plain(*arguments, **named)

    monkeypatch.setattr(owner, name, told_then)
    serve(bound, ToldToEnd())
    assert time.monotonic() - told_at[0] < SOON
    expect_no_page()


class ToldAsItGoes:
    """An object that is being deleted when the signal comes."""

    def __del__(self) -> None:
        """Be told to end; Python drops what this raises."""
        signal.raise_signal(signal.SIGTERM)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_told_to_end_while_an_object_is_deleted_it_ends(
    bound: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    owner, name = MOMENTS["while the page is made"]
    plain = getattr(owner, name)

    def told_first(*arguments: Any, **named: Any) -> Any:
        ToldAsItGoes()
        return plain(*arguments, **named)

    monkeypatch.setattr(owner, name, told_first)
    began = time.monotonic()
    serve(bound, ToldToEnd())
    assert time.monotonic() - began < SOON
    expect_no_page()


def test_in_the_background_of_a_shell_it_hears_that_it_is_to_end(bound: socket.socket) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    ending = ToldToEnd()
    threading.Timer(0.3, tell, [signal.SIGINT]).start()
    serve(bound, ending)
    expect_no_page()


def test_it_serves_without_a_standard_output(
    bound: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdout", None)  # as a shell closes it by >&-
    ending = ToldToEnd()
    threading.Timer(0.3, tell, [signal.SIGINT]).start()
    serve(bound, ending)
    expect_no_page()


def test_a_server_that_breaks_is_told(
    bound: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def breaks(*_: object, **__: object) -> None:
        raise OSError("no more files")

    monkeypatch.setattr("uvicorn.Server.serve", breaks)
    with pytest.raises(ServerError, match="no more files"):
        serve(bound, ToldToEnd())
