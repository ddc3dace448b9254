"""Runs are noticed by looking at a robot."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from unit.history.seen import HOME, REPORT, SOURCE, layer, view

from roomba.client.household import TotalsView
from roomba.client.protocol import (
    CleanReport,
    ErrandOutcome,
    ExploreReport,
    RobotUnavailableError,
)
from roomba.client.view import GridLayer, LayerName, exploration_as_clean
from roomba.history.database import History
from roomba.history.recorder import HistoryKeeper, RunRecorder
from roomba.history.run import RunFigures, RunRecording
from roomba.history.unfinished import INTERRUPTED, UnfinishedFile
from roomba.vocabulary import EdgeReason, OpenEdge


def run_of(recorder: RunRecorder, report: CleanReport) -> Iterator[tuple[RunFigures, RunRecording]]:
    """Look ten times a second at a robot that leaves its station at 5 s and is back at 45 s."""
    for tenth in range(600):
        time = tenth / 10.0
        phase = "cleaning" if 5.0 <= time < 45.0 else "docked"
        ended = recorder.look(view(time, phase, report if time >= 45.0 else None), HOME, layer)
        if ended:
            yield ended


def test_one_run_is_one_record() -> None:
    ((figures, recording),) = run_of(RunRecorder(SOURCE), REPORT)
    assert figures.source is SOURCE
    assert figures.kind == "clean"
    assert (figures.covered, figures.wanted, figures.distance) == (9.0, 10.0, 30.0)
    assert figures.missed == REPORT.missed
    assert figures.turning == pytest.approx(4.0, abs=0.02)
    assert recording.duration == pytest.approx(40.0, abs=0.11)
    assert len(recording.trace) == pytest.approx(81, abs=2)
    assert recording.column("x")[0] == pytest.approx(0.5)
    assert set(recording.column("battery")) == {-1.0}
    assert [word.phase for word in recording.words] == ["cleaning", "docked"]
    assert set(recording.layers) == {"map", "coverage"}


def test_an_exploration_is_kept_with_what_it_mapped_and_where_that_ends() -> None:
    edges = (OpenEdge(2.0, 1.0, 3.0, EdgeReason.NOT_LOOKED_AT),)
    explored = ExploreReport(ErrandOutcome.COMPLETED, "", 34.5, 30.0, 40.0, edges)
    ((figures, _),) = run_of(RunRecorder(SOURCE), exploration_as_clean(explored))
    assert (figures.mapped, figures.open_edges) == (34.5, edges)
    assert (figures.report.mapped, figures.report.open_edges) == (34.5, edges)


def test_dirt_that_the_robot_cannot_tell_hinders_nothing(tmp_path: Path) -> None:
    recorder, file = RunRecorder(SOURCE), UnfinishedFile(tmp_path)
    for time in (0.0, 1.0, 2.0):
        recorder.look(replace(view(time, "cleaning"), dirt=math.nan), HOME, layer)
    run = recorder.so_far
    assert run is not None
    file.keep(run, {}, dict)
    assert list(tmp_path.iterdir())
    figures, recording = run.closed()
    assert math.isnan(figures.dirt)
    assert np.isfinite(recording.trace).all()


def test_a_run_is_kept_with_what_it_was_asked_for_by_and_the_next_is_not() -> None:
    recorder = RunRecorder(SOURCE)
    recorder.wish = {"mode": "spot"}
    runs = [next(run_of(recorder, replace(REPORT, duration=float(each)))) for each in range(2)]
    assert [figures.source.configuration for figures, _ in runs] == [
        {"request": {"mode": "spot"}},
        {},
    ]


def test_what_ended_before_the_first_look_and_what_was_refused_is_no_run() -> None:
    recorder = RunRecorder(SOURCE)
    assert recorder.look(view(0.0, "docked", REPORT), HOME, layer) is None
    assert recorder.look(view(1.0, "cleaning", REPORT), HOME, layer) is None
    refused = replace(REPORT, outcome=ErrandOutcome.REFUSED)
    assert list(run_of(RunRecorder(SOURCE), refused)) == []


def test_leaving_the_station_alone_is_no_run() -> None:
    recorder = RunRecorder(SOURCE)
    recorder.look(view(0.0, "undocking"), HOME, layer)
    for second in range(1, 20):
        recorder.look(view(float(second), "idle"), HOME, layer)
    recorder.look(view(20.0, "cleaning"), HOME, layer)
    ended = recorder.look(view(30.0, "docked", REPORT), HOME, layer)
    assert ended is not None
    assert ended[1].duration == pytest.approx(10.0)


def test_an_exploration_is_told_as_such() -> None:
    recorder = RunRecorder(SOURCE)
    recorder.look(view(0.0, "exploring"), HOME, layer)
    ended = recorder.look(view(9.0, "docked", REPORT), HOME, layer)
    assert ended is not None
    assert ended[0].kind == "explore"


def test_runs_are_kept_and_trouble_is_told(tmp_path: Path) -> None:
    told: list[str] = []
    history = History(tmp_path)
    keeper = HistoryKeeper(history, SOURCE, told.append)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    assert [run.is_recorded for run in history.runs()] == [True]
    assert told == []
    history.path.write_bytes(b"x" * 5000)
    keeper.look(view(10.0, "cleaning", REPORT), HOME, layer)
    keeper.look(view(19.0, "docked", replace(REPORT)), HOME, layer)
    assert len(told) == 1
    assert str(history.set_aside) in told[0]
    assert len(history.runs()) == 2
    blocked = HistoryKeeper(History(tmp_path / "runs.sqlite"), SOURCE, told.append)
    blocked.look(view(0.0, "cleaning"), HOME, layer)
    blocked.look(view(9.0, "docked", REPORT), HOME, layer)
    assert "not kept" in told[1]


def test_damage_that_is_found_when_sums_are_asked_for_is_told_as_well(tmp_path: Path) -> None:
    told: list[str] = []
    history = History(tmp_path)
    HistoryKeeper(history, SOURCE, told.append).totals()
    history.path.write_bytes(b"x" * 5000)
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    keeper.totals()
    for second in range(3):
        keeper.look(view(float(second), "docked"), HOME, layer)
    assert len(told) == 1
    assert "it is set aside as" in told[0]


def test_a_file_that_cannot_be_removed_is_told_and_the_next_run_has_its_own(tmp_path: Path) -> None:
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr(Path, "unlink", refuse)
        keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    assert len(told) == 1
    assert "cannot be removed: read-only" in told[0]
    (left,) = tmp_path.glob("unfinished-*")
    keeper.look(view(10.0, "cleaning", REPORT), HOME, layer)
    assert len(list(tmp_path.glob("unfinished-*"))) == 2
    keeper.look(view(19.0, "docked", replace(REPORT)), HOME, layer)
    assert list(tmp_path.glob("unfinished-*")) == [left]
    HistoryKeeper(History(tmp_path), SOURCE, told.append).look(view(0.0, "docked"), HOME, layer)
    assert len(keeper.history.runs()) == 2
    assert len(told) == 1


def refuse(*_: object, **__: object) -> None:
    raise OSError("read-only")


@pytest.mark.parametrize("wish", [{"seed": math.nan}, {"rooms": {"hall"}}], ids=["NaN", "a set"])
def test_a_run_that_cannot_be_kept_as_it_was_asked_for_is_told(
    tmp_path: Path, wish: dict[str, object]
) -> None:
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    keeper.note(wish)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    assert ["not kept" in text for text in told] == [True, True]
    assert keeper.history.runs() == []


def test_sums_that_a_run_comes_in_between_are_counted_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    history = History(tmp_path)
    keeper = HistoryKeeper(history, SOURCE, pytest.fail)
    keeper.look(view(1.0, "cleaning"), HOME, layer)
    count = history.totals

    def count_and_be_late(program: str) -> TotalsView:
        totals = count(program)
        monkeypatch.undo()
        keeper.look(view(9.0, "docked", REPORT), HOME, layer)
        return totals

    monkeypatch.setattr(history, "totals", count_and_be_late)
    assert keeper.totals().runs == 0
    assert keeper.totals().runs == 1
    assert keeper.totals() is keeper.totals()


def test_a_robot_that_goes_away_at_the_end_of_a_run_has_it_kept_by_the_next_look(
    tmp_path: Path,
) -> None:
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    keeper.look(view(9.0, "docked", REPORT), HOME, go_away)
    assert "expected the map, got no answer" in told.pop()
    keeper.look(view(9.5, "docked", REPORT), HOME, layer)
    assert told == []
    assert [run.is_recorded for run in keeper.history.runs()] == [True]


def test_an_interrupted_run_of_a_home_whose_name_is_no_utf_8_is_kept(tmp_path: Path) -> None:
    source = replace(SOURCE, home=os.fsdecode(b"K\xfcche"))
    HistoryKeeper(History(tmp_path), source, pytest.fail).look(view(0.0, "cleaning"), HOME, layer)
    (held,) = tmp_path.glob("unfinished-*")
    # As if the program were no more, which holds its own file.
    shutil.copy(held, tmp_path / "unfinished-left.journal")
    held.unlink()
    keeper = HistoryKeeper(History(tmp_path), source, pytest.fail)
    keeper.look(view(0.0, "docked"), HOME, layer)
    (kept,) = keeper.history.runs(home=source.home)
    assert (kept.figures.source.home, kept.figures.outcome) == ("K?che", INTERRUPTED)
    assert keeper.interrupted is not None
    assert not list(tmp_path.glob("unfinished-*"))


def go_away(_: LayerName) -> GridLayer | None:
    raise RobotUnavailableError("expected the map, got no answer")
