"""What computes beside the robots: it takes only what they leave of the cores."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.alone import FAILED, listed, pass_alone
from running.suites import ROOT

IDLE: Final = ("chrt", "--idle", "0")


class Background:
    """Commands, one after the other, whose output is kept in a file until it is asked for."""

    def __init__(self, name: str, *commands: Sequence[str], failed: Path | None = None) -> None:
        """Start the first; ``failed`` is the file in which they list tests that failed."""
        self._commands = commands
        self._failed = failed
        self._log: Path = ROOT / ".cache" / f"{name}.log"
        self._log.parent.mkdir(exist_ok=True)
        print(f"{name}: beside the robots; its output comes after theirs: {self._log}", flush=True)
        self._statuses: list[int] = []
        self._running = threading.Thread(target=self._run)
        self._running.start()

    def _run(self) -> None:
        with self._log.open("wb") as file:
            for command in self._commands:
                ran = subprocess.run(
                    [*IDLE, *command], cwd=ROOT, stdout=file, stderr=subprocess.STDOUT
                )
                self._statuses.append(ran.returncode)

    def passed(self) -> bool:
        """Wait for their end, print what they said, and return whether all was well.

        Call it when nothing runs beside: what failed may run once more.
        """
        self._running.join()
        print(self._log.read_text(encoding="utf-8", errors="replace"), flush=True)
        wrong = set(self._statuses) - {0}
        if wrong == {FAILED} and self._failed is not None:
            return pass_alone(listed(self._failed))
        return not wrong
