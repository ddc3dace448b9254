"""The tests that start robots and browsers, in three parts."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from running.alone import FAILED, listed, listing, pass_alone
from running.pytests import NO_TESTS, pytest_command
from running.suites import ROOT, TIMED, WAITING, Asked, Kind

BY_FILE: Final = ("--dist", "loadfile", "--no-loadscope-reorder")
"""All tests of a file run in one worker, as they share a graph; in the order of
test/conftest.py."""
TIMED_AT_ONCE: Final = 2
"""Workers for tests of promises in wall time; with a third robot some promises would break."""
WAITING_AT_ONCE: Final = 2
"""Workers beside these for such tests that mostly wait: each takes a seventh of a core."""
OTHERS_AT_ONCE: Final = 3


@dataclass(frozen=True)
class _Part:
    """A run of pytest that has begun."""

    process: subprocess.Popen[bytes]
    failed: Path
    """The file that lists the tests that failed."""
    log: Path | None
    """The file of its output, unless the output is shown at once."""


class Robots:
    """All parts of the tests that start robots, and the tests that failed in them."""

    def __init__(self, asked: Asked) -> None:
        self._asked = asked
        self._statuses: list[int] = []
        self._failed: list[str] = []

    def run_timed(self) -> None:
        """Run tests of promises in wall time, beside checks and tests that mostly wait."""
        waiting = self._begin(
            "waiting", WAITING_AT_ONCE, self._asked.of(WAITING), log=ROOT / ".cache" / "waiting.log"
        )
        self._end(self._begin("timed", TIMED_AT_ONCE, self._asked.of(TIMED)))
        self._end(waiting)

    def run_others(self) -> None:
        """Run all other tests, which tolerate a busy machine."""
        folders = (*self._asked.folders(Kind.GRAPHS), *self._asked.folders(Kind.PAGES))
        ran = [f"--ignore={path}" for path in self._asked.of((*TIMED, *WAITING))]
        self._end(self._begin("others", OTHERS_AT_ONCE, folders, ran))

    def _begin(
        self,
        name: str,
        workers: int,
        paths: Sequence[str],
        ignored: Sequence[str] = (),
        log: Path | None = None,
    ) -> _Part | None:
        if not paths:
            return None
        names = ROOT / ".cache" / f"failed-{name}"
        names.parent.mkdir(exist_ok=True)
        which = (*ignored, *paths, *self._asked.arguments)
        command = pytest_command("-n", str(workers), *BY_FILE, *listing(names), *which)
        if log is None:
            return _Part(subprocess.Popen(command, cwd=ROOT), names, None)
        with log.open("wb") as file:
            process = subprocess.Popen(command, cwd=ROOT, stdout=file, stderr=subprocess.STDOUT)
        return _Part(process, names, log)

    def _end(self, part: _Part | None) -> None:
        if part is None:
            return
        self._statuses.append(part.process.wait())
        if part.log is not None:
            print(part.log.read_text(encoding="utf-8", errors="replace"), flush=True)
        self._failed += listed(part.failed)

    def passed(self) -> bool:
        """Whether all passed; single parts may have none of the tests that were asked for."""
        wrong = set(self._statuses) - {0, NO_TESTS}
        if wrong == {FAILED}:
            return pass_alone(self._failed)
        return not wrong and 0 in self._statuses
