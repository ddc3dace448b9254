"""What computes beside the robots: it takes only what they leave of the cores."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.alone import FAILED, listed, pass_alone
from running.suites import ROOT

IDLE: Final = ("chrt", "--idle", "0")


class Background:
    """A command whose output is kept in a file until it is asked for."""

    def __init__(self, name: str, command: Sequence[str], failed: Path | None = None) -> None:
        """Start it; ``failed`` is the file in which it lists tests that failed."""
        self._failed = failed
        self._log: Path = ROOT / ".cache" / f"{name}.log"
        self._log.parent.mkdir(exist_ok=True)
        print(f"{name}: beside the robots; its output comes after theirs: {self._log}", flush=True)
        with self._log.open("wb") as file:
            self._process = subprocess.Popen(
                [*IDLE, *command], cwd=ROOT, stdout=file, stderr=subprocess.STDOUT
            )

    def passed(self) -> bool:
        """Wait for its end, print what it said, and return whether it was well.

        Call it when nothing runs beside: what failed may run once more.
        """
        status = self._process.wait()
        print(self._log.read_text(encoding="utf-8", errors="replace"), flush=True)
        if status == FAILED and self._failed is not None:
            return pass_alone(listed(self._failed))
        return status == 0
