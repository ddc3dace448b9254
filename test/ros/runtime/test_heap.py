"""What is free in the heap goes back to the system, though something beside it stays."""

from __future__ import annotations

import subprocess
import sys

_HELD = """
import numpy as np
from pathlib import Path
from roomba_ros.runtime.heap import give_back, keep_large_blocks_apart

def held():
    line = next(l for l in Path("/proc/self/status").read_text().splitlines() if "RssAnon" in l)
    return int(line.split()[1]) // 1024
"""
_SMALL_BLOCKS = """
each = [np.ones(8000) for _ in range(1600)]
last = each.pop()
each.clear()
before = held()
give_back()
print(before - held())
"""
_LARGE_BLOCKS = """
# As a first picture: what it takes is given back, and from then on counts as small.
np.ones(2_000_000).sum()
keep_large_blocks_apart() if {apart} else None
before = held()
blocks = [(np.ones(125_000), np.ones(1000)) for _ in range(50)]
stay = [small for _, small in blocks]
del blocks
print(held() - before)
"""
_MOST = 90
"""MB of the 98 that were taken in pieces too small for maps of their own."""


def told(program: str) -> int:
    """Return what a Python program prints."""
    command = [sys.executable, "-c", _HELD + program]
    ended = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60.0)
    return int(ended.stdout)


def test_what_is_free_below_something_that_stays_is_given_back() -> None:
    assert told(_SMALL_BLOCKS) > _MOST


def test_large_blocks_go_back_at_once_whatever_was_taken_before() -> None:
    # 50 MB beside small arrays that stay.
    assert told(_LARGE_BLOCKS.format(apart=True)) < 3
    assert told(_LARGE_BLOCKS.format(apart=False)) > 40
