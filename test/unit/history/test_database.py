"""The history in real SQLite files: several writers, damage, older and newer versions."""

from __future__ import annotations

import math
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from roomba.client.household import TotalsView
from roomba.client.protocol import MissedFloor
from roomba.files.journal import read_lines, write_lines
from roomba.files.lock import locked
from roomba.history.database import History, HistoryError
from roomba.history.run import RunFigures, RunRecording
from roomba.history.run_rows import MIGRATIONS, Choice
from roomba.history.totals import totals_by_week
from roomba.time_spent import TimeSpent

WRITER = """
import sys
from dataclasses import replace
from pathlib import Path
from roomba.history.database import History
from roomba.history.run import RunFigures, RunSource
history = History(Path(sys.argv[1]))
for number in range(25):
    source = RunSource(sys.argv[2], "box", number)
    history.add(RunFigures(source, "clean", 0.0, "completed", "", *[1.0] * 7))
"""


def test_a_run_comes_back_as_it_was(
    tmp_path: Path, figures: RunFigures, recording: RunRecording
) -> None:
    number = History(tmp_path).add(figures, recording)
    (kept,) = History(tmp_path).runs()
    assert kept.number == number
    assert kept.is_recorded
    assert math.isnan(kept.figures.energy)
    assert replace(kept.figures, energy=0.0) == replace(figures, energy=0.0)
    read = History(tmp_path).recording(number)
    assert np.array_equal(read.trace, recording.trace)
    assert read.words == recording.words
    assert read.home == recording.home
    assert np.array_equal(read.layers["map"].cells, recording.layers["map"].cells)


def test_the_newest_comes_first_and_homes_are_told_apart(
    tmp_path: Path, figures: RunFigures
) -> None:
    history = History(tmp_path)
    for day in (3, 1, 2):
        history.add(replace(figures, began=86400.0 * day))
    history.add(replace(figures, source=replace(figures.source, home="flat"), began=0.0))
    assert [run.figures.began for run in history.runs()] == [259200.0, 172800.0, 86400.0, 0.0]
    assert [run.figures.source.home for run in history.runs(home="flat")] == ["flat"]
    assert len(history.runs(limit=2)) == 2
    assert [run.number for run in history.chosen(Choice("box"), 2, before=1)] == [3, 2]


def test_weeks_are_summed_as_those_of_runs_are(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    days = [replace(figures, began=1.7e9 + 43_200.0 * half) for half in range(800)]
    history.add_all(days)
    weeks, expected = history.weeks(Choice()), totals_by_week(days)
    assert [(week.week, week.runs) for week in weeks] == [
        (week.week, week.runs) for week in expected
    ]
    assert weeks[1].covered == pytest.approx(expected[1].covered)
    assert weeks[1].energy == expected[1].energy == 0.0


def test_two_processes_that_write_at_the_same_time_lose_nothing(tmp_path: Path) -> None:
    writers = [
        subprocess.Popen([sys.executable, "-c", WRITER, str(tmp_path), name])
        for name in ("one", "other")
    ]
    assert [writer.wait(120.0) for writer in writers] == [0, 0]
    kept = [
        (run.figures.source.program, run.figures.source.seed) for run in History(tmp_path).runs()
    ]
    assert sorted(kept) == [(name, n) for name in ("one", "other") for n in range(25)]


def test_a_program_that_holds_it_without_end_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roomba.history.database._BUSY", 0.05)
    history = History(tmp_path)
    with (
        locked(tmp_path / "runs.lock", 1.0),
        pytest.raises(HistoryError, match=r"expected runs\.lock to be free within .* or end it"),
    ):
        history.runs()
    assert history.runs() == []


def test_only_the_owner_reads_it(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path / "new")
    history.add(figures)
    with sqlite3.connect(history.path) as reader:
        reader.execute("SELECT * FROM runs").fetchall()
        modes = {file.name: file.stat().st_mode & 0o777 for file in history.path.parent.iterdir()}
    assert len(modes) == 5
    assert set(modes.values()) == {0o600}
    assert history.path.parent.stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("damage", ["no database", "a page", "a table"])
def test_a_damaged_file_is_set_aside_and_told(
    tmp_path: Path, figures: RunFigures, damage: str
) -> None:
    history = History(tmp_path)
    for _ in range(200):
        history.add(figures)
    content = bytearray(history.path.read_bytes())
    if damage == "no database":
        content[:100] = b"x" * 100
    elif damage == "a page":
        content[4096 * 3 : 4096 * 5] = b"\xff" * 8192
    else:
        content = content[: len(content) // 2]
    history.path.write_bytes(content)
    again = History(tmp_path)
    assert again.add(figures) == 201
    # The figures of all come back; NaN is none of itself.
    assert [run.number for run in again.runs()] == list(range(201, 0, -1))
    assert {repr(run.figures) for run in again.runs()} == {repr(figures)}
    assert not any(run.is_recorded for run in again.runs())
    assert again.set_aside is not None
    assert again.set_aside.read_bytes() == bytes(content)


def test_an_older_version_is_brought_up_to_date(
    tmp_path: Path, figures: RunFigures, recording: RunRecording
) -> None:
    history = History(tmp_path)
    with sqlite3.connect(history.path) as old:
        old.executescript(MIGRATIONS[0])
        old.execute(
            "INSERT INTO runs (program, home, repeat, configuration, kind, began, outcome, message)"
            " VALUES ('ros', 'attic', '', '{}', 'clean', 5.0, 'completed', '')"
        )
        old.execute("PRAGMA user_version = 1")
    old.close()
    (kept,) = history.runs()
    assert kept.figures.source.home == "attic"
    assert not kept.is_recorded
    assert history.set_aside is None
    assert history.recording(history.add(figures, recording)).duration == 60.0


def test_runs_of_an_older_program_come_back_from_a_damaged_database(
    tmp_path: Path, figures: RunFigures
) -> None:
    history = History(tmp_path)
    history.add(figures)
    (journal,) = tmp_path.glob("*.journal")
    journal.unlink()
    assert len(history.runs()) == 1
    history.path.write_bytes(b"no database")
    assert len(history.runs()) == 1
    assert history.set_aside is not None


def test_an_exploration_is_kept_with_what_it_mapped(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    explored = replace(figures, kind="explore", mapped=34.5)
    history.add(explored)
    (kept,) = history.runs()
    assert repr(kept.figures) == repr(explored)


def test_rows_of_an_older_journal_come_back(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    history.add(figures)
    (journal,) = tmp_path.glob("*.journal")
    (row,) = read_lines(journal)
    added = ("times", "mapped", "open_edges")
    older = {name: value for name, value in row.items() if name not in added}
    write_lines(journal, [{**older, "missed": [miss[:5] for miss in older["missed"]]}])
    history.path.write_bytes(b"no database")
    (kept,) = history.runs()
    missed = tuple(replace(miss, code="") for miss in figures.missed)
    older_figures = replace(figures, missed=missed, times=TimeSpent(), open_edges=())
    assert repr(kept.figures) == repr(older_figures)


def test_a_damaged_journal_costs_nothing_while_the_database_is_whole(
    tmp_path: Path, figures: RunFigures
) -> None:
    history = History(tmp_path)
    history.add(figures)
    (journal,) = tmp_path.glob("*.journal")
    journal.write_bytes(b"\xff\x00 senseless")
    assert history.add(figures) == 2
    assert len(history.runs()) == 2
    history.path.write_bytes(b"no database")
    assert [run.number for run in history.runs()] == [2]


def test_a_newer_version_is_left_alone(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    history.add(figures)
    with sqlite3.connect(history.path) as newer:
        newer.execute("PRAGMA user_version = 99")
    newer.close()
    with pytest.raises(HistoryError, match="newer program"):
        history.add(figures)
    assert history.set_aside is None


def test_what_is_not_there_is_said(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    number = history.add(figures)
    with pytest.raises(HistoryError, match="got 42"):
        history.run(42)
    with pytest.raises(HistoryError, match="found none"):
        history.recording(number)


def test_a_folder_that_cannot_be_made_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(HistoryError, match="cannot be used"):
        History(tmp_path / "file" / "history").runs()


def test_totals_are_of_one_program(tmp_path: Path, figures: RunFigures) -> None:
    history = History(tmp_path)
    assert history.totals("play") == TotalsView()
    for program, energy in (("play", 2.0), ("play", math.nan), ("ros", 5.0)):
        source = replace(figures.source, program=program)
        history.add(replace(figures, source=source, energy=energy))
    totals = history.totals("play")
    assert totals.runs == 2
    assert totals.energy == 2.0
    assert totals.covered == pytest.approx(2 * figures.covered)
    assert (totals.duration, totals.distance) == (2 * figures.duration, 2 * figures.distance)


def of_seed(figures: RunFigures, seed: int) -> RunFigures:
    return replace(figures, source=replace(figures.source, seed=seed))


def asked_for(figures: RunFigures, by: object) -> RunFigures:
    return replace(figures, source=replace(figures.source, configuration={"request": by}))


@pytest.mark.parametrize(
    "unfit",
    [
        lambda figures: of_seed(figures, 2**64),
        lambda figures: asked_for(figures, math.nan),
        lambda figures: asked_for(figures, {"a set"}),
        lambda figures: replace(figures, began=math.nan),
        lambda figures: replace(figures, missed=(MissedFloor(math.inf, 0.0, 0.0, "", ""),)),
    ],
    ids=["a large seed", "NaN", "what is not plain", "no beginning", "an endless area"],
)
def test_figures_that_could_not_be_read_again_are_refused(
    tmp_path: Path, figures: RunFigures, unfit: Callable[[RunFigures], RunFigures]
) -> None:
    history = History(tmp_path)
    with pytest.raises(HistoryError):
        history.add(unfit(figures))
    assert history.runs() == []
    assert history.add(figures) == 1
    (journal,) = tmp_path.glob("*.journal")
    assert len(read_lines(journal)) == 1


def test_a_recording_that_could_not_be_read_again_is_refused(
    tmp_path: Path, figures: RunFigures, recording: RunRecording
) -> None:
    trace = recording.trace.copy()
    trace[3, 9] = math.nan
    home = {**recording.home, "radius": math.nan}
    for unfit in (replace(recording, trace=trace), replace(recording, home=home)):
        with pytest.raises(HistoryError, match="finite"):
            History(tmp_path).add(figures, unfit)
    assert History(tmp_path).runs() == []


@pytest.mark.parametrize("column", ["times", "configuration", "open_edges"])
def test_rows_that_make_no_sense_are_told(
    tmp_path: Path, figures: RunFigures, recording: RunRecording, column: str
) -> None:
    history = History(tmp_path)
    number = history.add(figures, recording)
    with sqlite3.connect(history.path) as other:
        other.execute(f"UPDATE runs SET {column} = '[[1]]'")
        other.execute("UPDATE recordings SET content = x'00'")
    other.close()
    with pytest.raises(HistoryError, match="cannot be used"):
        history.configured("sim", "request") if column == "configuration" else history.runs()
    with pytest.raises(HistoryError, match="expected a recorded run"):
        history.recording(number)


@pytest.mark.parametrize("is_damaged", [True, False], ids=["damaged", "missing"])
def test_a_restore_that_is_interrupted_begins_anew(
    tmp_path: Path, figures: RunFigures, is_damaged: bool
) -> None:
    history = History(tmp_path)
    for _ in range(3):
        history.add(figures)
    if is_damaged:
        history.path.write_bytes(b"no database")
    else:
        history.path.unlink()
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr("roomba.history.database.insert_row", fill_the_disk)
        for _ in range(2):
            with pytest.raises(HistoryError, match="is full"):
                history.runs()
    assert [run.number for run in History(tmp_path).runs()] == [3, 2, 1]
    assert History(tmp_path).add(figures) == 4
    assert (history.set_aside is not None) == is_damaged
    assert not list(tmp_path.glob("*.new*"))


def fill_the_disk(*_: object) -> None:
    raise sqlite3.OperationalError("the disk is full")


@pytest.mark.parametrize("left", [b"", None], ids=["empty", "missing"])
def test_the_figures_of_a_database_that_is_no_more_come_back(
    tmp_path: Path, figures: RunFigures, left: bytes | None
) -> None:
    history = History(tmp_path)
    for _ in range(3):
        history.add(figures)
    log = tmp_path / f"{history.path.name}-wal"
    with sqlite3.connect(history.path) as reader:
        reader.execute("UPDATE runs SET home = 'another'")
        reader.commit()
        log_of_another = log.read_bytes()
    reader.close()
    history.path.unlink()
    log.write_bytes(log_of_another)
    if left is not None:
        history.path.write_bytes(left)
    assert [run.number for run in History(tmp_path).runs()] == [3, 2, 1]
    assert {repr(run.figures) for run in History(tmp_path).runs()} == {repr(figures)}
    assert History(tmp_path).add(figures) == 4
    assert history.path.stat().st_mode & 0o777 == 0o600
