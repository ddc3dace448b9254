"""The machine that the figures were measured on."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from pathlib import Path

import numba
import numpy as np

from roomba.cores import usable_cores


@dataclass(frozen=True)
class Machine:
    """What figures depend on; ``load`` is the load average of the minute before the start."""

    processor: str
    cores: int
    memory: float
    load: float

    @classmethod
    def this(cls) -> Machine:
        """Describe this machine."""
        return cls(_processor(), usable_cores(), _memory(), os.getloadavg()[0])

    def __str__(self) -> str:
        """Say it in a line."""
        return (
            f"{self.cores} cores of {self.processor}, {self.memory:.0f} GB; Python "
            f"{platform.python_version()}, numba {numba.__version__}, numpy {np.__version__}; "
            f"load {self.load:.2f} at the start"
        )


def _processor() -> str:
    told = Path("/proc/cpuinfo")
    for line in told.read_text(encoding="utf-8").splitlines() if told.exists() else ():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()


def _memory() -> float:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9
