"""Faults of all kinds happen to one robot in any order, while it cleans again and again."""

from __future__ import annotations

import functools
import random
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from soak.arena import Arena
from soak.attacks import connect_senselessly, flood, look
from soak.circumstances import (
    HOUR,
    SetClock,
    expect_nothing_left,
    fill,
    set_clock,
    small_disk,
    take_clock,
)
from soak.cleaner import ENDED, Cleaner
from soak.processes import CALM, Disturber
from soak.rows import Row, in_child
from soak.starts import end

CONNECTIONS: Final = 500
VIEWERS: Final = 100
FLOODED: Final = ("/cmd_vel", "/change_position", "/cmd_vel_mission", "/scan", "/odom")
"""Topics on which an empty message is no order."""
_KILLED_OF: Final = 0.5
"""Share of all faults that are processes killed or stopped."""


def mixed(arena: Arena) -> list[Row]:
    """Let faults of all kinds happen to one robot for the given time; then end it."""
    with small_disk(arena.folder / "ros_home") as disk, RosGraph(arena.folder) as graph:
        home = f"home:={tiny_home(arena.folder)}"
        run = graph.start_run(home, "clock:=false", "page:=true", "page_port:=0")
        work = functools.partial(_suffer, graph, disk, arena)
        rows = in_child(arena.folder, work, 2.0 * arena.seconds + 3.0 * ENDED)
        rows.append(Row("Ctrl-C after all that", 1))
        end(run, rows[-1], "the end")
        if disk is not None:
            expect_nothing_left(rows[-1], graph, disk)
    return rows


def _suffer(graph: RosGraph, disk: Path | None, arena: Arena) -> list[Row]:
    wait_until(graph.master_answers, START_DEADLINE, "a master")
    probe, clock = Probe(graph, "soak"), SetClock()
    wait_until(graph.all_up, START_DEADLINE, lambda: graph.programs[0].output)
    cleaner = Cleaner(graph, probe)
    disturber = Disturber(graph, cleaner, arena.random)
    others = _others(graph, cleaner, clock, disk, arena.random)
    rows: dict[str, Row] = {}
    left: list[Callable[[], list[Row]]] = []
    until = time.monotonic() + arena.seconds
    while time.monotonic() < until:
        cleaner.keep_cleaning()
        time.sleep(arena.random.uniform(*CALM))
        if arena.random.random() < _KILLED_OF:
            disturber.disturb()
            continue
        if not left:
            left = arena.random.sample(others, len(others))
        for row in left.pop()():
            rows.setdefault(row.what, Row(row.what)).add(row)
    cleaner.finish()
    return [cleaner.row, *disturber.rows, *(rows[name] for name in sorted(rows))]


def _others(
    graph: RosGraph, cleaner: Cleaner, clock: SetClock, disk: Path | None, random: random.Random
) -> list[Callable[[], list[Row]]]:
    """Return the faults that are no killed processes, each once before any comes again."""
    faults: list[Callable[[], list[Row]]] = [
        lambda: [set_clock(clock, cleaner, -10.0)],
        lambda: [set_clock(clock, cleaner, jump) for jump in (HOUR, -HOUR)],
        lambda: [take_clock(clock, cleaner)],
        lambda: [flood(graph, cleaner, random.choice(FLOODED))],
        lambda: [connect_senselessly(graph, cleaner, random, CONNECTIONS)],
        lambda: [look(graph, cleaner, VIEWERS)],
    ]
    if disk is not None:
        faults.append(lambda: [fill(cleaner, disk)])
    return faults
