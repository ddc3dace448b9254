"""Tells which function is being compiled, line by line: the first set-up compiles for minutes."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

from numba.core import event


@contextlib.contextmanager
def compiled_functions_told() -> Iterator[None]:
    """Print the number and the name of each function that numba begins to compile here.

    What is loaded from the cache on disk is not told.
    """
    with event.install_listener("numba:compile", _Teller()):
        yield


class _Teller(event.Listener):
    """Counts what begins to be compiled."""

    def __init__(self) -> None:
        self._count = 0

    def on_start(self, event: Any) -> None:
        """Tell the function that the event is about."""
        function = event.data["dispatcher"].py_func
        self._count += 1
        print(f"{self._count}: {function.__module__}.{function.__qualname__}", flush=True)

    def on_end(self, event: Any) -> None:
        """Say nothing: the next function tells that this one is done."""
