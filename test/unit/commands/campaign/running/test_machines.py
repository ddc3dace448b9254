"""Runs on this machine: one whose process dies is begun again, and given up at last."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from fixtures.campaigns.campaign_work import NOTES, made_run, noted, times_begun

from roomba.commands.campaign.running import machines
from roomba.commands.campaign.running.machines import ATTEMPTS, Machines, run_on
from roomba.commands.campaign.running.runs import CampaignRun
from roomba.commands.campaign.running.work import RunEnd, Work
from roomba.commands.trials.many import run_many

RUNS = [made_run(seed) for seed in range(6)]
DIES, DIES_ONCE = 3, 4


@pytest.fixture
def notes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "notes"
    path.touch()
    monkeypatch.setenv(NOTES, str(path))

    def here(
        runs: Sequence[CampaignRun], work: Work, processes: int | None
    ) -> Iterator[tuple[CampaignRun, RunEnd | str]]:
        # A spawned process would not find this file.
        return run_many(runs, work, processes, "fork")

    monkeypatch.setattr(machines, "_here", here)
    return path


def deadly(run: CampaignRun) -> RunEnd:
    begun = times_begun(Path(os.environ[NOTES]))[run.key]
    end = noted(run)
    if run.seed == DIES or (run.seed == DIES_ONCE and not begun):
        os._exit(7)
    return end


def test_a_run_whose_process_dies_is_begun_again(notes: Path) -> None:
    ends = {run.seed: end for run, end in run_on(Machines(processes=2), RUNS, deadly)}
    assert sorted(ends) == list(range(6))
    begun = times_begun(notes)
    for run in RUNS:
        end = ends[run.seed]
        if run.seed == DIES:
            assert end == "its process ended (status 7)"
            assert begun[run.key] == ATTEMPTS
        else:
            assert isinstance(end, RunEnd)
            assert end.figures is not None
            assert end.figures.hits == run.seed
            assert begun[run.key] == (2 if run.seed == DIES_ONCE else 1)
