"""Much work in several processes, with work that takes no time."""

from __future__ import annotations

import math
import multiprocessing
import os
import threading
import time
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.processes.ctrl_c import blocks_ctrl_c
from fixtures.waiting import wait_until

from roomba.commands.trials import many
from roomba.commands.trials.figures import Figures
from roomba.commands.trials.many import Outcome, run_many
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


def test_processes_that_die_before_they_have_begun_are_replaced() -> None:
    def kill_the_first() -> None:
        first = wait_until(multiprocessing.active_children, 20.0, "a process", 0.001)[0]
        first.kill()
        killed.append(first.pid)

    killed: list[int | None] = []
    killer = threading.Thread(target=kill_the_first)
    killer.start()
    found = dict(run_many([4.0, 9.0], math.sqrt, 1))
    killer.join()
    assert killed != []
    assert found == {4.0: 2.0, 9.0: 3.0}


def test_each_process_computes_in_one_thread() -> None:
    before = os.environ.get("NUMBA_NUM_THREADS")
    names = ["NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENCV_FOR_THREADS_NUM"]
    assert dict(run_many(names, os.getenv, 2)) == dict.fromkeys(names, "1")
    assert os.environ.get("NUMBA_NUM_THREADS") == before


def test_processes_do_not_see_ctrl_c_from_their_begin_on() -> None:
    # In a process of its own: what starts with the first one there is opened the signal again.
    assert blocks_ctrl_c(
        "from pathlib import Path\n"
        "from roomba.commands.trials.many import run_many\n"
        "[(_, status)] = run_many([Path('/proc/self/status')], Path.read_text, 1)\n"
        "print(status)"
    )
