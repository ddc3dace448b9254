"""How many cores of the machine this process may use."""

from __future__ import annotations

import os


def usable_cores() -> int:
    """Return their number, at least 1: those that it was given, where the system tells (Linux)."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
