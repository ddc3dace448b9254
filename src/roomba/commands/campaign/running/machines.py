"""Runs on this machine's cores, or on a cluster: the same results, in any order."""

from __future__ import annotations

import contextlib
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from roomba.commands.campaign.running.runs import CampaignRun
from roomba.commands.campaign.running.work import RunEnd, Work, carried_out
from roomba.commands.trials.many import run_many

ATTEMPTS: Final = 3
"""How often a run is begun when it gives no result: its process dies, or the machine fails it."""


@dataclass(frozen=True, slots=True)
class Machines:
    """Where runs are made: on a ``cluster``, ADDRESS or local:N, or in so many ``processes``."""

    cluster: str | None = None
    processes: int | None = None


def run_on(
    machines: Machines, runs: Sequence[CampaignRun], work: Work = carried_out
) -> Generator[tuple[CampaignRun, RunEnd | str]]:
    """Yield each run with its result, in the order in which the runs end.

    A run that still has no result after ATTEMPTS yields the reason, a text: its process died, or
    the machine had no memory or disk. Raises OtherMachineError, and ClusterError without a
    scheduler or workers.
    """
    if machines.cluster is not None:
        # Imported here, since dask is an optional extra.
        from roomba.commands.campaign.running.cluster import run_on_cluster

        with contextlib.closing(run_on_cluster(machines.cluster, runs, work)) as ends:
            yield from ends
        return
    left: Sequence[CampaignRun] = runs
    for attempt in range(ATTEMPTS):
        lost: list[tuple[CampaignRun, str]] = []
        for run, end in _here(left, work, machines.processes):
            if isinstance(end, str):
                lost.append((run, end))
            else:
                yield run, end
        left = [run for run, _ in lost]
        if attempt == ATTEMPTS - 1:
            yield from lost


def _here(
    runs: Sequence[CampaignRun], work: Work, processes: int | None
) -> Iterator[tuple[CampaignRun, RunEnd | str]]:
    return run_many(runs, work, processes)
