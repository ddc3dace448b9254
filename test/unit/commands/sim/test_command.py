"""Exit status, messages and Ctrl-C of the command, with made-up runs."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.campaigns.campaign_work import FINE as WHOLE
from fixtures.waiting import promised, wait_until

from roomba.commands.sim import command
from roomba.commands.trials import many
from roomba.commands.trials.figures import MissedShare
from roomba.commands.trials.many import Outcome
from roomba.commands.trials.trial import Trial
from roomba.files.shipped import CONFIGURATION

REPOSITORY = Path(__file__).parents[4]
FINE = replace(WHOLE, missed=(MissedShare(0.1, 1.0, 2.0, "", "a door is shut"),))


@pytest.fixture
def outcomes(monkeypatch: pytest.MonkeyPatch) -> dict[int, Outcome]:
    """What becomes of each seed; the others are fine."""
    given: dict[int, Outcome] = {}

    def run(trials: Sequence[Trial], work: object) -> Iterator[tuple[Trial, Outcome]]:
        for trial in trials:
            yield trial, given.get(trial.seed, FINE)

    monkeypatch.setattr(many, "run_many", run)
    return given


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--home nowhere", "expected the name of a home there"),
        ("--home flat --room cellar", "got 'cellar'"),
        ("--home empty --spot 90 90", "expected floor that can be reached"),
        (
            "--home studio --station 0 0 0",
            "expected a way from the charging station onto the floor",
        ),
        ("--home flat --bag a.bag", "--bag: expected a Python with ROS"),
        ("--seed x", "expected a whole number"),
        ("--plan order=nowhere:f", "expected a module that can be imported, got 'nowhere'"),
        ("--plan paint=math:sin", "stages: expected edges, swaths, order"),
    ],
)
def test_wrong_usage_is_status_2_and_one_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main(words.split()) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    (line,) = printed.err.splitlines()
    assert line.startswith("./roomba sim: ")
    assert said in line


def test_many_homes_are_told_as_percentiles(
    outcomes: dict[int, Outcome], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "homes.json"
    assert command.main(["--homes", "4", "--seed", "10", "--json", str(file)]) == 0
    table = capsys.readouterr().out
    assert "4 of 4 completed and docked" in table
    assert "98.00" in table
    values = json.loads(file.read_text())
    assert [each["seed"] for each in values["runs"]] == [10, 11, 12, 13]
    assert values["percentiles"]["fraction"]["p50"] == pytest.approx(0.98)
    assert (values["homes"], values["completed"], values["failures"]) == (4, 4, [])


def test_a_home_that_fails_is_status_1_and_told_by_its_seed(
    outcomes: dict[int, Outcome], capsys: pytest.CaptureFixture[str]
) -> None:
    outcomes[1] = replace(FINE, outcome="LOST", docked=False, message="where is it")
    outcomes[2] = "no floor"
    assert command.main(["--homes", "3", "--sensors", "ideal", "--things", "2", "--json"]) == 1
    printed = capsys.readouterr()
    values = json.loads(printed.out)
    assert values["failures"] == [{"seed": 2, "reason": "no floor"}]
    assert "again: ./roomba sim --home random --sensors ideal --things 2 --seed 1" in printed.err
    assert "1 of 3 completed and docked" in printed.err


def test_the_command_that_repeats_a_home_is_one_for_a_shell(
    outcomes: dict[int, Outcome],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("my robot.yaml").write_bytes((CONFIGURATION / "robot.yaml").read_bytes())
    outcomes[1] = "no floor"
    assert command.main(["--homes", "2", "--config", "my robot.yaml"]) == 1
    told = capsys.readouterr().out
    assert "again: ./roomba sim --home random --config 'my robot.yaml' --seed 1" in told


def test_help_names_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        command.main(["--help"])
    assert ended.value.code == 0
    text = capsys.readouterr().out
    for option in ("--home", "--map", "--station", "--homes", "--room", "--no-go", "--battery"):
        assert option in text


def is_alive(process: str) -> bool:
    """Whether a process runs; one that only waits for its parent to notice its end does not."""
    try:
        status = Path(f"/proc/{process}/status").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return False
    return "State:\tZ" not in status


def imports(process: str) -> bool:
    """Whether a process has begun to import what it needs."""
    try:
        return "numpy" in Path(f"/proc/{process}/maps").read_text(encoding="utf-8")
    except OSError:
        return False


def test_ctrl_c_ends_it_and_its_processes_at_once_without_a_traceback() -> None:
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY / "src")}
    words = [sys.executable, "-m", "roomba.commands.program", "sim", "--homes", "1000"]
    process = subprocess.Popen(
        words,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    # One that is still being started may say that it was not given what it was to do.
    cores = len(os.sched_getaffinity(0))
    wait_until(
        lambda: sum(map(imports, children.read_text().split())) >= cores, 60.0, "all are at work"
    )
    started = children.read_text().split()
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    output, error = process.communicate(timeout=20.0)
    assert time.monotonic() - began < 5.0
    assert process.returncode == 130
    assert output + error == "./roomba sim: stopped on the way\n"
    promised(lambda: not any(map(is_alive, started)), 5.0, "its processes end")
