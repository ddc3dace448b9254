"""The time that a whole command takes, from Enter on, and the computing time of its processes."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from roomba.commands.program_name import spelled
from roomba_bench.bench import Bench
from roomba_bench.places import HERE
from roomba_bench.record import Better, PeerFigure, Record

BEFORE: Final = "BENCH_BEFORE"
"""Environment variable: the folder of another checkout, set up, whose commands run in turns with
ours."""
_COMMANDS: Final = (("sim", "flat"), ("sim", "apartment"), ("map", "flat"), ("map", "apartment"))
_AIMS: Final = {("sim", "flat"): 1.5}
"""s, from Enter to the end, with all compiled."""
_ROUNDS, _QUICK_ROUNDS = 8, 2


@dataclass(frozen=True)
class Spent:
    """What one call took: s of a clock, and s of all cores."""

    wall: float
    computing: float


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    before = os.environ.get(BEFORE)
    programs = [HERE.program] if before is None else [HERE.program, Path(before) / "roomba"]
    rounds = _QUICK_ROUNDS if bench.is_quick else _ROUNDS
    records = []
    for command, home in _COMMANDS:
        bench.say(f"{command} --home {home}")
        calls = [[str(program), command, "--home", home, "--quiet"] for program in programs]
        best = fastest(calls, rounds, {"XDG_STATE_HOME": str(bench.folder)})
        records += rows_of(command, home, best, before)
    return records


def fastest(
    calls: Sequence[Sequence[str]], rounds: int, environment: Mapping[str, str]
) -> list[Spent]:
    """Return the best of each call, called in turns; once before that, so that all is compiled.

    Raises RuntimeError for a call that fails.
    """
    spent: list[list[Spent]] = [[] for _ in calls]
    for round_number in range(rounds + 1):
        for call, of_it in zip(calls, spent, strict=True):
            took = spent_by(call, environment)
            if round_number > 0:
                of_it.append(took)
    return [
        Spent(min(each.wall for each in of_it), min(each.computing for each in of_it))
        for of_it in spent
    ]


def spent_by(call: Sequence[str], environment: Mapping[str, str]) -> Spent:
    """Return what a command took, with all processes that it waited for.

    Raises RuntimeError if it fails.
    """
    began = time.perf_counter()
    with subprocess.Popen(
        call,
        env={**os.environ, **environment},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stderr is not None
        told = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - began
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(call)}: expected status 0, got {process.returncode}: {told}")
    return Spent(wall, usage.ru_utime + usage.ru_stime)


def rows_of(command: str, home: str, best: Sequence[Spent], before: str | None) -> list[Record]:
    """Return the rows of a command; ``best`` has ours, and then that of ``before``, if any."""
    case = f"{spelled(command)} --home {home}, all compiled"
    aim = _AIMS.get((command, home))
    peers = [] if before is None else [(f"before ({Path(before).name})", best[1])]
    return [
        Record(
            "runs", case, "from Enter to the end", best[0].wall, "s", Better.LOWER, aim,
            tuple(PeerFigure(name, "", other.wall) for name, other in peers),
        ),
        Record(
            "runs", case, "computing time, all cores", best[0].computing, "s", Better.LOWER, None,
            tuple(PeerFigure(name, "", other.computing) for name, other in peers),
        ),
    ]  # fmt: skip
