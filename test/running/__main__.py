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
from running.suites import FIRST, ROOT, Asked, Kind, asked_for, usage

from roomba.commands.process_end import quiet_end

CHECKS = (sys.executable, "-m", "running.checks")
SAFETY = (sys.executable, "-m", "safety")
COMPUTING_AT_ONCE = 4
"""Workers; some tests wait for programs that they start: two would leave a third of the cores."""


@dataclass(frozen=True)
class Computing:
    """Tests or checks that need no robot."""

    name: str
    command: Sequence[str]
    is_first: bool
    """It runs beside the timed robots, after the earlier ones with this mark."""
    failed: Path | None = None
    """The file in which it lists the tests that failed."""

    def begin(self, after: Background | None = None) -> Background:
        """Start it beside the robots, at once or after another one."""
        return Background(self.name, self.command, self.failed, after)


def main(words: list[str]) -> int:
    """Run the suites that are asked for; return 0 if all of them passed."""
    if words[:1] in (["-h"], ["--help"]):
        print(usage())
        return 0
    asked = asked_for(words)
    if asked.thorough:
        be_thorough()
    if not asked.suites:
        return subprocess.run(pytest_command(*asked.arguments)).returncode
    os.chdir(ROOT)
    robots = asked.has(Kind.GRAPHS) or asked.has(Kind.PAGES)
    return 0 if (_beside_robots(asked) if robots else _one_by_one(asked)) else 1


def _beside_robots(asked: Asked) -> bool:
    """Run robots and computing tests together: robots leave much of the cores free.

    Beside the timed robots only one such program runs at a time, which takes a core at most.
    """
    robots, computing = Robots(asked), _computing(asked, asked.of(FIRST))
    background: list[Background] = []
    for each in computing:
        if each.is_first:
            background.append(each.begin(after=background[-1] if background else None))
    robots.run_timed()
    background += [each.begin() for each in computing if not each.is_first]
    robots.run_others()
    passed = [part.passed() for part in background]
    return robots.passed() and all(passed)


def _one_by_one(asked: Asked) -> bool:
    ran = [subprocess.run(each.command) for each in _computing(asked)]
    return not any(each.returncode for each in ran)


def _computing(asked: Asked, first: Sequence[str] = ()) -> list[Computing]:
    """Return what needs no robot; the tests of the folders ``first`` begin earlier."""
    found = []
    if asked.has(Kind.CHECKS):
        found.append(Computing("lint", CHECKS, is_first=True))
    if asked.has(Kind.COVERAGE):
        found.append(Computing("safety", SAFETY, is_first=True))
    if first:
        found.append(_tests(asked, "first", first, is_first=True))
    if asked.has(Kind.COMPUTING):
        workers = ("-n", str(COMPUTING_AT_ONCE), "--dist", "worksteal")
        rest = (*workers, *(f"--ignore={path}" for path in first), *asked.folders(Kind.COMPUTING))
        found.append(_tests(asked, "computing", rest, is_first=False))
    return found


def _tests(asked: Asked, name: str, chosen: Sequence[str], *, is_first: bool) -> Computing:
    failed = ROOT / ".cache" / f"failed-{name}"
    command = pytest_command(*listing(failed), *chosen, *asked.arguments)
    return Computing(name, command, is_first, failed)


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main(sys.argv[1:]))
