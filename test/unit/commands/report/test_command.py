"""The command on a history of its own, beside real runs of another command."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fixtures.homes.tiny_home import tiny_home
from rich.console import Console

from roomba.client.protocol import MissedFloor
from roomba.commands.report.command import main
from roomba.commands.report.table import runs_table
from roomba.commands.sim.command import main as sim
from roomba.history.database import History
from roomba.history.run import RunFigures, RunSource
from roomba.history.run_file import read_run
from roomba.vocabulary import EdgeReason, OpenEdge


def figures(home: str, covered: float) -> RunFigures:
    numbers = (100.0, covered, 20.0, 30.0, 4.0, 5.0, 6.0)
    return RunFigures(RunSource("play", home, 1), "clean", 1e9, "completed", "", *numbers)


@pytest.fixture
def history(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> History:
    folder = tmp_path / "history"
    monkeypatch.setenv("ROOMBA_HISTORY", str(folder))
    monkeypatch.chdir(tmp_path)
    return History(folder)


def test_a_real_run_is_reported(
    history: History, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = tmp_path / "run.json"
    assert sim(["--home", "studio", "--seed", "4", "--quiet", "--json", str(told)]) == 0
    run = json.loads(told.read_text())
    assert main(["last", "--out", "r.html", "--recording", "one.run"]) == 0
    output = capsys.readouterr().out
    area = f"{run['covered_m2']:.2f} m² of {run['coverable_m2']:.2f} m²"
    assert area in output
    document = (tmp_path / "r.html").read_text()
    assert area in document
    assert f"{run['distance_m']:.1f} m<" in document
    assert f"{run['turning_rad']:.1f} rad" in document
    assert f"{run['dirt_g']:.2f} g" in document
    for miss in run["missed"]:
        assert miss["reason"] in document
    assert read_run(tmp_path / "one.run")[0].source.seed == 4
    assert len(document) < 300_000


def test_runs_are_told_to_programs(
    history: History, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    missed = MissedFloor(0.25, 1.0, 2.0, "den", "a door is shut", "shut")
    edge = OpenEdge(1.5, 4.0, 1.0, EdgeReason.NO_ECHO)
    history.add(replace(figures("flat", 18.0), missed=(missed,)))
    explored = replace(figures("loft", math.nan), energy=math.inf, mapped=20.5)
    history.add(replace(explored, open_edges=(edge,)))
    assert main(["--json"]) == 0
    loft, flat = json.loads(capsys.readouterr().out)["runs"]
    told = [flat[name] for name in ("run", "home", "covered_m2", "missed_m2", "mapped_m2")]
    assert told == [1, "flat", 18.0, 0.25, None]
    assert flat["missed"] == [
        {
            "area_m2": 0.25,
            "x": 1.0,
            "y": 2.0,
            "room": "den",
            "reason": "a door is shut",
            "code": "shut",
        }
    ]
    told = [loft[name] for name in ("run", "covered_m2", "energy_wh", "mapped_m2", "open_m")]
    assert told == [2, None, None, 20.5, 1.5]
    assert loft["open_edges"] == [
        {"length": 1.5, "x": 4.0, "y": 1.0, "reason": EdgeReason.NO_ECHO.value}
    ]
    assert main(["1", "--json", str(tmp_path / "one.json")]) == 0
    assert json.loads((tmp_path / "one.json").read_text())["runs"] == [flat]
    assert capsys.readouterr().out == ""
    assert not list(tmp_path.glob("*.html"))
    assert main(["1", "--out", "one.html", "--json"]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["runs"] == [flat]
    assert "one.html" in printed.err


@pytest.mark.parametrize("run", ["last", "3"])
def test_a_run_behind_json_is_no_file(
    history: History, run: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert main(["--json", run]) == 2
    assert f"put the run first: ./roomba report {run} --json" in capsys.readouterr().err
    assert not (tmp_path / run).exists()


def test_a_folder_of_runs_that_is_not_there_is_refused_and_not_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mistyped = tmp_path / "hsitory"
    for name in (str(mistyped), "a" * 300):
        with pytest.raises(SystemExit, match="2"):
            main(["--history", name])
        assert f"expected a folder that is there, got '{name}'" in capsys.readouterr().err
    assert not mistyped.exists()


def test_a_run_is_repeated_by_what_was_kept_of_it(history: History, tmp_path: Path) -> None:
    home, wishes = str(tiny_home(tmp_path)), ["--battery", "0.8", "--things", "1"]
    assert sim(["--home", home, "--seed", "5", *wishes, "--quiet"]) == 0
    first = history.named("last")
    program, command, *again = shlex.split(first.figures.source.repeat)
    assert (program, command) == ("./roomba", "sim")
    assert sim(again) == 0
    second = history.named("last")
    assert second.number > first.number
    assert replace(second.figures, began=first.figures.began) == first.figures
    one, other = (history.recording(run.number) for run in (first, second))
    assert np.array_equal(one.trace, other.trace)
    assert np.array_equal(one.layers["coverage"].cells, other.layers["coverage"].cells)


def test_the_list_tells_runs_and_weeks(
    history: History, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([]) == 0
    assert "no runs yet" in capsys.readouterr().out
    for covered in (10.0, 19.0):
        history.add(figures("attic", covered))
    assert main([]) == 0
    output = capsys.readouterr().out
    assert "attic" in output
    assert "19.0 m² (95.0 %)" in output
    assert "2001-W36" in output
    assert "29.0 m²" in output


@pytest.mark.parametrize("width", [20, 40, 60, 80, 100, 120])
def test_a_narrow_terminal_shows_fewer_columns_and_cuts_none(width: int, history: History) -> None:
    history.add(figures("attic", 19.0))
    told = io.StringIO()
    table = runs_table(history.runs(), width)
    Console(file=told, width=width, force_terminal=False).print(table)
    head, row = told.getvalue().splitlines()
    assert head.split()[0] == "run"
    assert row.split()[0] == "1"
    assert "…" not in row
    assert max(len(head.rstrip()), len(row.rstrip())) <= width
    assert ("attic" in row) == (width >= 40)
    assert ("19.0 m² (95.0 %)" in row) == (width >= 60)
    assert ("program" in head) == (width >= 120)


def test_csv_has_every_run(history: History, capsys: pytest.CaptureFixture[str]) -> None:
    for covered in (10.0, float("nan")):
        history.add(figures("attic, north", covered))
    assert main(["--csv", "-"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [row["covered_m2"] for row in rows] == ["", "10.0000"]
    assert rows[0]["home"] == "attic, north"
    assert rows[0]["began"] == "2001-09-09T01:46:40Z"


@pytest.mark.parametrize(
    ("words", "begins"), [("--out -", "<!doctype html>"), ("--csv -", "run,began")]
)
def test_standard_output_has_what_is_asked_for_there_alone(
    history: History, words: str, begins: str, capsys: pytest.CaptureFixture[str]
) -> None:
    history.add(figures("attic", 10.0))
    assert main(["last", *words.split()]) == 0
    told = capsys.readouterr()
    assert told.out.lower().startswith(begins)
    assert "Report: " in told.err
    assert "Report: " not in told.out


def test_a_reader_that_has_had_enough_is_no_error(
    history: History, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Closed(io.StringIO):
        def write(self, _: str) -> int:
            raise BrokenPipeError

    monkeypatch.setattr("sys.stdout", Closed())
    with pytest.raises(BrokenPipeError):
        main(["--csv", "-"])


def test_csv_to_a_pipe_is_read_at_its_other_end(history: History, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    history.add(figures("attic", 10.0))
    assert main(["--csv", str(pipe)]) == 0
    assert b"attic" in os.read(reader, 10_000)
    os.close(reader)


def test_two_are_compared(history: History, tmp_path: Path) -> None:
    one, other = (history.add(figures("attic", covered)) for covered in (10.0, 19.0))
    assert main(["--compare", str(one), str(other)]) == 0
    assert "+9.00" in (tmp_path / f"compare-{one}-{other}.html").read_text()


@pytest.mark.parametrize("words", [["7"], ["last"], ["one"], ["--compare", "1", "2"]])
def test_what_there_is_not_is_said(
    history: History, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    assert "report: " in capsys.readouterr().err


def test_a_folder_in_place_of_a_file_is_refused_by_its_name(
    history: History, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    history.add(figures("attic", 1.0))
    assert main(["last", "--out", str(tmp_path)]) == 1
    assert f"{tmp_path}: expected a file, got a folder" in capsys.readouterr().err


def test_damage_is_told_where_it_is_found(
    history: History, capsys: pytest.CaptureFixture[str]
) -> None:
    history.add(figures("attic", 1.0))
    history.path.write_bytes(b"damaged" * 1000)
    assert main([]) == 0
    assert "set aside" in capsys.readouterr().err
