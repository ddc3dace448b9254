"""``./roomba test [quick|thorough] [SUITE ...] [ARGUMENT ...]``: runs tests; 0 if all passed."""

from __future__ import annotations

import os
import subprocess
import sys

from fixtures.thoroughness import be_thorough
from running.alone import listing
from running.background import Background
from running.checks import run_checks
from running.pytests import pytest_command
from running.robots import Robots
from running.suites import ROOT, Asked, Kind, asked_for

CHECKS = (sys.executable, "-m", "running.checks")
FAILED_COMPUTING = ROOT / ".cache" / "failed-computing"
COVERAGE = (sys.executable, "-m", "safety")


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
    """Run all at once, but what is timed: robots leave much of the cores to what computes."""
    robots = Robots(asked)
    robots.run_timed()
    background = []
    if asked.has(Kind.CHECKS):
        background.append(Background("lint", CHECKS))
    if asked.has(Kind.COMPUTING):
        background.append(Background("computing", _computing(asked), FAILED_COMPUTING))
    if asked.has(Kind.COVERAGE):
        background.append(Background("coverage", COVERAGE))
    robots.run_others()
    passed = [part.passed() for part in background]
    return robots.passed() and all(passed)


def _one_by_one(asked: Asked) -> bool:
    passed = []
    if asked.has(Kind.CHECKS):
        passed.append(run_checks() == 0)
    if asked.has(Kind.COVERAGE):
        passed.append(subprocess.run(COVERAGE).returncode == 0)
    if asked.has(Kind.COMPUTING):
        passed.append(subprocess.run(_computing(asked)).returncode == 0)
    return all(passed)


def _computing(asked: Asked) -> list[str]:
    folders = asked.folders(Kind.COMPUTING)
    return pytest_command("-n", "2", *listing(FAILED_COMPUTING), *folders, *asked.arguments)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
