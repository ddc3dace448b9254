"""``./roomba test [quick|thorough] [SUITE ...] [ARGUMENT ...]``: runs tests; 0 if all passed."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence

from fixtures.thoroughness import be_thorough
from running.alone import listing
from running.background import Background
from running.pytests import pytest_command
from running.robots import Robots
from running.suites import ROOT, Asked, Kind, asked_for

CHECKS = (sys.executable, "-m", "running.checks")
LINT = "lint"
COMPUTING = "computing"
COMPUTING_AT_ONCE = 3
"""Some of what computes waits for programs that it starts: two would leave a third of the cores."""
FAILED_COMPUTING = ROOT / ".cache" / "failed-computing"
COVERAGE = "coverage"
COVER = (sys.executable, "-m", "safety")


def main(words: list[str]) -> int:
    """Run what is asked for; return 0 if all of it passed."""
    asked = asked_for(words)
    if asked.thorough:
        be_thorough()
    if not asked.suites:
        return subprocess.run(pytest_command(*asked.arguments)).returncode
    os.chdir(ROOT)
    robots = asked.has(Kind.GRAPHS) or asked.has(Kind.PAGES)
    return 0 if (_beside_robots(asked) if robots else _one_by_one(asked)) else 1


def _beside_robots(asked: Asked) -> bool:
    """Run all at once: robots leave much of the cores to what computes.

    Beside those that are timed there is one program at a time, which takes a core at most.
    """
    robots, commands = Robots(asked), _commands(asked)
    one_by_one = [commands[name] for name in (LINT, COVERAGE) if name in commands]
    background = [Background("checks", *one_by_one)] if one_by_one else []
    robots.run_timed()
    if COMPUTING in commands:
        background.append(Background(COMPUTING, commands[COMPUTING], failed=FAILED_COMPUTING))
    robots.run_others()
    passed = [part.passed() for part in background]
    return robots.passed() and all(passed)


def _one_by_one(asked: Asked) -> bool:
    ran = [subprocess.run(command) for command in _commands(asked).values()]
    return not any(each.returncode for each in ran)


def _commands(asked: Asked) -> dict[str, Sequence[str]]:
    """Return what is to run without a robot: names and commands."""
    folders = asked.folders(Kind.COMPUTING)
    workers = ("-n", str(COMPUTING_AT_ONCE), "--dist", "worksteal")
    computing = pytest_command(*workers, *listing(FAILED_COMPUTING), *folders, *asked.arguments)
    all_of_them = {
        LINT: (Kind.CHECKS, CHECKS),
        COMPUTING: (Kind.COMPUTING, computing),
        COVERAGE: (Kind.COVERAGE, COVER),
    }
    return {name: command for name, (kind, command) in all_of_them.items() if asked.has(kind)}


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
