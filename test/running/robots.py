"""The tests that start robots and browsers, in two parts."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from typing import Final

from running.alone import FAILED, listed, listing, pass_alone
from running.pytests import NO_TESTS, pytest_command
from running.suites import ROOT, Asked, Kind

BY_FILE: Final = ("--dist", "loadfile", "--no-loadscope-reorder")
"""Each file keeps to one worker, as its tests share a graph; the order is that of
test/conftest.py."""
TIMED_AT_ONCE: Final = 2
"""Robots whose promises in wall time are tested; a third would break some."""
OTHERS_AT_ONCE: Final = 3


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
        chosen = ("-m", marked, *folders, *self._asked.arguments)
        command = pytest_command("-n", str(workers), *BY_FILE, *listing(names), *chosen)
        self._statuses.append(subprocess.run(command, cwd=ROOT).returncode)
        self._failed += listed(names)

    def passed(self) -> bool:
        """Whether all passed; one part may have no test of what was asked for."""
        wrong = set(self._statuses) - {0, NO_TESTS}
        if wrong == {FAILED}:
            return pass_alone(self._failed)
        return not wrong and 0 in self._statuses
