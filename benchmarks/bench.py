"""What every topic is given: the pace, the peers' files, and a voice."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.contestants import Contestant
from benchmarks.rounds import QUICK, Outcome, Pace, compete


@dataclass(frozen=True)
class Bench:
    """One run of the benchmarks; ``folder`` is for files that peers read, and is empty at first.

    ``maps`` is a folder of map_server maps, and ``logs`` one of recorded drives, to measure on as
    well, if the user named one.
    """

    pace: Pace
    folder: Path
    maps: Path | None = None
    logs: Path | None = None

    @property
    def is_quick(self) -> bool:
        """Whether a rough figure will do."""
        return self.pace == QUICK

    def compete(self, contestants: Sequence[Contestant]) -> list[Outcome]:
        """Measure ours and peers in turns."""
        return compete(contestants, self.pace)

    def save(self, name: str, array: NDArray[np.generic]) -> str:
        """Write an array for peers; return the file's path."""
        path = self.folder / f"{len(list(self.folder.iterdir()))}-{name}.npy"
        np.save(path, array)
        return str(path)

    def say(self, what: str) -> None:
        """Tell how far it is."""
        print(f"bench: {what}", file=sys.stderr, flush=True)
