"""Threads that share out work, and belong to one object in one process."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Part = TypeVar("Part")


class Workers:
    """Threads that are made when they are first needed.

    Neither a copy nor a forked process has threads of the original: it makes its own.
    """

    def __init__(self, threads: int) -> None:
        """Make none yet; at most so many are to work at once."""
        self._threads = threads
        self._process = os.getpid()
        self._pool: ThreadPoolExecutor | None = None

    def run(self, work: Callable[[Part], object], parts: Iterable[Part]) -> None:
        """Do the ``work`` with each of the parts; raises what the first of them raises."""
        pool = self._own_pool()
        for done in [pool.submit(work, part) for part in parts]:
            done.result()

    def close(self) -> None:
        """End the threads, if there are any; they may still be used, and begin anew."""
        if self._pool is not None and self._process == os.getpid():
            self._pool.shutdown()
        self._pool = None

    def __reduce__(self) -> tuple[type[Workers], tuple[int]]:
        """Return how a copy is made."""
        return Workers, (self._threads,)

    def _own_pool(self) -> ThreadPoolExecutor:
        if self._pool is None or self._process != os.getpid():
            self._pool, self._process = ThreadPoolExecutor(self._threads), os.getpid()
        return self._pool
