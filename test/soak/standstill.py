"""How soon the robot stands, on a fast clock and a machine whose cores all have other work."""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import Final

from fixtures.graph import RosGraph
from fixtures.nodes.ended_drives import CASES, seconds_to_rest
from fixtures.nodes.standstill import PROMISE
from soak.arena import Arena
from soak.rows import Row, in_child, tell

_SPEED: Final = 5
"""Robot seconds per second."""
_TIMES: Final = 3
"""How often each cause is tried."""
_CASE: Final = 200.0
"""s of wall time for one cause."""


def standstill(arena: Arena) -> list[Row]:
    """End drives in every way, beside as many busy loops as there are cores."""
    rows = []
    with RosGraph(arena.folder) as graph:
        graph.roslaunch(f"speed:={_SPEED}")
        for _ in range(os.cpu_count() or 2):
            graph.run(sys.executable, "-c", "while True: pass")
        for case in CASES:
            rows += in_child(arena.folder, partial(_tried, graph, case), _CASE)
    return rows


def _tried(graph: RosGraph, case: str) -> list[Row]:
    row = Row(case)
    tell(case)
    kind, cause = CASES[case]
    drive = kind(graph)
    for row.times in range(1, _TIMES + 1):
        row.expect("stands after, s of its clock", seconds_to_rest(drive, cause), PROMISE)
    drive.end()
    return [row]
