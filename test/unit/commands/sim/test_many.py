"""Many trials in several processes, with work that takes no time."""

from __future__ import annotations

import os
import time
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.waiting import wait_until

from roomba.commands.sim import many
from roomba.commands.sim.many import Outcome, run_many
from roomba.commands.trials.figures import Figures
from roomba.commands.trials.trial import Trial

NOTHING = Figures(
    outcome="COMPLETED",
    message="",
    docked=True,
    duration_s=1.0,
    wall_s=1.0,
    planning_s=0.0,
    plans=0,
    distance_m=0.0,
    turning_rad=0.0,
    energy_wh=0.0,
    dirt_g=0.0,
    coverable_m2=1.0,
    covered_m2=1.0,
    tool_width_m=0.2,
    hits=0,
    missed=(),
)


FORK = "fork"
"""A spawned process would not find this file."""


def worked(trial: Trial) -> Outcome:
    """Count the seed, break, die or hang, as the seed says."""
    if trial.seed == 3:
        return "no floor"
    if trial.seed == 4:
        os._exit(7)
    if trial.seed == 99:
        Path(trial.home).write_text(str(os.getpid()), encoding="utf-8")
        time.sleep(60.0)
    return replace(NOTHING, hits=trial.seed)


def trials(*seeds: int) -> list[Trial]:
    return [Trial(home="nowhere", seed=seed) for seed in seeds]


def test_every_trial_comes_back_with_what_came_of_it() -> None:
    found = {t.seed: out for t, out in run_many(trials(*range(8)), worked, 2, FORK)}
    assert sorted(found) == list(range(8))
    assert found[3] == "no floor"
    assert "its process ended (status 7)" in str(found[4])
    for seed in set(found) - {3, 4}:
        assert found[seed] == replace(NOTHING, hits=seed)


def test_a_caller_that_stops_listening_ends_all_at_once(tmp_path: Path) -> None:
    note = tmp_path / "pid"
    hangs = Trial(home=str(note), seed=99)
    runs = run_many([hangs, *trials(1)], worked, 2, FORK)
    next(runs)
    wait_until(lambda: note.is_file() and note.read_text(), 20.0, "what hangs has begun")
    began = time.monotonic()
    assert isinstance(runs, Generator)
    runs.close()
    assert time.monotonic() - began < 5.0
    with pytest.raises(ProcessLookupError):
        os.kill(int(note.read_text()), 0)


def test_what_hangs_is_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(many, "LONGEST_RUN", 0.2)
    ((_, outcome),) = run_many([Trial(home=str(tmp_path / "pid"), seed=99)], worked, 1, FORK)
    assert "no result within 0.2 s" in str(outcome)
