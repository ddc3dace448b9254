"""Runs on a real cluster, whose processes are killed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fixtures.campaigns.campaign_work import NOTES, made_run, noted, times_begun
from fixtures.campaigns.dask_processes import DaskProcesses

from roomba.commands.campaign.running.cluster import ClusterError, check_cluster, run_on_cluster
from roomba.commands.campaign.running.work import RunEnd
from roomba.commands.options import UsageError

RUNS = [made_run(seed) for seed in range(30)]
KILLED_AFTER = 8
AT_WORK = 8
"""The most runs that can be given out at a time: what is begun twice is among them."""


@pytest.fixture
def dask(tmp_path: Path) -> Iterator[DaskProcesses]:
    (tmp_path / "notes").touch()
    with DaskProcesses(tmp_path, {NOTES: str(tmp_path / "notes")}) as processes:
        processes.start_scheduler()
        yield processes


def hits_of(end: RunEnd | str) -> int:
    assert isinstance(end, RunEnd), end
    assert end.figures is not None
    return end.figures.hits


def test_a_killed_worker_loses_nothing(dask: DaskProcesses, tmp_path: Path) -> None:
    first = dask.start_worker()
    ended: dict[str, int] = {}
    for run, end in run_on_cluster(dask.address, RUNS, noted):
        assert run.key not in ended
        ended[run.key] = hits_of(end)
        if len(ended) == KILLED_AFTER:
            dask.start_worker()
            first.kill()
    assert ended == {run.key: run.seed for run in RUNS}
    begun = times_begun(tmp_path / "notes")
    assert sum(begun.values()) - len(RUNS) <= AT_WORK


@pytest.mark.thorough
def test_a_killed_scheduler_loses_nothing_and_repeats_nothing_that_came_back(
    dask: DaskProcesses, tmp_path: Path
) -> None:
    dask.start_worker()
    ended: dict[str, int] = {}
    before: set[str] = set()
    for run, end in run_on_cluster(dask.address, RUNS, noted):
        assert run.key not in ended
        ended[run.key] = hits_of(end)
        if len(ended) == KILLED_AFTER:
            before = set(ended)
            dask.kill_scheduler()
            dask.start_scheduler()
            dask.start_worker()
    assert ended == {run.key: run.seed for run in RUNS}
    begun = times_begun(tmp_path / "notes")
    assert all(begun[key] == 1 for key in before)
    assert sum(begun.values()) - len(RUNS) <= AT_WORK


def test_without_workers_it_is_given_up_and_told(dask: DaskProcesses) -> None:
    with pytest.raises(ClusterError, match=r"expected workers, found none for 0\.5 s"):
        list(run_on_cluster(dask.address, RUNS, noted, patience=0.5))


def test_without_a_scheduler_it_is_given_up_and_told(dask: DaskProcesses) -> None:
    dask.kill_scheduler()
    with pytest.raises(ClusterError, match=r"found none within 0\.5 s; what has ended is stored"):
        list(run_on_cluster(dask.address, RUNS, noted, patience=0.5))


@pytest.mark.parametrize("text", ["local:0", "local:", "local:x", "here", "http://a:1", "a b:3"])
def test_what_is_no_cluster_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="expected local:N, or the HOST:PORT"):
        check_cluster(text)


@pytest.mark.parametrize("text", ["local:4", "node7:8786", "tls://10.0.0.1:8786", "[::1]:8786"])
def test_what_is_one_is_taken(text: str) -> None:
    check_cluster(text)
