from __future__ import annotations

import json
import sys

import pytest

from roomba.commands.program import program


def call(monkeypatch: pytest.MonkeyPatch, *words: str) -> int:
    monkeypatch.setattr(sys, "argv", ["/opt/venv/bin/roomba", *words])
    return program()


@pytest.mark.parametrize("words", [(), ("help",), ("--help",)])
def test_usage_names_each_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: tuple[str, ...]
) -> None:
    assert call(monkeypatch, *words) == 0
    told = capsys.readouterr().out
    assert told.startswith("usage: roomba COMMAND")
    assert all(
        f"\n  {command}" in told for command in ("sim", "map", "localize", "pictures", "doctor")
    )


@pytest.mark.parametrize("word", ["version", "--version"])
def test_the_version_is_that_of_the_installed_library(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], word: str
) -> None:
    monkeypatch.setattr("importlib.metadata.version", {"roomba_robot": "1.2.3"}.__getitem__)
    assert call(monkeypatch, word) == 0
    assert capsys.readouterr().out == "roomba_robot 1.2.3\n"


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("run", "run: needs ROS, which only a checkout sets up: ./roomba run"),
        ("control", "control: needs ROS"),
        ("test", "test: needs the sources; in a checkout: ./roomba test"),
        ("sbom", "sbom: needs the sources; in a checkout: ./roomba sbom"),
        ("service", "service: needs ROS"),
        ("bogus", "expected a command of `roomba help`, got 'bogus'"),
    ],
)
def test_a_command_that_is_not_here_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], command: str, said: str
) -> None:
    assert call(monkeypatch, command) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert said in told.err
    assert len(told.err.splitlines()) == 1


def test_the_menu_needs_no_ros_for_a_demo(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(monkeypatch, "control", "--demo", "--home", "castle") == 2
    assert "castle" in capsys.readouterr().err
    assert call(monkeypatch, "control", "--home", "castle") == 2
    assert "needs ROS" in capsys.readouterr().err


def test_arguments_are_handed_to_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(monkeypatch, "map", "--bog") == 2
    assert "unrecognized arguments: --bog" in capsys.readouterr().err


@pytest.mark.parametrize("words", [("--bag", "no.bag"), ("--quiet", "--bag=no.bag")])
def test_a_recorded_drive_is_mapped_without_ros(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: tuple[str, ...]
) -> None:
    assert call(monkeypatch, "map", *words) == 1
    assert "no.bag: no such file; expected a bag or a log" in capsys.readouterr().err


def test_a_recorded_drive_is_localized_without_ros(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(monkeypatch, "localize", "--map", "no.yaml", "--bag", "no.bag") == 1
    assert "roomba localize: no.yaml: " in capsys.readouterr().err


def test_the_benchmarks_come_along(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(monkeypatch, "help") == 0
    assert "\n  bench [TOPIC ...]" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        call(monkeypatch, "bench", "speed")
    assert "roomba bench: error: expected topics out of sim, " in capsys.readouterr().err


def test_the_doctor_tells_of_each_module(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    status = call(monkeypatch, "doctor", "--json")
    rows = {row["subject"]: row["state"] for row in json.loads(capsys.readouterr().out)}
    assert {"numba", "cv2", "gymnasium"} <= rows.keys()
    assert rows["numba"] == "fine"
    assert status == ("missing" in rows.values())


@pytest.mark.parametrize("command", ["map", "play", "campaign", "run"])
def test_windows_is_told_what_works_there(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    monkeypatch.setattr("roomba.commands.program._IS_WINDOWS", True)
    assert call(monkeypatch, command) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith(f"roomba: {command}: expected Linux or macOS, got Windows")
    assert len(told.err.splitlines()) == 1
