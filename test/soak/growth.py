"""Memory, threads and descriptors of every process, at rest after each of many cleans."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from fixtures.graph import RUN, RosGraph
from fixtures.homes.tiny_home import tiny_home
from scipy.stats import theilslopes
from soak.arena import Arena
from soak.cleaner import ENDED, Cleaner
from soak.rows import Row, in_child, tell

MOST_GROWTH: Final = 1.0
"""MB an hour, of a robot in real time."""
MOST_DESCRIPTORS: Final = 2
MOST_THREADS: Final = 0
_REST: Final = 5.0
"""s; within this a clean that ended is stored, and the memory that it took is given back."""
_LOOKS: Final = 10
"""In that time."""
_SETTLED: Final = 0.3
"""Share of all samples, the first ones, that does not count: caches still fill."""
_SURE: Final = 0.95
"""Confidence of the interval of the growth."""


class Sample(NamedTuple):
    """A process at a time, s: MB of its anonymous memory, numbers of threads and descriptors."""

    at: float
    memory: float
    threads: int
    descriptors: int


def growth(arena: Arena) -> list[Row]:
    """Clean for the time that is given, and compare what each process has after each clean."""
    with RosGraph(arena.folder) as graph:
        graph.launch(f"home:={tiny_home(arena.folder)}")

        def work() -> list[Row]:
            cleaner = Cleaner(graph)
            samples: dict[str, list[Sample]] = {name: [] for name in ("master", *RUN)}
            end = time.monotonic() + arena.seconds
            while time.monotonic() < end:
                cleaner.keep_cleaning()
                cleaner.finish()
                tell(f"clean {cleaner.row.times} ended, {end - time.monotonic():.0f} s left")
                for name, taken in at_rest(graph, list(samples)).items():
                    samples[name].append(taken)
            return [cleaner.row, *(judged(name, taken) for name, taken in samples.items())]

        return in_child(arena.folder, work, arena.seconds + 2.0 * ENDED)


def at_rest(graph: RosGraph, names: list[str]) -> dict[str, Sample]:
    """Sample processes for 5 s after a clean: the last sample of each, with its least memory.

    After a clean each process gives memory back at a moment of its own.
    """
    found: dict[str, Sample] = {}
    for _ in range(_LOOKS):
        time.sleep(_REST / _LOOKS)
        for name in names:
            now = sample(graph.process(name))
            least = found.get(name, now).memory
            found[name] = now._replace(memory=min(least, now.memory))
    return found


def sample(process: int) -> Sample:
    """Look at a process."""
    folder = Path(f"/proc/{process}")
    status = dict(
        line.split(":", 1) for line in (folder / "status").read_text("utf-8").splitlines()
    )
    # Not the private memory: that grows when pages shared with the parent process are written to.
    anonymous = int(status["RssAnon"].split()[0])
    return Sample(
        time.monotonic(),
        anonymous / 1024.0,
        int(status["Threads"]),
        len(os.listdir(folder / "fd")),
    )


def judged(name: str, taken: list[Sample]) -> Row:
    """Return the row of a process: how its memory grew once it had settled, and whether too much.

    The growth is the median of the slopes between all pairs of samples (Theil and Sen). So a single
    step, as when the process takes a piece of memory from the system, does not count unless it is
    about halfway.
    """
    row = Row(f"growth of {name}", len(taken))
    settled = taken[int(_SETTLED * len(taken)) :]
    if len(settled) < 4:
        row.broken.append(
            f"expected some cleans to compare, got {len(taken)}: give it more minutes"
        )
        return row
    hours = np.array([each.at - settled[0].at for each in settled]) / 3600.0
    memory = np.array([each.memory for each in settled])
    slope, _, least, most = theilslopes(memory, hours, _SURE)
    row.measured("MB", float(memory[-1]))
    row.measured("MB/h", float(slope))
    row.measured("at least", float(least))
    row.measured("at most", float(most))
    if slope > MOST_GROWTH:
        row.broken.append(f"it grows by {slope:.1f} MB/h, promised {MOST_GROWTH:g}")
    row.expect(
        "descriptors more",
        settled[-1].descriptors - settled[0].descriptors,
        MOST_DESCRIPTORS,
    )
    row.expect("threads more", settled[-1].threads - settled[0].threads, MOST_THREADS)
    return row
