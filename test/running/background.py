"""What computes beside the robots: it takes only what they leave of the cores."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from running.suites import ROOT

IDLE: Final = ("chrt", "--idle", "0")


class Background:
    """A command whose output is kept in a file until it is asked for."""

    def __init__(self, name: str, command: Sequence[str]) -> None:
        self._log: Path = ROOT / ".cache" / f"{name}.log"
        self._log.parent.mkdir(exist_ok=True)
        print(f"{name}: beside the robots; its output comes after theirs: {self._log}", flush=True)
        with self._log.open("wb") as file:
            self._process = subprocess.Popen(
                [*IDLE, *command], cwd=ROOT, stdout=file, stderr=subprocess.STDOUT
            )

    def passed(self) -> bool:
        """Wait for its end, print what it said, and return whether it was well."""
        status = self._process.wait()
        print(self._log.read_text(encoding="utf-8", errors="replace"), flush=True)
        return status == 0
