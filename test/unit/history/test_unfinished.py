"""A run whose program was killed is on disk to the last second: it goes on, or is interrupted."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
import pytest
from fixtures.waiting import wait_until
from unit.history.seen import HOME, REPORT, SOURCE, layer, view

from roomba.client.view import GridLayer, LayerName
from roomba.files.journal import read_lines, write_lines
from roomba.history.database import History, HistoryError
from roomba.history.recorder import HistoryKeeper
from roomba.history.run import RunFigures, RunRecording
from roomba.history.unfinished import INTERRUPTED, WHY, interrupted_runs

ROOT: Final = Path(__file__).parents[3]
WRITER: Final = """
import sys, time
from pathlib import Path
from unit.history.seen import HOME, SOURCE, layer, view
from roomba.client.view import GridLayer, LayerName
from roomba.files.journal import read_lines, write_lines
from roomba.history.database import History, HistoryError
from roomba.history.recorder import HistoryKeeper

keeper = HistoryKeeper(History(Path(sys.argv[1])), SOURCE, print)
began = time.monotonic()
while True:
    now = 100.0 + time.monotonic() - began
    keeper.look(view(now, "cleaning"), HOME, layer)
    print(now, flush=True)
    time.sleep(0.05)
"""


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Kill a program in the middle of a run, and return its folder."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    folder = tmp_path_factory.mktemp("killed")
    told = folder / "told"
    with told.open("w") as output:
        program = subprocess.Popen(
            [sys.executable, "-c", WRITER, str(folder)], stdout=output, env=environment, cwd=ROOT
        )
    try:
        wait_until(lambda: looks(told)[-1:] > [101.5], 30.0, "a run of 1.5 s")
    finally:
        program.send_signal(signal.SIGKILL)
        program.wait(10.0)
    return folder


@pytest.fixture
def killed_at(tmp_path: Path, killed: Path) -> float:
    """Put the killed program's folder here; the time by its robot's clock of its last look, s."""
    shutil.copytree(killed, tmp_path, dirs_exist_ok=True)
    return looks(tmp_path / "told")[-1]


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Put another clock, s, in place of the one by which is written."""
    now = [0.0]
    monkeypatch.setattr("roomba.history.unfinished.time", SimpleNamespace(monotonic=lambda: now[0]))
    return now


def looks(told: Path) -> list[float]:
    """Return when a program looked, s; a line that is not whole yet does not count."""
    return [float(line) for line in told.read_text().splitlines(keepends=True) if line[-1] == "\n"]


def kept(folder: Path) -> tuple[RunFigures, RunRecording]:
    history = History(folder)
    (run,) = history.runs()
    return run.figures, history.recording(run.number)


def test_a_run_that_was_killed_is_kept_as_interrupted(tmp_path: Path, killed_at: float) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    keeper.look(view(2.0, "docked"), HOME, layer)
    figures, recording = kept(tmp_path)
    assert figures.outcome == INTERRUPTED
    assert figures.message
    assert figures.kind == "clean"
    # Half a second between two writes, and one between two rows.
    assert killed_at - 100.0 - recording.duration < 1.0 + 0.2
    assert figures.distance == pytest.approx(recording.duration / 10.0, abs=0.01)
    assert figures.turning == pytest.approx(recording.duration / 10.0, abs=0.01)
    assert recording.home["name"] == "box"
    assert np.all(recording.layers["coverage"].cells == 1)
    assert [word.phase for word in recording.words] == ["cleaning"]
    assert not list(tmp_path.glob("unfinished-*"))


def test_a_run_that_was_killed_is_the_last_one_until_another_ends(
    tmp_path: Path, killed_at: float
) -> None:
    for _ in range(2):  # it stays so when the program starts once more
        keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
        keeper.look(view(2.0, "docked"), HOME, layer)
        assert keeper.interrupted is not None
        assert keeper.interrupted["outcome"] == INTERRUPTED
        assert keeper.interrupted["message"] == WHY
    other = HistoryKeeper(History(tmp_path), replace(SOURCE, home="other"), pytest.fail)
    other.look(view(2.0, "docked"), HOME, layer)
    assert other.interrupted is None
    keeper.look(view(3.0, "cleaning"), HOME, layer)
    keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    assert keeper.interrupted is None
    again = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    again.look(view(2.0, "docked"), HOME, layer)
    assert again.interrupted is None


@pytest.mark.parametrize("phase", ["cleaning", "emergency stop"])
def test_a_robot_that_goes_on_goes_on_with_its_run(
    tmp_path: Path, killed_at: float, phase: str
) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    # Of a clean before.
    old = replace(REPORT)
    keeper.look(view(killed_at + 3.0, phase, old), HOME, layer)
    assert keeper.history.runs() == []
    keeper.look(view(killed_at + 4.0, "cleaning", old), HOME, layer)
    keeper.look(view(killed_at + 5.0, "docked", REPORT), HOME, layer)
    figures, recording = kept(tmp_path)
    assert figures.outcome == "completed"
    assert recording.duration == pytest.approx(killed_at + 5.0 - 100.0, abs=0.1)
    assert recording.column("time")[0] == 0.0
    assert not list(tmp_path.glob("unfinished-*"))


def test_a_run_that_seemed_to_go_on_and_did_not_is_kept_as_interrupted(
    tmp_path: Path, killed_at: float
) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    for second in range(3, 9):
        keeper.look(view(killed_at + second, "emergency stop"), HOME, layer)
    assert keeper.interrupted is None
    for second in range(9, 25):
        keeper.look(view(killed_at + second, "idle"), HOME, layer)
    figures, recording = kept(tmp_path)
    assert (figures.outcome, figures.message, figures.kind) == (INTERRUPTED, WHY, "clean")
    assert recording.home["name"] == "box"
    assert np.all(recording.layers["coverage"].cells == 1)
    assert keeper.interrupted is not None
    assert keeper.interrupted["outcome"] == INTERRUPTED
    assert not list(tmp_path.glob("unfinished-*"))


@pytest.mark.parametrize(
    ("home", "later", "phase"),
    [("other", 1.0, "cleaning"), ("box", -90.0, "cleaning"), ("box", 100.0, "cleaning")],
    ids=["another home", "a clock that began anew", "long after"],
)
def test_another_run_is_not_taken_for_it(
    tmp_path: Path, killed_at: float, home: str, later: float, phase: str
) -> None:
    keeper = HistoryKeeper(History(tmp_path), replace(SOURCE, home=home), pytest.fail)
    keeper.look(view(killed_at + later, phase), HOME, layer)
    assert kept(tmp_path)[0].outcome == INTERRUPTED


def test_the_run_of_a_program_that_lives_is_left_to_it(tmp_path: Path) -> None:
    living = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    living.look(view(0.0, "cleaning"), HOME, layer)
    other = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    other.look(view(0.0, "docked"), HOME, layer)
    assert other.history.runs() == []
    living.look(view(9.0, "docked", REPORT), HOME, layer)
    assert [run.figures.outcome for run in other.history.runs()] == ["completed"]
    assert not list(tmp_path.glob("unfinished-*"))


def test_what_turned_out_to_be_no_run_leaves_no_file(tmp_path: Path) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    keeper.look(view(0.0, "undocking"), HOME, layer)
    assert list(tmp_path.glob("unfinished-*"))
    for second in range(1, 20):
        keeper.look(view(float(second), "idle"), HOME, layer)
    assert not list(tmp_path.glob("unfinished-*"))


def test_killed_after_it_was_kept_it_is_not_kept_twice(tmp_path: Path, killed_at: float) -> None:
    assert killed_at > 101.0
    left = {path: path.read_bytes() for path in tmp_path.glob("unfinished-*")}
    for _ in range(2):
        for path, content in left.items():
            path.write_bytes(content)
        HistoryKeeper(History(tmp_path), SOURCE, pytest.fail).look(view(2.0, "docked"), HOME, layer)
        assert len(History(tmp_path).runs()) == 1


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9])
def test_a_damaged_file_costs_its_own_lines_alone(
    tmp_path: Path, killed_at: float, share: float
) -> None:
    assert killed_at > 101.0
    (path,) = tmp_path.glob("unfinished-*")
    content = bytearray(path.read_bytes())
    content[int(share * len(content))] ^= 0xFF
    path.write_bytes(content)
    with interrupted_runs(tmp_path, pytest.fail) as runs:
        assert [left for left, _ in runs] == ([] if share == 0.0 else [path])
    assert path.exists() == (share > 0.0)


def test_a_disk_that_refuses_is_told_once(tmp_path: Path) -> None:
    told: list[str] = []
    (tmp_path / "file").write_text("")
    keeper = HistoryKeeper(History(tmp_path / "file"), SOURCE, told.append)
    for second in range(3):
        keeper.look(view(float(second), "cleaning"), HOME, layer)
    assert len(told) == 1
    assert "not kept" in told[0]


def test_a_run_that_the_history_refuses_is_kept_by_the_next_program(tmp_path: Path) -> None:
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr(keeper.history, "add", refuse)
        keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    keeper.look(view(10.0, "docked", REPORT), HOME, layer)
    assert told == ["the run was not kept: it is full"]
    assert History(tmp_path).runs() == []
    keeper.look(view(11.0, "cleaning", REPORT), HOME, layer)
    keeper.look(view(19.0, "docked", replace(REPORT)), HOME, layer)
    # It is under way again, on another run.
    HistoryKeeper(History(tmp_path), SOURCE, pytest.fail).look(view(20.0, "cleaning"), HOME, layer)
    later, refused = [run.figures for run in History(tmp_path).runs()]
    assert (later.outcome, refused.outcome) == ("completed", "completed")
    assert (refused.covered, refused.missed) == (REPORT.covered, REPORT.missed)
    assert len(list(tmp_path.glob("unfinished-*"))) == 1


@pytest.mark.parametrize("is_full", [True, False])
def test_a_run_whose_end_the_disk_refuses_as_well_is_kept_as_interrupted(
    tmp_path: Path, is_full: bool
) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, lambda _: None)
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr(keeper.history, "add", refuse)
        if is_full:
            disk.setattr("roomba.history.unfinished.append_line", fill_the_disk)
        keeper.look(view(9.0, "docked", REPORT), HOME, layer)
    HistoryKeeper(History(tmp_path), SOURCE, pytest.fail).look(view(2.0, "docked"), HOME, layer)
    assert kept(tmp_path)[0].outcome == (INTERRUPTED if is_full else "completed")


def refuse(*_: object) -> None:
    raise HistoryError("it is full")


def test_a_run_whose_first_line_the_disk_refuses_is_kept_from_the_next_one_on(
    tmp_path: Path, clock: list[float]
) -> None:
    told: list[str] = []
    keeper = HistoryKeeper(History(tmp_path), SOURCE, told.append)
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr("roomba.history.unfinished.append_line", fill_the_disk)
        for second in range(3):
            clock[0] += 1.0
            keeper.look(view(float(second), "cleaning"), HOME, layer)
            assert not list(tmp_path.glob("unfinished-*"))
    assert told == ["the run under way is not kept until it ends: it is full"]
    for second in range(3, 9):
        clock[0] += 1.0
        keeper.look(view(float(second), "cleaning"), HOME, layer)
    (path,) = tmp_path.glob("unfinished-*")
    first, second_line, *_ = read_lines(path)
    assert first["source"]["home"] == "box"
    assert len(second_line["rows"]) == 4


def fill_the_disk(*_: object) -> None:
    raise OSError("it is full")


@pytest.mark.parametrize("what", ["a folder", "a link", "too much"])
def test_a_file_that_cannot_be_read_is_set_aside_and_the_others_are_kept(
    tmp_path: Path, killed_at: float, what: str
) -> None:
    assert killed_at > 101.0
    bad = tmp_path / "unfinished-0000000000000000.journal"
    if what == "a folder":
        bad.mkdir()
    elif what == "a link":
        bad.symlink_to(tmp_path / "told")
    else:
        with bad.open("w") as file:
            file.truncate(1_000_000_001)
    told: list[str] = []
    HistoryKeeper(History(tmp_path), SOURCE, told.append).look(view(2.0, "docked"), HOME, layer)
    assert [f"set aside as {bad.name}.damaged" in text for text in told] == [True]
    assert kept(tmp_path)[0].outcome == INTERRUPTED
    assert [path.name for path in tmp_path.glob("unfinished-*")] == [f"{bad.name}.damaged"]
    HistoryKeeper(History(tmp_path), SOURCE, pytest.fail).look(view(2.0, "docked"), HOME, layer)


@pytest.mark.parametrize(
    ("refuses", "number"),
    [
        ("os.open", errno.EMFILE),
        ("os.open", errno.EACCES),
        ("roomba.history.unfinished.read_lines", errno.EIO),
    ],
)
def test_a_run_that_the_disk_refuses_for_a_while_is_kept_by_a_later_start(
    tmp_path: Path, killed_at: float, refuses: str, number: int
) -> None:
    assert killed_at > 101.0
    (path,) = tmp_path.glob("unfinished-*")
    true: Callable[..., Any] = os.open if refuses == "os.open" else read_lines

    def refuse_it(file: Path, *others: Any, **named: Any) -> Any:
        if file == path:
            raise OSError(number, os.strerror(number), str(file))
        return true(file, *others, **named)

    told: list[str] = []
    with pytest.MonkeyPatch.context() as disk:
        disk.setattr(refuses, refuse_it)
        HistoryKeeper(History(tmp_path), SOURCE, told.append).look(view(2.0, "docked"), HOME, layer)
    assert [os.strerror(number) in text and "left as it is" in text for text in told] == [True]
    assert list(tmp_path.glob("unfinished-*")) == [path]
    HistoryKeeper(History(tmp_path), SOURCE, pytest.fail).look(view(2.0, "docked"), HOME, layer)
    assert kept(tmp_path)[0].outcome == INTERRUPTED


def test_a_run_that_is_refused_does_not_keep_the_others_out(
    tmp_path: Path, killed_at: float
) -> None:
    assert killed_at > 101.0
    (path,) = tmp_path.glob("unfinished-*")
    first, *seen = read_lines(path)
    first["source"]["seed"] = 2**64
    newer = tmp_path / "unfinished-ffffffffffffffff.journal"
    write_lines(newer, [first | {"wall": first["wall"] + 1.0}, *seen])
    told: list[str] = []
    HistoryKeeper(History(tmp_path), SOURCE, told.append).look(view(2.0, "docked"), HOME, layer)
    assert ["was not kept" in text for text in told] == [True]
    assert kept(tmp_path)[0].source == SOURCE
    assert list(tmp_path.glob("unfinished-*")) == [newer]


def test_a_robot_that_is_paused_does_not_fill_the_disk(tmp_path: Path, clock: list[float]) -> None:
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    paused = view(0.0, "paused")
    keeper.look(view(0.0, "cleaning"), HOME, layer)
    for half in range(1, 2401):
        clock[0] = half / 2.0
        keeper.look(replace(paused, time=clock[0]), HOME, layer)
    (path,) = tmp_path.glob("unfinished-*")
    _, *seen = read_lines(path)
    assert sum(len(line["rows"]) for line in seen) <= 2 + 1200 / 10
    assert sum(1 for line in seen if line.get("layers")) == 1
    clock[0] += 10.0
    keeper.look(replace(paused, time=clock[0]), HOME, swept_again)
    assert set(read_lines(path)[-1]["layers"]) == {"coverage"}


def test_on_a_slow_disk_what_was_seen_meanwhile_is_written_at_once(
    tmp_path: Path, clock: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[int] = []

    def write_slowly(_: Path, line: dict[str, Any]) -> None:
        written.append(len(line.get("rows", ())))
        clock[0] += 2.0

    monkeypatch.setattr("roomba.history.unfinished.append_line", write_slowly)
    keeper = HistoryKeeper(History(tmp_path), SOURCE, pytest.fail)
    for second in range(5):  # which waited for the first write
        keeper.look(view(float(second), "cleaning"), HOME, layer)
    clock[0] += 1.0
    keeper.look(view(5.0, "cleaning"), HOME, layer)
    assert written == [0, 1, 5]


def swept_again(name: LayerName) -> GridLayer | None:
    if name is not LayerName.COVERAGE:
        return layer(name)
    return GridLayer(1, 0.05, 0.0, 0.0, np.full((4, 5), 2, np.uint8))
