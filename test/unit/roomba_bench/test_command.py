"""The command, with topics that measure nothing."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from roomba_bench import __main__ as command
from roomba_bench.bench import Bench
from roomba_bench.record import Better, Record, gain
from roomba_bench.rounds import QUICK, THOROUGH, Pace
from roomba_bench.topics import TOPICS

Run = Callable[..., tuple[int, list[tuple[str, Pace]]]]

ROW = Record("plan", "apartment", "path", 0.5, "ms", Better.LOWER, 0.1)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Return a function that runs the command with topics that measure nothing."""
    seen: list[tuple[str, Pace]] = []

    def measure(topic: str, bench: Bench) -> list[Record]:
        seen.append((topic, bench.pace))
        if topic == "ros":
            raise RuntimeError("no master")
        if topic == "lidar":
            return [ROW, gain(ROW, "mujoco", 30.0)]
        return [ROW]

    def write_plot(path: Path, rows: list[Record], caption: str) -> None:
        path.write_text(caption, encoding="utf-8")

    monkeypatch.setenv("ROS_PACKAGE_PATH", "/opt/ros")
    monkeypatch.setattr(command, "require_compiled", lambda *, is_quiet: None)
    monkeypatch.setattr(command, "measure", measure)
    monkeypatch.setattr(command, "write_plot", write_plot)

    def call(*arguments: str) -> tuple[int, list[tuple[str, Pace]]]:
        seen.clear()
        status = command.main([*arguments, "--plot", str(tmp_path / "out.png")])
        return status, list(seen)

    return call


def test_all_topics_are_measured_unless_some_are_named(run: Run) -> None:
    _, seen = run()
    assert [topic for topic, _ in seen] == list(TOPICS)
    assert run("plan", "plan", "--quick") == (0, [("plan", QUICK)])
    assert run("camera") == (0, [("camera", THOROUGH)])


@pytest.mark.parametrize("option", ["--maps", "--logs"])
def test_a_folder_that_is_not_there_is_refused_before_anything_is_measured(
    run: Run, option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        run("plan", option, "no/such/folder")
    assert f"{option}: expected a folder of" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--plot", "--json", "--markdown", "--out"])
def test_what_cannot_be_written_is_refused_before_anything_is_measured(
    run: Run, option: str, capsys: pytest.CaptureFixture[str]
) -> None:
    place = "/proc/new" if option == "--out" else "/proc/out.png"
    with pytest.raises(SystemExit):
        command.main(["plan", option, place])
    assert "/proc" in capsys.readouterr().err
    assert run("camera")[1] == [("camera", THOROUGH)]


def test_what_needs_ros_is_left_out_and_told_where_there_is_none(
    run: Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    status, seen = run()
    assert status == 0
    assert [topic for topic, _ in seen] == [topic for topic in TOPICS if topic != "ros"]
    assert "bench: ros is left out: there is no ROS environment\n" in capsys.readouterr().err
    assert run("ros")[1] == [("ros", THOROUGH)]


def test_a_peer_that_is_not_there_is_no_failure(run: Run, tmp_path: Path) -> None:
    assert run("lidar", "--json", str(tmp_path / "out.json"))[0] == 0
    [_, row] = json.loads((tmp_path / "out.json").read_text())
    assert (row["value"], row["error"]) == (None, "mujoco was not measured")


def test_a_python_of_the_peers_that_is_not_there_is_refused(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        run("plan", "--peers", str(tmp_path / "python3"))
    assert f"the Python of the peers; came {tmp_path / 'python3'}" in capsys.readouterr().err


def test_an_aim_that_is_not_reached_is_no_failure_but_a_topic_that_breaks_is(
    run: Run, tmp_path: Path
) -> None:
    assert run("plan")[0] == 0
    status, _ = run("ros", "plan", "--json", str(tmp_path / "out.json"))
    rows = json.loads((tmp_path / "out.json").read_text())
    assert status == 1
    assert rows[0]["error"] == "RuntimeError: no master"
    assert rows[1]["value"] == 0.5


def test_tables_say_on_what_machine_and_how(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run("plan", "--markdown", str(tmp_path / "out.md"))
    texts = [(tmp_path / name).read_text() for name in ("out.md", "out.png")]
    for text in (*texts, capsys.readouterr().out):
        assert "cores of" in text
        assert "best of 4 interleaved rounds of at least 0.5 s each" in text


def test_an_unknown_topic_is_refused_with_those_there_are(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        run("speed")
    assert f"{', '.join(TOPICS)}; came speed" in capsys.readouterr().err
