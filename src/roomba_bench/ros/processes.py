"""The cost of running processes: memory as Linux counts it, and processor time."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Final

_PROC: Final = Path("/proc")
_TICK: Final = os.sysconf("SC_CLK_TCK")


def family_of(pid: int) -> list[int]:
    """Return a process and all that descend from it."""
    parents = {}
    for folder in _PROC.iterdir():
        # One that has just ended.
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            if folder.name.isdecimal():
                parents[int(folder.name)] = int(_fields(int(folder.name))[1])
    family = [pid]
    for member in family:
        family += [child for child, parent in parents.items() if parent == member]
    return family


def memory(pids: Iterable[int]) -> float:
    """Return the proportional set size of processes together, MB: shared memory counts once."""
    size = 0
    for pid in pids:
        # One that has just ended takes nothing.
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            lines = (_PROC / str(pid) / "smaps_rollup").read_text("ascii").splitlines()
            size += sum(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    return size * 1.024 / 1000.0


def load(pids: Iterable[int], seconds: float) -> float:
    """Return the load of processes, % of a core, over so many seconds from now."""
    before, began = {pid: _used(pid) for pid in pids}, time.monotonic()
    time.sleep(seconds)
    # A process that ended meanwhile counts as 0, not as a negative time.
    used = sum(max(_used(pid) - each, 0.0) for pid, each in before.items())
    return 100.0 * used / (time.monotonic() - began)


def _used(pid: int) -> float:
    """Return s of a core that a process has had, all its threads together; 0 when it has ended."""
    try:
        fields = _fields(pid)
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return (int(fields[11]) + int(fields[12])) / _TICK


def _fields(pid: int) -> list[str]:
    """Return what proc(5) tells of a process, from its state on."""
    return (_PROC / str(pid) / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()
