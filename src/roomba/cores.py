"""How many cores of the machine this process may use."""

from __future__ import annotations

import os


def usable_cores() -> int:
    """Return how many cores the process was given (Linux), elsewhere all cores; at least 1."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
