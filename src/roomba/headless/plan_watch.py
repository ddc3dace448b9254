"""A stop watch around each coverage plan."""

from __future__ import annotations

import time


class PlanWatch:
    """Counts ``plans``, and the ``seconds`` of a wall clock that they took.

    It is entered before each plan, and left after it, also after one that failed.
    """

    def __init__(self) -> None:
        """Begin with none."""
        self.plans, self.seconds = 0, 0.0
        self._began = 0.0

    def __enter__(self) -> None:
        """Begin a plan."""
        self._began = time.perf_counter()

    def __exit__(self, *failure: object) -> None:
        """End it."""
        self.plans += 1
        self.seconds += time.perf_counter() - self._began
