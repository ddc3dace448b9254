"""Whole campaigns of real runs, whose processes are killed: nothing is lost, nothing runs twice."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from fixtures.campaigns.dask_processes import DaskProcesses
from fixtures.homes.tiny_home import tiny_home
from fixtures.processes.programs import is_running
from fixtures.waiting import wait_until

from roomba.commands.campaign.running.machines import Machines, run_on
from roomba.commands.campaign.running.runs import runs_of
from roomba.commands.campaign.running.specification import read_campaign
from roomba.commands.campaign.running.work import RunEnd
from roomba.commands.sim.json_file import TIMES
from roomba.files.journal import read_lines

ROOT = Path(__file__).resolve().parents[2]
TEXT = """
homes: [tiny]
seeds: {first: 0, count: 5}
variants:
  usual: {}
  tight turns: {numbers: {mission.coverage.turning: 5.0}}
"""
RUNS = 10
STARTED = 120.0
"""s until a worker has loaded all and made a run."""


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROOMBA_HISTORY", str(tmp_path / "history"))
    (tmp_path / "tiny").mkdir()
    tiny_home(tmp_path / "tiny").rename(tmp_path / "tiny" / "map.yaml")
    (tmp_path / "tiny" / "tiny.home.yaml").rename(tmp_path / "tiny" / "home.yaml")
    path = tmp_path / "made.yaml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def stored(file: Path) -> list[dict[str, Any]]:
    return read_lines(file.with_suffix(".results") / "results.journal")


def started(file: Path, *words: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "roomba.commands.program", "campaign", str(file), *words]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)


def children_of(pid: int) -> list[int]:
    """Return the processes below one, as proc(5) has them."""
    found: list[int] = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state = path.read_text(encoding="utf-8", errors="replace")
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(state.rpartition(")")[2].split()[1]) == pid:
            child = int(path.parent.name)
            found += [child, *children_of(child)]
    return found


def has_stored(file: Path, least: int) -> bool:
    return len(stored(file)) >= least


def have_ended(processes: list[int]) -> bool:
    return not any(map(is_running, processes))


@pytest.mark.parametrize("where", [("--processes", "2"), ("--cluster", "local:2")])
def test_a_command_that_is_killed_goes_on_and_leaves_no_process(
    file: Path, where: tuple[str, str]
) -> None:
    for least in (1, 4):
        command = started(file, *where)
        wait_until(partial(has_stored, file, least), STARTED, "runs are stored", 0.05)
        below = children_of(command.pid)
        command.send_signal(signal.SIGKILL)
        command.wait()
        wait_until(partial(have_ended, below), 20.0, "workers ended")
    before = stored(file)
    assert started(file, *where).wait() == 0
    rows = stored(file)
    assert rows[: len(before)] == before
    keys = [row["key"] for row in rows]
    assert len(keys) == len(set(keys)) == RUNS
    assert all(row["figures"]["outcome"] == "COMPLETED" for row in rows)


@pytest.fixture
def dask(tmp_path: Path) -> Iterator[DaskProcesses]:
    with DaskProcesses(tmp_path, {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}) as processes:
        processes.start_scheduler()
        yield processes


def test_a_cluster_that_is_killed_gives_the_figures_of_this_machine(
    file: Path, dask: DaskProcesses
) -> None:
    runs = runs_of(read_campaign(file))
    here = {run.key: figures_of(end) for run, end in run_on(Machines(processes=2), runs)}
    first = dask.start_worker()
    there: dict[str, dict[str, Any]] = {}
    for run, end in run_on(Machines(cluster=dask.address), runs):
        assert run.key not in there
        there[run.key] = figures_of(end)
        if len(there) == 2:
            first.kill()
            dask.start_worker()
        if len(there) == 5:
            dask.kill_scheduler()
            dask.start_scheduler()
            dask.start_worker()
    assert len(there) == RUNS
    assert json.dumps(there, sort_keys=True) == json.dumps(here, sort_keys=True)


def figures_of(end: RunEnd | str) -> dict[str, Any]:
    assert isinstance(end, RunEnd), end
    assert end.figures is not None, end.failure
    return {name: value for name, value in end.figures.as_json().items() if name not in TIMES}
