"""Commands that compute beside the robots, with only the time of cores that these leave."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.alone import FAILED, listed, pass_alone
from running.pytests import NO_TESTS
from running.suites import ROOT

IDLE: Final = ("chrt", "--idle", "0")


class Background:
    """A command whose output is kept in a file until it is asked for."""

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        failed: Path | None = None,
        after: Background | None = None,
    ) -> None:
        """Start the command, at once or when the one ``after`` which it comes has ended.

        ``failed`` is the file in which the command lists tests that failed.
        """
        self._command, self._failed, self._after = command, failed, after
        self._log: Path = ROOT / ".cache" / f"{name}.log"
        self._log.parent.mkdir(exist_ok=True)
        print(f"{name}: beside the robots; its output comes after theirs: {self._log}", flush=True)
        self._status: int | None = None
        self._running = threading.Thread(target=self._run)
        self._running.start()

    def _run(self) -> None:
        if self._after is not None:
            self._after.wait()
        with self._log.open("wb") as file:
            command = [*IDLE, *self._command]
            ran = subprocess.run(command, cwd=ROOT, stdout=file, stderr=subprocess.STDOUT)
        self._status = ran.returncode

    def wait(self) -> None:
        """Wait for its end."""
        self._running.join()

    def passed(self) -> bool:
        """Wait for its end, print its output, and return whether it passed.

        It also passed if it has none of the tests that were asked for. Call this when nothing else
        runs: failed tests may run once more.
        """
        self.wait()
        print(self._log.read_text(encoding="utf-8", errors="replace"), flush=True)
        if self._status == FAILED and self._failed is not None:
            return pass_alone(listed(self._failed))
        return self._status in (0, NO_TESTS)
