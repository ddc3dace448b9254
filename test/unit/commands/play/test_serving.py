"""A page is served until the program is told to end, at whatever moment that is."""

from __future__ import annotations

import os
import signal
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.robots.able_robot import AbleRobot

from roomba.commands.play import serving
from roomba.ui.web.server import PageServer, listen


@pytest.fixture(autouse=True)
def handlers() -> Iterator[None]:
    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    yield
    for each, handler in before.items():
        signal.signal(each, handler)


@pytest.fixture
def bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[socket.socket]:
    monkeypatch.setenv("ROOMBA_TOKEN_FILE", str(tmp_path / "token"))
    with listen("127.0.0.1", 0, is_fixed=True) as bound:
        yield bound


def told(number: signal.Signals) -> None:
    os.kill(os.getpid(), number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("moment", ["start", "wait"])
def test_told_to_end_at_any_moment_it_ends_and_serves_no_more(
    bound: socket.socket, monkeypatch: pytest.MonkeyPatch, number: signal.Signals, moment: str
) -> None:
    plain = getattr(PageServer, moment)

    def told_then(server: PageServer) -> None:
        # As it begins, or a little later, while it serves.
        threading.Timer(0.0 if moment == "start" else 0.2, told, [number]).start()
        plain(server)

    monkeypatch.setattr(PageServer, moment, told_then)
    serving.serve_page(AbleRobot(), bound, "A robot. Its page:", is_opened=False)
    for thread in threading.enumerate():
        if thread.name == "page":
            thread.join(1.0)
            assert not thread.is_alive()


def test_in_the_background_of_a_shell_it_hears_that_it_is_to_end(bound: socket.socket) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Timer(0.3, told, [signal.SIGINT]).start()
    serving.serve_page(AbleRobot(), bound, "A robot. Its page:", is_opened=False)
