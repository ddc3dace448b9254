"""Free memory of the heap is given back, although memory at its end stays in use."""

from __future__ import annotations

import subprocess
import sys

_PROGRAM = """
import numpy as np
from pathlib import Path
from roomba_ros.runtime.heap import give_back

def held():
    line = next(l for l in Path("/proc/self/status").read_text().splitlines() if "RssAnon" in l)
    return int(line.split()[1]) // 1024

each = [np.ones(8000) for _ in range(1600)]
last = each.pop()
each.clear()
before = held()
give_back()
print(before - held())
"""
_HELD = 90
"""MB of the 98 that were taken in pieces too small for maps of their own."""


def test_what_is_free_below_something_that_stays_is_given_back() -> None:
    told = subprocess.run(
        [sys.executable, "-c", _PROGRAM], capture_output=True, text=True, check=True, timeout=60.0
    )
    assert int(told.stdout) > _HELD
