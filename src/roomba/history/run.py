"""A run as it is kept: its figures, and a recording of what was seen of it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32
from roomba.client.protocol import CleanReport, ErrandOutcome, MissedFloor
from roomba.shares import share_of
from roomba.time_spent import NOT_COUNTED, TimeSpent, square_metres_a_minute
from roomba.vocabulary import OpenEdge, Phase

TRACE: Final = (
    "time", "x", "y", "theta", "speed", "battery", "dirt", "covered", "wanted", "to_go", "sweeps",
)  # fmt: skip
"""Columns of a trace: s since the run began, m, rad, m/s, 0..1, g, m2, m2, s, and 1 while floor is
swept."""
UNTOLD: Final = -1.0
"""Stands in a trace for battery or dirt where the robot cannot tell it."""
TRACE_STEP: Final = 0.5
"""s of the robot's clock between two rows of a trace."""
REQUEST: Final = "request"
"""In a configuration: what was asked for, as the API of a page takes it, or as sim has it."""
CAMPAIGN: Final = "campaign"
"""The program of runs on a cluster, of which there may be thousands."""
CELL_LAYERS: Final = ("map", "coverage")


@dataclass(frozen=True, slots=True)
class RunSource:
    """What is run: ``program`` is sim, campaign, play or ros; ``seed`` is None where there is none.

    ``repeat`` is the command that repeats it, and ``configuration`` plain values that differ from
    what is usual.
    """

    program: str
    home: str
    seed: int | None = None
    repeat: str = ""
    configuration: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RunFigures:
    """What a run achieved: areas in m2, dirt in g, m, rad, s of the robot's clock, Wh.

    ``kind`` is clean or explore, ``began`` s since 1970 of the wall clock; what is not known is
    NaN. ``missed`` has the largest area first; ``times`` are all 0 where they were not counted.
    ``open_edges`` are where the map still ends, and ``mapped`` is the floor on it, of an
    exploration.
    """

    source: RunSource
    kind: str
    began: float
    outcome: str
    message: str
    duration: float
    covered: float
    wanted: float
    distance: float
    turning: float
    dirt: float
    energy: float
    missed: tuple[MissedFloor, ...] = ()
    times: TimeSpent = NOT_COUNTED
    open_edges: tuple[OpenEdge, ...] = ()
    mapped: float = math.nan

    @property
    def fraction(self) -> float:
        """Share of the wanted floor that is clean, 0..1; NaN where none was wanted."""
        return share_of(self.covered, self.wanted) if self.wanted > 0.0 else math.nan

    @property
    def rate(self) -> float | None:
        """m2 that became clean in a minute; None where that is not known."""
        return square_metres_a_minute(self.covered, self.duration)

    @property
    def report(self) -> CleanReport:
        """How it ended as a robot tells it; FAULT for an outcome of a newer program."""
        outcomes = {outcome.value: outcome for outcome in ErrandOutcome}
        return CleanReport(
            outcomes.get(self.outcome, ErrandOutcome.FAULT),
            self.message,
            self.covered,
            self.wanted,
            self.dirt,
            self.distance,
            self.duration,
            self.energy,
            self.missed,
            self.times,
            open_edges=self.open_edges,
            mapped=self.mapped,
        )


@dataclass(frozen=True, slots=True, eq=False)
class CellLayer:
    """Cells over the floor, uint8 [rows, columns], row 0 at the lowest y; lower left corner, m."""

    resolution: float
    origin_x: float
    origin_y: float
    cells: NDArray[np.uint8]

    def is_as(self, other: CellLayer | None) -> bool:
        """Whether another one has the same cells in the same place."""
        return (
            other is not None
            and (self.resolution, self.origin_x, self.origin_y)
            == (other.resolution, other.origin_x, other.origin_y)
            and np.array_equal(self.cells, other.cells)
        )


@dataclass(frozen=True, slots=True)
class Word:
    """What the robot said from a time on, s: state, phase, message, room and doubt.

    ``hindrance`` is the word of what kept it from what it was asked; an older run has none.
    """

    time: float
    state: str
    phase: str
    message: str = ""
    room: str = ""
    doubt: str = ""
    hindrance: str = ""

    def is_as(self, other: Word) -> bool:
        """Whether another one says the same, at whatever time."""
        return replace(other, time=self.time) == self


@dataclass(frozen=True, slots=True, eq=False)
class RunRecording:
    """What was seen of a run: ``trace`` is float32 [n, columns of TRACE], ``words`` by time.

    ``home`` are the plain values of the home as a page shows it; ``layers`` are those of
    CELL_LAYERS that there were, at the end.
    """

    trace: Floats32
    words: tuple[Word, ...]
    home: Mapping[str, Any]
    layers: Mapping[str, CellLayer]

    def column(self, name: str) -> Floats32:
        """Return a column of the trace, float32 [n]."""
        column: Floats32 = self.trace[:, TRACE.index(name)]
        return column

    @property
    def duration(self) -> float:
        """s of the robot's clock."""
        return float(self.trace[-1, 0]) if len(self.trace) else 0.0


def kind_of(words: Sequence[Word]) -> str:
    """Return what kind of run it was, by what the robot said meanwhile."""
    return "explore" if any(word.phase == Phase.EXPLORING for word in words) else "clean"


def turning_of(trace: Floats32) -> float:
    """Return how much the robot turned between the rows of a trace, rad."""
    turns = np.diff(trace[:, TRACE.index("theta")].astype(np.float64))
    return float(np.abs((turns + math.pi) % math.tau - math.pi).sum())


def untold(value: float) -> float:
    """Return what stands in a trace for a value that is NaN where the robot cannot tell it."""
    return value if math.isfinite(value) else UNTOLD


def told(value: float) -> float:
    """Return the value that stands in a trace, NaN where the robot could not tell it."""
    return value if value >= 0.0 else math.nan
