"""What a line of ``./roomba test`` asks for."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from running.__main__ import main
from running.suites import BY_DEFAULT, SUITES, Kind, asked_for


def test_without_a_word_all_suites_run_that_need_not_be_named() -> None:
    asked = asked_for([])
    assert asked.suites == BY_DEFAULT
    assert {"lint", "unit", "web", "system"} <= set(asked.suites)
    assert not {"realtime", "install"} & set(asked.suites)
    assert not asked.thorough


def test_what_follows_the_suites_goes_to_pytest() -> None:
    asked = asked_for(["unit", "ros", "-k", "dock"])
    assert asked.suites == ("unit", "ros")
    assert asked.arguments == ("-k", "dock")
    assert [Path(folder).name for folder in asked.folders(Kind.GRAPHS)] == ["ros"]
    assert asked.has(Kind.COMPUTING)
    assert not asked.has(Kind.PAGES)


def test_an_argument_alone_goes_to_all_suites() -> None:
    asked = asked_for(["-k", "dock"])
    assert asked.suites == BY_DEFAULT
    assert asked.arguments == ("-k", "dock")


@pytest.mark.parametrize("name", ["{}", "{}::test_it"])
def test_a_file_that_is_named_runs_alone_and_whole(name: str, tmp_path: Path) -> None:
    path = tmp_path / "test_it.py"
    path.touch()
    asked = asked_for([name.format(path), "-x"])
    assert asked.suites == ()
    assert asked.arguments == (name.format(path), "-x")
    assert asked.thorough


def test_thorough_is_all_of_the_suites() -> None:
    assert asked_for(["thorough"]).suites == BY_DEFAULT
    assert asked_for(["thorough"]).thorough
    assert asked_for(["thorough", "unit"]).suites == ("unit",)


def test_quick_leaves_out_what_is_slow() -> None:
    asked = asked_for(["quick", "-x"])
    assert asked.suites == ("lint", "unit")
    assert asked.arguments == ("-m", "not slow", "-x")


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help_names_all_suites_and_runs_none(
    word: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def run(*_: object, **__: object) -> None:
        pytest.fail("a suite began")

    monkeypatch.setattr(subprocess, "run", run)
    monkeypatch.setattr(subprocess, "Popen", run)
    assert main([word]) == 0
    told = capsys.readouterr().out
    assert told.startswith("usage: ./roomba test")
    assert all(f" {name}" in told for name in SUITES)
