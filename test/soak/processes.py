"""Processes of the robot that are killed or stopped at random moments of cleans."""

from __future__ import annotations

import os
import random
import signal
import time
from typing import Final

from fixtures.graph import RUN, RosGraph
from fixtures.homes.tiny_home import tiny_home
from soak.arena import Arena
from soak.cleaner import ENDED, Cleaner
from soak.rows import Row, in_child, tell

NOTICED: Final = 1.0
"""s of wall time until a fault is reported, as docs/reliability.md promises."""
BACK: Final = 5.0
"""s of wall time until a process that ended is back."""
STOPPED: Final = 2.0
"""s of wall time that the supervisor first waits for a stopped process."""
CALM: Final = (2.0, 8.0)
"""s of wall time between two faults."""
KILLABLE: Final = (*(name for name in RUN if name != "home_sim_node"), "dashboard_node")
"""Processes to kill; not the body, which is required: all others end with it."""


def processes(arena: Arena) -> list[Row]:
    """Kill and stop nodes and the master, for the given time."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}", "page:=true", "page_port:=0")

        def work() -> list[Row]:
            cleaner = Cleaner(graph)
            disturber = Disturber(graph, cleaner, arena.random)
            end = time.monotonic() + arena.seconds
            while time.monotonic() < end:
                cleaner.keep_cleaning()
                time.sleep(arena.random.uniform(*CALM))
                disturber.disturb()
            cleaner.finish()
            return [cleaner.row, *disturber.rows]

        return in_child(arena.folder, work, 2.0 * arena.seconds + 2.0 * ENDED)


class Disturber:
    """Kills and stops processes of a robot; each kind of fault has a row.

    Every kind comes once, in any order, before one comes again: none is left out by chance.
    """

    def __init__(self, graph: RosGraph, cleaner: Cleaner, random: random.Random) -> None:
        """Do nothing yet to the robot that ``cleaner`` lets clean."""
        self._graph, self._cleaner, self._random = graph, cleaner, random
        self._rows: dict[str, Row] = {}
        self._left: list[tuple[str, signal.Signals]] = []

    @property
    def rows(self) -> list[Row]:
        """The results, a row for each kind of fault."""
        return [self._rows[name] for name in sorted(self._rows)]

    def disturb(self) -> None:
        """Let one fault happen; note when it was reported, and when all was well again."""
        if not self._left:
            self._left = [(name, signal.SIGKILL) for name in (*KILLABLE, "master")]
            self._left += [(name, signal.SIGSTOP) for name in KILLABLE]
            self._random.shuffle(self._left)
        name, number = self._left.pop()
        if number == signal.SIGKILL:
            self._disturb(f"kill {name}", name, number, BACK)
        else:
            self._disturb(f"stop {name}", name, number, STOPPED + BACK)

    def _disturb(self, what: str, name: str, number: signal.Signals, back: float) -> None:
        tell(what)
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
