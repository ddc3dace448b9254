"""What fails beside others runs once more alone; what fails twice has failed."""

from __future__ import annotations

from pathlib import Path

import pytest
from running import robots
from running.alone import FEW
from running.robots import Robots
from running.suites import Asked

ONCE = """
from pathlib import Path
def test_it():
    path = Path({mark!r})
    had, _ = path.exists(), path.touch()
    assert had
"""
"""A test that passes from the second time on."""
FAILS = "def test_it(): assert False"


def suite(folder: Path, monkeypatch: pytest.MonkeyPatch, **files: str) -> Robots:
    """Return what runs these files as a suite of graphs in a repository of its own."""
    tests = folder / "test" / "ros"
    tests.mkdir(parents=True)
    (folder / ".cache").mkdir()
    (folder / "pyproject.toml").write_text("[tool.pytest.ini_options]", encoding="utf-8")
    for name, text in files.items():
        (tests / f"test_{name}.py").write_text(text, encoding="utf-8")
    for module in ("running.alone", "running.robots", "running.pytests", "running.suites"):
        monkeypatch.setattr(f"{module}.ROOT", folder)
    for kind in ("timed", "waiting"):
        name = f"ros/test_{kind}.py"
        (tests / f"test_{kind}.py").touch()
        monkeypatch.setattr(f"running.robots.{kind.upper()}", (name,))
    for workers in ("TIMED_AT_ONCE", "WAITING_AT_ONCE", "OTHERS_AT_ONCE"):
        monkeypatch.setattr(f"running.robots.{workers}", 0)  # what starts none is quicker
    monkeypatch.setenv("PYTHONPATH", str(Path(robots.__file__).parents[1]))
    # None of all other plugins that are installed.
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTEST_PLUGINS", "xdist.plugin")
    return Robots(Asked(("ros",)))


@pytest.mark.thorough
def test_all_that_passes_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = suite(tmp_path, monkeypatch, it="def test_it(): pass")
    ran.run_timed()
    ran.run_others()
    assert ran.passed()


@pytest.mark.thorough
def test_without_a_test_nothing_passed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = suite(tmp_path, monkeypatch, it="")
    ran.run_timed()
    ran.run_others()
    assert not ran.passed()


def test_what_passes_alone_passes_and_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    ran = suite(tmp_path, monkeypatch, timed=ONCE.format(mark=str(tmp_path / "mark")))
    ran.run_timed()
    ran.run_others()
    assert ran.passed()
    assert "PASSED ONLY ALONE: test/ros/test_timed.py::test_it" in capfd.readouterr().out


def test_what_fails_twice_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    passes = ONCE.format(mark=str(tmp_path / "mark"))
    ran = suite(tmp_path, monkeypatch, timed=passes, waiting=FAILS)
    ran.run_timed()
    ran.run_others()
    assert not ran.passed()
    assert "FAILED TWICE: test/ros/test_waiting.py::test_it" in capfd.readouterr().out


@pytest.mark.thorough
def test_many_failures_are_no_matter_of_a_busy_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    text = "\n".join(f"def test_{n}(): assert False" for n in range(FEW + 1))
    ran = suite(tmp_path, monkeypatch, it=text)
    ran.run_timed()
    ran.run_others()
    assert not ran.passed()
    assert "once more" not in capfd.readouterr().out


@pytest.mark.thorough
def test_a_file_that_cannot_be_read_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = suite(tmp_path, monkeypatch, it="def test_it(: pass")
    ran.run_timed()
    ran.run_others()
    assert not ran.passed()
