"""``./roomba campaign``: many runs on many machines, stored one by one, and compared."""

from __future__ import annotations

import contextlib
import shlex
import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from roomba.commands.campaign.options import PROGRAM, CampaignOptions, options_of
from roomba.commands.exit_status import complain_of, guarded
from roomba.commands.options import UsageError
from roomba.commands.output import clock, named_table, tell_tables, write_json
from roomba.commands.process_end import STOPPED, quiet_loading
from roomba.commands.progress import Show, progress
from roomba.errors import ConfigError, RoombaError

if TYPE_CHECKING:
    from roomba.commands.campaign.running.machines import Machines
    from roomba.commands.campaign.running.runs import CampaignRun
    from roomba.commands.campaign.running.specification import Campaign
    from roomba.commands.campaign.running.store import ResultStore, Row

DONE, SOME_FAILED = 0, 1
_PARQUET: Final = "results.parquet"
_PLOT: Final = "differences.png"

Lost = list[tuple[str, str]]
"""Runs without any result, by name, and why they have none."""


def main(arguments: list[str] | None = None) -> int:
    """Do what a command line asks for; returns the exit status."""
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(
        lambda: _run(options_of(arguments), words),
        PROGRAM,
        SOME_FAILED,
        unfit=(UsageError, ConfigError),
        stopped=f"{STOPPED}; the same command goes on",
    )


def _run(options: CampaignOptions, words: Sequence[str]) -> int:
    # Imported here: it takes a second, and a mistyped option should be reported at once.
    with quiet_loading():
        from roomba.commands.campaign.checked import check_campaign
        from roomba.commands.campaign.running.runs import runs_of
        from roomba.commands.campaign.running.specification import read_campaign
        from roomba.commands.campaign.running.store import opened_store
        from roomba.commands.first_use import require_compiled

    campaign = read_campaign(options.file)
    check_campaign(campaign, options.machines)
    if options.machines.cluster is None:
        require_compiled(is_quiet=options.quiet)
    runs = runs_of(campaign)
    with opened_store(options.out) as store:
        lost: Lost = []
        try:
            with progress("Campaign", options.quiet) as show:
                lost = make_runs(options.machines, runs, store, show)
        finally:
            # The runs that ended can be looked at, however the campaign ends.
            rows = store.rows_of(runs)
            _write_results(options, campaign, rows, shlex.join([*PROGRAM.split(), *words]))
        _tell(options, campaign, rows, lost)
    return SOME_FAILED if lost or any(row["figures"] is None for row in rows) else DONE


def make_runs(
    machines: Machines, runs: Sequence[CampaignRun], store: ResultStore, show: Show
) -> Lost:
    """Make and store the runs that are not stored yet; return those without any result."""
    from roomba.commands.campaign.running.machines import run_on

    # Of runs that are the same in several variants only one is made.
    left = list({run.key: run for run in runs if run.key not in store}.values())
    began, before = time.monotonic(), len({run.key for run in runs}) - len(left)
    lost: Lost = []
    if not left:
        return lost
    with contextlib.closing(run_on(machines, left)) as ends:
        for done, (run, end) in enumerate(ends, 1):
            if isinstance(end, str):
                lost.append((f"{run.home}, seed {run.seed}, {run.variant}", end))
            else:
                store.add(run, end)
            to_go = (time.monotonic() - began) / done * (len(left) - done)
            show(
                (before + done) / (before + len(left)),
                f"{before + done} of {before + len(left)}, {clock(to_go)} to go",
            )
    return lost


def _write_results(
    options: CampaignOptions, campaign: Campaign, rows: Sequence[Row], repeat: str
) -> None:
    """Write Parquet and history; an error is reported, and does not end the campaign."""
    from roomba.commands.campaign.parquet import why_no_parquet, write_parquet

    if not rows:
        return
    if reason := why_no_parquet():
        mend = "pip install 'roomba_robot[campaign]'"
        complain_of(PROGRAM, f"no {_PARQUET}: {reason}; to mend it: {mend}")
    else:
        write_parquet(options.out / _PARQUET, campaign, rows)
    if options.keep:
        from roomba.commands.campaign.kept import keep_runs
        from roomba.history.database import History
        from roomba.history.folder import history_folder

        try:
            keep_runs(History(history_folder()), campaign, rows, repeat)
        except RoombaError as error:
            complain_of(PROGRAM, f"the runs were not kept in the history: {error}")


def _tell(options: CampaignOptions, campaign: Campaign, rows: Sequence[Row], lost: Lost) -> None:
    from roomba.commands.campaign.comparison import comparisons_of
    from roomba.commands.campaign.plot import write_plot
    from roomba.commands.campaign.report import as_json, failure_lines, tables_of

    comparisons = comparisons_of(campaign, rows)
    if comparisons:
        write_plot(options.plot or options.out / _PLOT, campaign, comparisons)
    failed = failure_lines(rows, lost)
    told = [("results", f"{len(rows)} runs in {options.out}"), *failed]
    tables = [*tables_of(campaign, rows, comparisons), named_table(told)]
    tell_tables(tables, options.json, quiet=options.quiet)
    if options.json is not None:
        write_json(options.json, as_json(campaign, rows, comparisons, lost))
