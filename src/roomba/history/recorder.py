"""The record of each run, made of looks at a robot as a page looks at it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from roomba.client.household import TotalsView
from roomba.client.plain import home_of, report_of
from roomba.client.protocol import CleanReport, ErrandOutcome
from roomba.client.told_once import ToldOnce
from roomba.client.view import HomeView, RobotView
from roomba.errors import RoombaError
from roomba.history.database import History
from roomba.history.run import REQUEST, RunFigures, RunRecording, RunSource
from roomba.history.under_way import Layers, RunUnderWay, cells_of
from roomba.history.unfinished import INTERRUPTED, RunSoFar, UnfinishedFile, interrupted_runs
from roomba.vocabulary import Phase

_LOOKED_THROUGH: Final = 100
"""Runs of a home among which the newest one of this program is looked for."""
BEGINS: Final = (Phase.UNDOCKING, Phase.CLEANING, Phase.EXPLORING)
"""Phases in which a run has begun."""
_UNDER_WAY: Final = (
    *BEGINS,
    Phase.RETURNING,
    Phase.DOCKING,
    Phase.CHARGING,
    Phase.PAUSED,
    Phase.EMERGENCY,
    Phase.BIN_FULL,
    Phase.EMPTYING,
)
"""Phases in which a run may go on."""
_GIVEN_UP: Final = 10.0
"""s of the robot's clock at rest without a report after which it was no run."""
_UNWRITABLE: Final = (OSError, ValueError, TypeError)
"""What the file of the run under way raises."""
_NOT_RUN: Final = (ErrandOutcome.REFUSED, ErrandOutcome.DISCONNECTED)


class RunRecorder:
    """Follows one robot from look to look; a run that ended is returned by the look that saw it."""

    def __init__(self, source: RunSource) -> None:
        """Begin between two runs."""
        self.source = source
        self._run: RunUnderWay | None = None
        self._last: CleanReport | None = None
        self.wish: Mapping[str, Any] | None = None
        """The request for the next run, as plain values, where it is known."""

    @property
    def so_far(self) -> RunSoFar | None:
        """The run that is under way, if there is one."""
        return None if self._run is None else self._run.so_far()

    def resume(self, run: RunSoFar, view: RobotView) -> None:
        """Go on with a run that was kept until a moment ago, at a look that sees it go on."""
        self._run = RunUnderWay(view, run.source)
        self._run.resume(run)
        self._last = view.last

    def look(
        self, view: RobotView, home: HomeView, layer: Layers
    ) -> tuple[RunFigures, RunRecording] | None:
        """Take a look; return the run that ended since the look before, if one did.

        Raises what ``layer`` does. A run that ended at such a look is returned by the next one.
        """
        if self._run is None and view.vacuum.phase in BEGINS:
            self._run = RunUnderWay(view, self._source_of_run())
        run, ended = self._run, None
        if run is not None:
            run.take(view)
            if view.last is not None and view.last is not self._last:
                is_run = view.last.outcome not in _NOT_RUN
                ended = (run.figures(view.last), run.recording(home, layer)) if is_run else None
                self._run = None
            elif run.rests_since is not None and view.time - run.rests_since > _GIVEN_UP:
                ended, self._run = run.interrupted(), None
        self._last = view.last
        return ended

    def _source_of_run(self) -> RunSource:
        """Return the source with the request for the run that begins."""
        wish, self.wish = self.wish, None
        return self.source if wish is None else replace(self.source, configuration={REQUEST: wish})


class HistoryKeeper:
    """Keeps the runs of a robot that is looked at; trouble with the history is told, once each.

    A run under way is on the disk up to the last second. If a program was killed in the middle of a
    run, the next program goes on with the run if its robot does, and else keeps it as interrupted.
    It does so, too, if the robot seemed to go on, held by the emergency stop, but then stands
    without telling how the run ended.
    """

    def __init__(self, history: History, source: RunSource, tell: Callable[[str], None]) -> None:
        """Begin between two runs."""
        self.history = history
        self._recorder = RunRecorder(source)
        self.tell = ToldOnce(tell)
        """Tells trouble with the history."""
        self._unfinished = UnfinishedFile(history.path.parent)
        self._has_looked = False
        self._set_aside: Path | None = None
        self._added = 0
        """Runs that the history was given."""
        self._totals: tuple[int, TotalsView] | None = None
        """These sums, and how many runs had been given to the history before them."""
        self.interrupted: dict[str, Any] | None = None
        """How the newest run ended, as plain values, if it was interrupted before this start."""

    def note(self, wish: Mapping[str, Any] | None) -> None:
        """Remember the request for the next run, plain values; None: it was refused."""
        self._recorder.wish = wish

    def look(self, view: RobotView, home: HomeView, layer: Layers) -> None:
        """Take a look, and keep a run that ended since the look before.

        A look that fails is told. A run that ended at it is kept by the next look.
        """
        try:
            self._look(view, home, layer)
        # It is not known here what a robot of another program raises when it is asked for a layer.
        except Exception as fault:
            self.tell(f"a look for the history failed: {type(fault).__name__}: {fault}")
        if self.history.set_aside is not self._set_aside:
            self._set_aside = self.history.set_aside
            self.tell(f"the history was damaged; it is set aside as {self._set_aside}")

    def _look(self, view: RobotView, home: HomeView, layer: Layers) -> None:
        if not self._has_looked:
            self._has_looked = True
            self._take_up(view)
        ended = self._recorder.look(view, home, layer)
        if ended is None:
            self._keep_so_far(home, layer)
            return
        self.interrupted = _as_interrupted(ended[0])
        self._keep(*ended)

    def _keep(self, figures: RunFigures, recording: RunRecording) -> None:
        """Keep a run that ended; one that the history refuses is left to the next program."""
        try:
            self._add(figures, recording)
        except RoombaError as error:
            self.tell(f"the run was not kept: {error}")
            # It is kept as interrupted if its file cannot take the end, either.
            with contextlib.suppress(*_UNWRITABLE):
                self._unfinished.leave(figures)
        else:
            self.tell("")
            self._remove_unfinished()

    def _add(self, figures: RunFigures, recording: RunRecording) -> None:
        try:
            self.history.add(figures, recording)
        finally:
            self._added += 1

    def _take_up(self, view: RobotView) -> None:
        """Take the runs that were interrupted: one that goes on is resumed, others are kept."""
        with interrupted_runs(self.history.path.parent, self.tell) as runs:
            for path, run in runs:
                try:
                    self._take(run, view)
                    path.unlink(missing_ok=True)
                except (RoombaError, OSError) as error:
                    self.tell(f"a run that was interrupted was not kept: {error}")
        # A history that cannot be read is told of when it is to keep a run.
        with contextlib.suppress(RoombaError):
            self.interrupted = self._newest_interrupted()

    def _take(self, run: RunSoFar, view: RobotView) -> None:
        is_under_way = self._recorder.so_far is None and view.vacuum.phase in _UNDER_WAY
        if is_under_way and run.may_go_on(self._recorder.source, view.time):
            self._recorder.resume(run, view)
        elif not self._has_kept(run):
            self._add(*run.closed())

    def _newest_interrupted(self) -> dict[str, Any] | None:
        source = self._recorder.source
        runs = (run.figures for run in self.history.runs(limit=_LOOKED_THROUGH, home=source.home))
        newest = next((run for run in runs if run.source.program == source.program), None)
        return None if newest is None else _as_interrupted(newest)

    def _has_kept(self, run: RunSoFar) -> bool:
        """Whether the run is in the history already: its file may not have been removed in time."""
        return any(
            each.figures.began == run.wall and each.figures.source.program == run.source.program
            for each in self.history.runs(home=run.source.home)
        )

    def _keep_so_far(self, home: HomeView, layer: Layers) -> None:
        run = self._recorder.so_far
        if run is None:
            self._remove_unfinished()
            return
        try:
            self._unfinished.keep(run, home_of(home), lambda: cells_of(layer))
        except _UNWRITABLE as error:
            self.tell(f"the run under way is not kept until it ends: {error}")

    def _remove_unfinished(self) -> None:
        try:
            self._unfinished.remove()
        except OSError as error:
            self.tell(f"the file of a run that is over cannot be removed: {error}")

    def totals(self) -> TotalsView:
        """Return the sums over all runs that were kept of this program; raises HistoryError.

        May be called from any thread.
        """
        added, known = self._added, self._totals
        if known is None or known[0] != added:
            # A run that is kept meanwhile may be missing: the next call counts anew.
            known = self._totals = added, self.history.totals(self._recorder.source.program)
        return known[1]


def _as_interrupted(run: RunFigures) -> dict[str, Any] | None:
    """Return how a run ended, as plain values, if it was interrupted."""
    return report_of(run.report) if run.outcome == INTERRUPTED else None
