"""What each topic gets: the pace, the peers' files, and a function that prints progress."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from roomba_bench.contestants import Contestant, Peer, Unavailable
from roomba_bench.peers.protocol import Parameters
from roomba_bench.places import HERE
from roomba_bench.rounds import QUICK, Outcome, Pace, compete


@dataclass(frozen=True)
class Bench:
    """One run of the benchmarks; ``folder`` is for files that peers read, and is empty at first.

    ``maps`` is a folder of map_server maps, and ``logs`` one of recorded drives, to measure on as
    well, if the user named them. Topics write pictures into ``pictures``. ``peers`` is the Python
    under which peers run, None if none is known.
    """

    pace: Pace
    folder: Path
    maps: Path | None = None
    logs: Path | None = None
    pictures: Path = HERE.results
    peers: Path | None = HERE.peers

    @property
    def is_quick(self) -> bool:
        """Whether rough figures are enough."""
        return self.pace == QUICK

    def compete(self, contestants: Sequence[Contestant]) -> list[Outcome]:
        """Measure ours and peers in turns."""
        return compete(contestants, self.pace)

    def peer(
        self, name: str, module: str, parameters: Parameters, distribution: str | None = None
    ) -> Peer:
        """Return a peer: its name in the table, its script, its case, and its name for pip."""
        return Peer(self.peers, name, module, parameters, distribution)

    def unavailable(self, name: str) -> Unavailable:
        """Return a peer for which there is no script."""
        return Unavailable(self.peers, name)

    def save(self, name: str, array: NDArray[np.generic]) -> str:
        """Write an array for peers; return the file's path."""
        path = self.folder / f"{len(list(self.folder.iterdir()))}-{name}.npy"
        np.save(path, array)
        return str(path)

    def say(self, what: str) -> None:
        """Print how far the benchmark is."""
        print(f"bench: {what}", file=sys.stderr, flush=True)
