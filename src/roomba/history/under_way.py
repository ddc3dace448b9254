"""A run under way: what is seen of it, row by row, and what it was once it has ended."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Final

from roomba.client.plain import home_of
from roomba.client.protocol import CleanReport
from roomba.client.view import GridLayer, HomeView, LayerName, RobotView
from roomba.geometry import wrap_angle
from roomba.history.run import (
    TRACE_STEP,
    CellLayer,
    RunFigures,
    RunRecording,
    RunSource,
    Word,
    kind_of,
    turning_of,
    untold,
)
from roomba.history.unfinished import Row, RunSoFar
from roomba.vocabulary import AT_REST, Phase

_SWEEPS: Final = (Phase.UNDOCKING, Phase.CLEANING, Phase.RETURNING, Phase.DOCKING)
"""Phases of a clean in which what is driven over counts."""
_STANDING_STEP: Final = 10.0
"""s between two rows while the robot stands."""
_SAME_PLACE: Final = 0.01
"""m and rad; a robot that is no farther away stands."""

Layers = Callable[[LayerName], GridLayer | None]


class RunUnderWay:
    """A run under way; ``rests_since`` is when the robot came to rest, s of its clock."""

    def __init__(self, view: RobotView, source: RunSource) -> None:
        """Begin at a look."""
        self._source = source
        self._began, self._wall = view.time, time.time()
        self._rows: list[Row] = []
        self._standing: Row | None = None
        """The newest row of a standstill, which is not among the kept rows yet."""
        self._words: list[Word] = []
        self._theta = view.pose[2]
        self._turning = 0.0
        self._before: RunSoFar | None = None
        self.rests_since: float | None = None

    def take(self, view: RobotView) -> None:
        """Remember what is seen now."""
        now, vacuum = view.time - self._began, view.vacuum
        if vacuum.phase not in AT_REST:
            self.rests_since = None
        elif self.rests_since is None:
            self.rests_since = view.time
        self._turning += abs(wrap_angle(view.pose[2] - self._theta))
        self._theta = view.pose[2]
        word = Word(
            now,
            vacuum.state,
            vacuum.phase,
            vacuum.message,
            vacuum.room,
            view.doubt,
            vacuum.hindrance.value,
        )
        is_news = not self._words or not word.is_as(self._words[-1])
        if is_news:
            self._words.append(word)
        row = self._row(now, view)
        stands = not is_news and _is_at(row, self._rows[-1])
        step = _STANDING_STEP if stands else TRACE_STEP
        if is_news or now - self._rows[-1][0] > step - 1e-6:
            if not stands:
                self._end_standstill()
            self._rows.append(row)
        self._standing = row if stands else None

    def _row(self, now: float, view: RobotView) -> Row:
        vacuum = view.vacuum
        battery, dirt = untold(vacuum.battery), untold(view.dirt)
        progress = (vacuum.covered, vacuum.wanted, vacuum.seconds_to_go)
        sweeps = float(vacuum.wanted > 0.0 and vacuum.phase in _SWEEPS)
        return (now, *view.pose, view.speed, battery, dirt, *progress, sweeps)

    def _end_standstill(self) -> None:
        """Keep the last row of a standstill: the robot was still there, and goes on from then."""
        row, self._standing = self._standing, None
        if row is not None and row[0] - self._rows[-1][0] > TRACE_STEP - 1e-6:
            self._rows.append(row)

    def so_far(self) -> RunSoFar:
        """Return what was seen, up to a moment ago."""
        return RunSoFar(self._source, self._began, self._wall, self._rows, self._words)

    def resume(self, run: RunSoFar) -> None:
        """Go on with what was seen before."""
        self._began, self._wall = run.clock, run.wall
        self._rows, self._words = list(run.rows), list(run.words)
        self._turning = turning_of(run.trace)
        self._before = run

    def interrupted(self) -> tuple[RunFigures, RunRecording] | None:
        """Return the run as interrupted; None if it began in this program: then it was no run."""
        before = self._before
        if before is None:
            return None
        self._end_standstill()
        return replace(before, rows=self._rows, words=self._words).closed()

    def figures(self, report: CleanReport) -> RunFigures:
        """Return what was achieved."""
        return RunFigures(
            self._source,
            kind_of(self._words),
            self._wall,
            report.outcome.value,
            report.message,
            report.duration,
            report.covered,
            report.wanted,
            report.distance,
            self._turning,
            report.dirt,
            report.energy,
            report.missed,
            report.times,
            report.open_edges,
            report.mapped,
        )

    def recording(self, home: HomeView, layer: Layers) -> RunRecording:
        """Return what was seen."""
        self._end_standstill()
        return RunRecording(self.so_far().trace, tuple(self._words), home_of(home), cells_of(layer))


def _is_at(row: Row, other: Row) -> bool:
    """Whether the robot is where it was."""
    (x, y, theta), (other_x, other_y, other_theta) = row[1:4], other[1:4]
    turned = abs(wrap_angle(theta - other_theta))
    return max(math.hypot(x - other_x, y - other_y), turned) <= _SAME_PLACE


def cells_of(layer: Layers) -> dict[str, CellLayer]:
    """Return the layers that are kept of a run."""
    found = {}
    for name in (LayerName.MAP, LayerName.COVERAGE):
        grid = layer(name)
        if grid is not None:
            found[name.value] = CellLayer(
                grid.resolution, grid.origin_x, grid.origin_y, grid.cells.copy()
            )
    return found
