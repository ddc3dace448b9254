"""A live robot that keeps its emergency stop, and whose program just ends in the end."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Protocol, TypeVar


class Living(Protocol):
    """What is begun and ended of a live robot's client."""

    def keep_stop(self, folder: Path) -> None:
        """Keep the emergency stop in a folder."""

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
