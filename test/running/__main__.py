"""``./roomba test [quick|thorough] [SUITE ...] [ARGUMENT ...]``: runs tests; 0 if all passed."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fixtures.thoroughness import be_thorough
from running.alone import listing
from running.background import Background
from running.pytests import pytest_command
from running.robots import Robots
from running.suites import ROOT, Asked, Kind, asked_for

CHECKS = (sys.executable, "-m", "running.checks")
SAFETY = (sys.executable, "-m", "safety")
COMPUTING_AT_ONCE = 3
"""Some of what computes waits for programs that it starts: two would leave a third of the cores."""


@dataclass(frozen=True)
class Computing:
    """What runs without a robot."""

    name: str
    command: Sequence[str]
    is_brief: bool
    failed: Path | None = None
    """Where it lists tests that failed."""

    def begin(self, after: Background | None = None) -> Background:
        """Let it run beside robots, at once or after another."""
        return Background(self.name, self.command, self.failed, after)


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
    robots, computing = Robots(asked), _computing(asked)
    background: list[Background] = []
    for each in computing:
        if each.is_brief:
            background.append(each.begin(after=background[-1] if background else None))
    robots.run_timed()
    background += [each.begin() for each in computing if not each.is_brief]
    robots.run_others()
    passed = [part.passed() for part in background]
    return robots.passed() and all(passed)


def _one_by_one(asked: Asked) -> bool:
    ran = [subprocess.run(each.command) for each in _computing(asked)]
    return not any(each.returncode for each in ran)


def _computing(asked: Asked) -> list[Computing]:
    """Return what is to run without a robot."""
    found = []
    if asked.has(Kind.CHECKS):
        found.append(Computing("lint", CHECKS, is_brief=True))
    if asked.has(Kind.COVERAGE):
        found.append(Computing("safety", SAFETY, is_brief=True))
    if asked.has(Kind.COMPUTING_BRIEFLY):
        found.append(_tests(asked, Kind.COMPUTING_BRIEFLY))
    if asked.has(Kind.COMPUTING):
        workers = ("-n", str(COMPUTING_AT_ONCE), "--dist", "worksteal")
        found.append(_tests(asked, Kind.COMPUTING, workers))
    return found


def _tests(asked: Asked, kind: Kind, workers: Sequence[str] = ()) -> Computing:
    name = kind.name.lower().replace("_", "-")
    failed = ROOT / ".cache" / f"failed-{name}"
    command = pytest_command(*workers, *listing(failed), *asked.folders(kind), *asked.arguments)
    return Computing(name, command, kind is Kind.COMPUTING_BRIEFLY, failed)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
