"""The tests that start robots and browsers: in two parts, and what failed beside others once more.

Promises of tenths of a second do not always hold on a machine that is busy with other tests. So a
few that failed run once more with nothing beside them. What fails then has failed; what passes is
named at the end, as a test or a promise that a busy machine breaks.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.pytests import NO_TESTS, pytest_command
from running.suites import ROOT, Asked, Kind

BY_FILE: Final = ("--dist", "loadfile", "--no-loadscope-reorder")
"""Each file keeps to one worker, as its tests share a graph; the order is that of
test/conftest.py."""
TIMED_AT_ONCE: Final = 2
"""Robots whose promises in wall time are tested; a third would break some."""
OTHERS_AT_ONCE: Final = 3
FEW: Final = 4
"""More failures than this are no matter of a busy machine."""


class Robots:
    """Both parts, and what failed in them."""

    def __init__(self, asked: Asked) -> None:
        self._asked = asked
        self._statuses: list[int] = []
        self._failed: list[str] = []

    def run_timed(self) -> None:
        """Run what keeps promises in wall time, with nothing beside it."""
        graphs = self._asked.folders(Kind.GRAPHS)
        if graphs:
            self._run_part(TIMED_AT_ONCE, "timed", graphs)

    def run_others(self) -> None:
        """Run all others, which may wait a little longer for what they wait for."""
        folders = (*self._asked.folders(Kind.GRAPHS), *self._asked.folders(Kind.PAGES))
        self._run_part(OTHERS_AT_ONCE, "not timed", folders)

    def _run_part(self, workers: int, marked: str, folders: Sequence[str]) -> None:
        names = ROOT / ".cache" / "failed"
        listed = ("-p", "running.failed", "--failed-to", str(names))
        chosen = ("-m", marked, *folders, *self._asked.arguments)
        command = pytest_command("-n", str(workers), *BY_FILE, *listed, *chosen)
        self._statuses.append(subprocess.run(command, cwd=ROOT).returncode)
        self._failed += _lines(names)

    def passed(self) -> bool:
        """Whether all passed; one part may have no test of what was asked for."""
        wrong = set(self._statuses) - {0, NO_TESTS}
        if wrong == {1} and 0 < len(self._failed) <= FEW:
            return self._pass_alone()
        return not wrong and 0 in self._statuses

    def _pass_alone(self) -> bool:
        print(f"{len(self._failed)} failed beside others: once more, alone", flush=True)
        passed = []
        for name in self._failed:
            ran = subprocess.run(pytest_command(name), cwd=ROOT)
            passed.append(ran.returncode == 0)
        for name, alone in zip(self._failed, passed, strict=True):
            print(f"{'PASSED ONLY ALONE' if alone else 'FAILED TWICE'}: {name}", flush=True)
        return all(passed)


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines() if path.exists() else []
