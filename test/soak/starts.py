"""Starts and stops, at random moments too: no process is left, and none has to be killed."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Final

from fixtures.graph import RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.processes.programs import Program
from soak.arena import Arena
from soak.rows import Row, tell, until

GONE: Final = 3.0
"""s of wall time until no process is left after Ctrl-C."""
_START: Final = 6.0
"""s of wall time that a start takes on a machine that does nothing else; one that is stopped
earlier is stopped in the middle of it."""
_PATIENCE: Final = 100.0


def starts(arena: Arena) -> list[Row]:
    """Start the robot and end it by Ctrl-C, by turns when it is up and at any moment before."""
    whole, half = Row("started, then Ctrl-C"), Row("Ctrl-C at a moment of the start")
    for number in range(arena.starts):
        folder = arena.folder / str(number)
        folder.mkdir()
        with RosGraph(folder) as graph:
            if number % 2:
                _start_and_end(graph, half, arena.random.uniform(0.0, _START))
            else:
                _start_and_end(graph, whole, None)
    return [whole, half]


def _start_and_end(graph: RosGraph, row: Row, moment: float | None) -> None:
    """Start a robot, and end it after so many s of wall time, or when it is up."""
    run = graph.start_run(f"home:={tiny_home(graph.folder)}")
    row.times += 1
    tell(f"{row.what}: {row.times}")
    if moment is None:
        took = until(lambda: graph.all_up() or run.status is not None, _PATIENCE)
        row.measured("up", _PATIENCE if took is None else took)
    else:
        until(lambda: run.status is not None, moment)
    end(
        run, row, f"start {row.times}" + ("" if moment is None else f", ended after {moment:.2f} s")
    )


def end(run: Program, row: Row, which: str) -> None:
    """End a robot by Ctrl-C; note if it took long, left or killed processes, or printed errors."""
    started = _members(run.process.pid)
    run.send_to_leader(signal.SIGINT)
    row.expect_within("gone", GONE, lambda: run.status is not None)
    # A child that reads the launch file ends with its parent, by a signal of the kernel: soon.
    if until(lambda: not _there(started), GONE) is None:
        row.broken.append(f"{which}: processes {_there(started)} are left")
    for bad in ("Traceback", "has not ended yet"):
        if bad in run.output:
            row.broken.append(f"{which}: {_beginning_with(bad, run.output)}")


def _there(processes: list[int]) -> list[int]:
    return [process for process in processes if os.path.exists(f"/proc/{process}/exe")]


def _members(leader: int) -> list[int]:
    """Return the processes that a watcher has started."""
    try:
        text = Path(f"/proc/{leader}/task/{leader}/children").read_text("ascii")
    except OSError:
        return []
    return [int(process) for process in text.split()]


def _beginning_with(text: str, output: str) -> str:
    at = output.index(text)
    return output[at : at + 400].strip()
