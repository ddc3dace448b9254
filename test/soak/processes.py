"""Processes of the robot that are killed or stopped at random moments of cleans."""

from __future__ import annotations

import os
import random
import signal
import time
from typing import Final

from fixtures.graph import RUN, RosGraph
from fixtures.tiny_home import tiny_home
from soak.arena import Arena
from soak.cleaner import ENDED, Cleaner
from soak.rows import Row, in_child

NOTICED: Final = 1.0
"""s of wall time until a fault is told of, as docs/reliability.md promises."""
BACK: Final = 5.0
"""s of wall time until a process that ended is back."""
STOPPED: Final = 2.0
"""s of wall time for which a stopped process is waited for before that."""
CALM: Final = (2.0, 8.0)
"""s of wall time between two faults."""
KILLABLE: Final = tuple(name for name in RUN if name != "home_sim_node")
"""The body is required: all end with it."""


def processes(arena: Arena) -> list[Row]:
    """Kill and stop nodes and the master, for the time that is given."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}")
        return in_child(
            arena.folder,
            lambda: _Disturber(graph, arena.random).run(arena.seconds),
            2.0 * arena.seconds + 2.0 * ENDED,
        )


class _Disturber:
    def __init__(self, graph: RosGraph, random: random.Random) -> None:
        self._graph, self._random = graph, random
        self._cleaner = Cleaner(graph)
        self._rows: dict[str, Row] = {}

    def run(self, seconds: float) -> list[Row]:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._cleaner.keep_cleaning()
            time.sleep(self._random.uniform(*CALM))
            self._random.choice((self._kill, self._stop, self._kill_master))()
        self._cleaner.finish()
        return [self._cleaner.row, *(self._rows[name] for name in sorted(self._rows))]

    def _kill(self) -> None:
        name = self._random.choice(KILLABLE)
        self._disturb(f"kill {name}", name, signal.SIGKILL, BACK)

    def _stop(self) -> None:
        name = self._random.choice(KILLABLE)
        self._disturb(f"stop {name}", name, signal.SIGSTOP, STOPPED + BACK)

    def _kill_master(self) -> None:
        self._disturb("kill master", "master", signal.SIGKILL, BACK)

    def _disturb(self, what: str, name: str, number: signal.Signals, back: float) -> None:
        """Do something to a process; note when that was told, and when all was well again."""
        row = self._rows.setdefault(what, Row(what))
        row.times += 1
        trouble = self._cleaner.trouble
        old, told = self._graph.process(name), len(trouble)
        os.kill(old, number)
        if name != "supervisor_node":
            row.expect_within("noticed", NOTICED, lambda: any(trouble[told:]))

        def is_well() -> bool:
            return self._graph.process(name) != old and self._is_well(name)

        row.expect_within("back", back, is_well)
        self._cleaner.goes_on(row)

    def _is_well(self, name: str) -> bool:
        if name == "master":
            return self._graph.master_answers()
        return self._cleaner.trouble[-1] == "" and self._graph.answers(name)
