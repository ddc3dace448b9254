"""``./roomba sim``: one headless run, or many, told as a table, JSON, a picture and a bag."""

from __future__ import annotations

import contextlib
import shlex
import sys
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from roomba.commands.exit_status import COMPLETED, ENDED_OTHERWISE, USAGE, guarded
from roomba.commands.garbage_pause import nothing_thrown_away
from roomba.commands.options import UsageError
from roomba.commands.output import named_table, tell_tables, write_json
from roomba.commands.process_end import quiet_loading
from roomba.commands.progress import Show, progress
from roomba.commands.sim.options import PROGRAM, SimOptions, options_of, repeating
from roomba.commands.trials.trial import Trial
from roomba.errors import RoombaError

if TYPE_CHECKING:
    from roomba.commands.trials.figures import Figures
    from roomba.commands.trials.many import Outcome
    from roomba.commands.trials.runs import Run, RunObserver, TrialSetup
    from roomba.headless.mission import HeadlessMission
    from roomba.mission.inputs.planning_context import PlanningContext

BagOpener = Callable[[Path, "TrialSetup"], AbstractContextManager["RunObserver"]]
"""Opens a bag; the context gives a function that is called with the robot again and again."""

BAG_BURST: Final = 2
"""Ticks between two records of a bag, as its fastest topics have 10 Hz."""
_SHOWN: Final = 0.1
"""s between two updates of the progress: to format its text takes as long as some ticks."""


def main(arguments: list[str] | None = None, open_bag: BagOpener | None = None) -> int:
    """Do what a command line asks for; returns the exit status."""
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(lambda: _run(words, open_bag), PROGRAM, USAGE)


def _run(words: list[str], open_bag: BagOpener | None) -> int:
    options = options_of(words)
    if options.bag is not None and open_bag is None:
        raise UsageError(f"--bag: expected a Python with ROS, got none; call {PROGRAM} --bag")
    if options.homes is not None:
        return _run_homes(options, options.homes, words)
    return _run_one(options, open_bag, words)


def _run_one(options: SimOptions, open_bag: BagOpener | None, words: list[str]) -> int:
    # Imported here: it takes a second, and a mistyped option should be reported at once.
    with quiet_loading(), nothing_thrown_away():
        from roomba.commands.first_use import require_compiled
        from roomba.commands.sim.state_samples import StateSamples
        from roomba.commands.trials.runs import TrialSetup
        from roomba.headless.burst import LONGEST_BURST

    require_compiled(is_quiet=options.quiet)
    burst = LONGEST_BURST if options.bag is None else BAG_BURST
    setup, samples = TrialSetup(options.trial, burst), StateSamples()
    with contextlib.ExitStack() as stack:
        observers: list[RunObserver] = []
        show = stack.enter_context(progress("Cleaning", options.quiet))
        observers.append(_shown_by(show))
        if options.keep:
            observers.append(samples)
        if options.bag is not None and open_bag is not None:
            observers.append(stack.enter_context(open_bag(options.bag, setup)))
        run = setup.run(observers)
    _tell_run(options, run, setup.robot.context)
    if options.keep:
        # The history is loaded only once the table is printed.
        from roomba.commands.sim.kept_run import keep_run

        try:
            keep_run(run, samples, shlex.join([*PROGRAM.split(), *words]))
        except RoombaError as error:
            print(f"{PROGRAM}: the run was not kept: {error}", file=sys.stderr)
    return COMPLETED if run.figures.is_completed else ENDED_OTHERWISE


def _shown_by(show: Show) -> RunObserver:
    from roomba.commands.output import clock

    looked, share = time.monotonic(), 0.0

    def observe(robot: HeadlessMission) -> None:
        nonlocal looked, share
        if time.monotonic() - looked < _SHOWN:
            return
        looked = time.monotonic()
        passed, left = robot.seen.time, robot.mission.seconds_to_go()
        if left > 0.0:  # before there is a plan the time to go is unknown
            share = passed / (passed + left)
        show(share, f"{clock(passed)} of robot time, {robot.mission.state.phase.value}")

    return observe


def _tell_run(options: SimOptions, run: Run, context: PlanningContext) -> None:
    from roomba.commands.sim.json_file import run_as_json
    from roomba.commands.sim.report import table_of
    from roomba.commands.trials.unreached import unreached_in

    if options.plot is not None:
        from roomba.commands.sim.plot import write_plot

        write_plot(options.plot, run)
    unreached = unreached_in(context)
    table = table_of(run.figures, unreached, run.home.station_place)
    tell_tables([table], options.json, quiet=options.quiet)
    if options.json is not None:
        write_json(options.json, run_as_json(run, unreached))


def _run_homes(options: SimOptions, homes: int, words: list[str]) -> int:
    with quiet_loading():
        from roomba.commands.first_use import require_compiled
        from roomba.commands.trials.many import figures_of, run_many

    require_compiled(is_quiet=options.quiet)
    first = options.trial.seed
    trials = [options.trial.with_seed(first + number) for number in range(homes)]
    figures: dict[int, Figures] = {}
    failures: dict[int, str] = {}
    began = time.monotonic()
    with progress("Homes", options.quiet) as show:
        for trial, outcome in run_many(trials, figures_of):
            _sort_in(trial, outcome, figures, failures)
            done = len(figures) + len(failures)
            bad = done - sum(each.is_completed for each in figures.values())
            show(done / homes, f"{done} of {homes}, {bad} not completed")
    _tell_homes(options, figures, failures, time.monotonic() - began, repeating(words))
    is_fine = not failures and all(each.is_completed for each in figures.values())
    return COMPLETED if is_fine else ENDED_OTHERWISE


def _sort_in(
    trial: Trial, outcome: Outcome, figures: dict[int, Figures], failures: dict[int, str]
) -> None:
    if isinstance(outcome, str):
        failures[trial.seed] = outcome
    else:
        figures[trial.seed] = outcome


def _tell_homes(
    options: SimOptions,
    figures: dict[int, Figures],
    failures: dict[int, str],
    wall: float,
    again: str,
) -> None:
    from roomba.commands.sim.json_file import runs_as_json
    from roomba.commands.sim.percentiles import percentiles_of
    from roomba.commands.sim.report import failure_lines, percentile_table
    from roomba.commands.trials.runs import robot_config_of

    spread = percentiles_of(figures.values())
    completed = sum(each.is_completed for each in figures.values())
    count = len(figures) + len(failures)
    ended = f"{completed} of {count} completed and docked, in {wall:.1f} s"
    failed = failure_lines(figures, failures, again)
    rows = named_table([("homes", ended), *failed], dict.fromkeys(dict(failed), "red"))
    tell_tables([percentile_table(spread), rows], options.json, quiet=options.quiet)
    if options.json is not None:
        config = robot_config_of(options.trial)
        write_json(options.json, runs_as_json(figures, failures, spread, config, wall))
