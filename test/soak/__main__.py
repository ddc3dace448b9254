"""``./roomba soak [MINUTES]``: faults of all kinds in the middle of cleans, and what came of them.

It is no test of pytest: it takes as long as it is given. A table is printed at the end; the exit
status is 1 when a promise was broken. With ``--headless HOURS`` a robot without ROS lives instead.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

from soak import headless
from soak.arena import Arena
from soak.attacks import connections, enough_descriptors, floods, viewers
from soak.circumstances import clock, disk
from soak.goals import goals
from soak.growth import growth
from soak.mixed import mixed
from soak.processes import processes
from soak.rows import Row, table
from soak.standstill import standstill
from soak.starts import starts

from roomba.commands.process_end import quiet_end

PARTS: Final[dict[str, Callable[[Arena], list[Row]]]] = {
    "mixed": mixed,
    "processes": processes,
    "standstill": standstill,
    "clock": clock,
    "disk": disk,
    "goals": goals,
    "floods": floods,
    "connections": connections,
    "viewers": viewers,
    "starts": starts,
    "growth": growth,
}
"""What may go wrong, by name; mixed, processes and growth take the minutes that are given."""


def main(arguments: list[str] | None = None) -> int:
    """Run the parts one after the other, each with a robot of its own."""
    parser = argparse.ArgumentParser(prog="./roomba soak", description=__doc__)
    parser.add_argument("minutes", type=float, nargs="?", default=10.0, help="of each long part")
    parser.add_argument("--seed", type=int, default=0, help="of what goes wrong when")
    parser.add_argument("--only", nargs="+", choices=PARTS, help="parts; without it all")
    parser.add_argument("--starts", type=int, default=20, help="how often it is started")
    parser.add_argument("--headless", type=float, metavar="HOURS", help=headless.__doc__)
    given = parser.parse_args(arguments)
    if given.headless is not None:
        return headless.main(given.headless)
    enough_descriptors()
    rows: list[Row] = []
    for name in given.only or PARTS:
        began = time.monotonic()
        print(f"{name} …", file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory(prefix=f"roomba_soak_{name}_") as folder:
            arena = Arena(
                Path(folder), 60.0 * given.minutes, random.Random(given.seed), given.starts
            )
            rows += PARTS[name](arena)
        print(f"{name}: {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
    broken = sum(len(row.broken) for row in rows)
    print(f"{table(rows)}\n{broken} promises were broken (seed {given.seed})")
    return 1 if broken else 0


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
