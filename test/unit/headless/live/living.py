"""A live robot that keeps its emergency stop, and whose program just ends in the end."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol, TypeVar

import pytest

from roomba.client.protocol import RobotUnavailableError
from roomba.headless.live import held_stop

DEADLINE = 20.0
"""s of wall time."""


class Living(Protocol):
    """What is begun and ended of a live robot's client."""

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in a folder."""

    def emergency_stop(self, reason: str) -> None:
        """Hold the drive."""

    def start(self) -> None:
        """Let the robot live."""

    def end(self) -> None:
        """Let its time stop."""


_Client = TypeVar("_Client", bound=Living)


@contextlib.contextmanager
def living(client: _Client, stops: Path) -> Iterator[_Client]:
    """Let a robot live that keeps its emergency stop in the folder ``stops``."""
    client.keep_stop(stops)
    client.start()
    yield client
    client.end()


def stop_while_busy(
    client: Living,
    ask: Callable[[Callable[[object], None]], object],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Ask for the emergency stop while the robot's thread, by ``ask``, has no time to answer."""
    is_busy, may_go_on = threading.Event(), threading.Event()

    def work(_: object) -> None:
        is_busy.set()
        may_go_on.wait(DEADLINE)

    monkeypatch.setattr(held_stop, "ANSWER", 0.05)
    busy = threading.Thread(target=ask, args=(work,))
    busy.start()
    assert is_busy.wait(DEADLINE)
    with pytest.raises(RobotUnavailableError, match="holds as soon as it answers"):
        client.emergency_stop("the cat")
    may_go_on.set()
    busy.join(DEADLINE)
