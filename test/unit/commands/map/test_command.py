"""The command as a whole, on a small home: what it prints, writes, and returns."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from roomba.commands.map import runs
from roomba.commands.map.blind_map import BlindMap
from roomba.commands.map.command import main
from roomba.commands.map.json_file import TIMES, run_as_json
from roomba.commands.map.plot import picture_of
from roomba.commands.map.report import error_lines, run_lines
from roomba.commands.map.runs import MapRun, MapScene, ObservedExplorer
from roomba.commands.trials.trial import Trial
from roomba.commands.trials.warm import closet
from roomba.configuration.robot import RobotConfig
from roomba.mission.cleaning.result import CleanOutcome
from roomba.world.layers.layer import load_home

CLOSET = Trial(home="closet", seed=3)


@pytest.fixture(autouse=True)
def _closet(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs are in a closet, which is explored in no time."""
    monkeypatch.setattr(runs, "home_of", lambda trial, body: closet())


@pytest.fixture(scope="module")
def run() -> MapRun:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runs, "home_of", lambda trial, body: closet())
        return MapScene(CLOSET).run()


def test_a_closet_is_mapped_and_compared(run: MapRun) -> None:
    assert run.is_completed
    assert run.made.error.walls > 0.97
    assert run.made.error.floor > 0.97
    assert run.made.error.doubled == 0
    assert run.made.largest < 0.03
    assert run.made.last <= run.made.largest + 0.02
    # What dead reckoning makes of the same scans is a map as well, and no better one.
    assert 0.5 < run.by_odometry.error.floor < 1.0
    assert run.by_odometry.largest > 0.0
    assert run.station.distance_to(0.30, 0.90) < 0.01


def test_the_same_trial_gives_the_same_run_and_another_seed_another_one(run: MapRun) -> None:
    def figures(each: MapRun) -> dict[str, object]:
        return {name: value for name, value in run_as_json(each).items() if name not in TIMES}

    assert figures(MapScene(CLOSET).run()) == figures(run)
    other = MapScene(CLOSET.with_seed(4)).run()
    assert figures(other)["trajectory"] != figures(run)["trajectory"]


def test_an_observer_sees_it_every_now_and_then() -> None:
    seen: list[float] = []

    def observe(robot: ObservedExplorer) -> None:
        seen.append(robot.seen.time)

    run = MapScene(CLOSET).run([observe])
    times = run.record.poses[:, 0]
    assert np.isin(seen, times).all()
    assert seen[-1] == times[-1]
    assert len(seen) > 0.2 * len(times)
    assert 0.0 < np.diff(seen).min() <= np.diff(seen).max() < 3.1


def test_by_odometry_each_scan_is_drawn_where_it_was_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    late: list[float] = []
    see, scene = BlindMap.see, MapScene(CLOSET)

    def noted(blind: BlindMap, stamp: float, *scan: Any) -> None:
        late.append(stamp - scene.robot.seen.scan_stamp)
        see(blind, stamp, *scan)

    monkeypatch.setattr(BlindMap, "see", noted)
    scene.run()
    assert len(late) > 10
    assert not np.any(late)


def test_json_says_what_the_run_was(run: MapRun) -> None:
    values = json.loads(json.dumps(run_as_json(run), allow_nan=False))
    assert values["outcome"] == "COMPLETED"
    assert values["error"]["walls_within_5_cm"] == pytest.approx(run.made.error.walls, abs=1e-6)
    for name, drawn in (("error", run.made), ("by_odometry", run.by_odometry)):
        assert values[name]["largest_pose_error_m"] == pytest.approx(drawn.largest, abs=1e-6)
    assert values["by_odometry"]["floor_iou"] == pytest.approx(
        run.by_odometry.error.floor, abs=1e-6
    )
    assert len(values["trajectory"]) == len(values["believed"])
    assert len(values["trajectory"]) == pytest.approx(10.0 * values["duration_s"], rel=0.05)
    off = np.array(values["trajectory"])[:, 1:3] - np.array(values["believed"])[:, 1:3]
    assert np.hypot(*off.T).max() <= values["error"]["largest_pose_error_m"] + 1e-3


def test_a_report_has_the_same_rows_for_both_maps(run: MapRun) -> None:
    ours, theirs = error_lines(run.made), error_lines(run.by_odometry)
    assert [name for name, _ in ours] == [name for name, _ in theirs]
    assert ours != theirs
    assert dict(run_lines(run))["outcome"] == "COMPLETED"
    message = replace(
        run.record.result, outcome=CleanOutcome.STOPPED, message="the operator said so"
    )
    stopped = replace(run, record=replace(run.record, result=message))
    assert dict(run_lines(stopped))["outcome"] == "STOPPED: the operator said so"
    assert not stopped.is_completed


def test_a_picture_shows_both_maps(run: MapRun) -> None:
    picture = picture_of(run)
    assert picture.shape[1] == 1200
    dark = (picture[130:-150] < 80).all(axis=2)
    # The walls of the one are to the left, those of the other to the right.
    assert dark[:, 60:590].sum() > 1000
    assert dark[:, 660:1180].sum() > 1000


def test_the_command_tells_and_writes_all(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, plot, values = tmp_path / "floor", tmp_path / "map.png", tmp_path / "map.json"
    words = ["--home", "closet", "--seed", "3", "--out", str(out), "--plot", str(plot)]
    assert main([*words, "--json", str(values)]) == 0
    told = capsys.readouterr().out
    assert "walls within 5 cm" in told
    assert "COMPLETED" in told
    assert cv2.imread(str(plot)) is not None
    assert json.loads(values.read_text(encoding="utf-8"))["home"] == "closet"
    # What is written is a home: it can be driven in.
    home = load_home(str(out), tmp_path, RobotConfig().body, None)
    assert home.station.distance_to(0.30, 0.90) < 0.01
    assert np.count_nonzero(home.map.values == 0) > 1000
    assert len(home.rooms) == 1


def test_figures_on_standard_output_are_alone_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--home", "closet", "--json"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["outcome"] == "COMPLETED"
    assert "walls within 5 cm" in told.err


def test_quiet_is_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--home", "closet", "--quiet"]) == 0
    told = capsys.readouterr()
    assert told.out == told.err == ""


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--nonsense", "unrecognized arguments"),
        ("--bag a.bag", "--bag: expected a home to explore"),
        ("--bag=a.bag", "--bag: expected a home to explore"),
    ],
)
def test_wrong_usage_is_told_in_a_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words.split()) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("./roomba map: ")
    assert told.err.count("\n") == 1
    assert said in told.err


def test_a_home_that_is_not_there_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.undo()
    assert main(["--home", "nowhere"]) == 2
    assert "got 'nowhere'" in capsys.readouterr().err


def test_what_ends_otherwise_has_a_status_of_its_own(
    monkeypatch: pytest.MonkeyPatch, run: MapRun, capsys: pytest.CaptureFixture[str]
) -> None:
    result = replace(run.record.result, outcome=CleanOutcome.STOPPED)
    stopped = replace(run, record=replace(run.record, result=result))
    monkeypatch.setattr(runs.MapScene, "run", lambda self, observers: stopped)
    assert main(["--home", "closet"]) == 1
    assert "STOPPED" in capsys.readouterr().out
