"""The runs as tables: for a terminal, and as CSV."""

from __future__ import annotations

import csv
import datetime
import io
import math
from collections.abc import Sequence
from typing import Any, Final

from rich.table import Table
from rich.text import Text

from roomba.commands.telling import named_table
from roomba.history.database import KeptRun
from roomba.history.report import words
from roomba.history.totals import totals_by_week

COLUMNS: Final = (
    "run", "began", "program", "home", "seed", "kind", "outcome", "message", "duration_s",
    "covered_m2", "wanted_m2", "distance_m", "turning_rad", "dirt_g", "energy_wh", "missed_places",
    "missed_m2", "repeat",
)  # fmt: skip


def csv_of(runs: Sequence[KeptRun]) -> str:
    """Return the runs as CSV with a head (COLUMNS); what is not known is empty, times are UTC."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for run in runs:
        writer.writerow(_values(run))
    return file.getvalue()


def _values(run: KeptRun) -> list[Any]:
    figures = run.figures
    source = figures.source
    began = datetime.datetime.fromtimestamp(figures.began, datetime.timezone.utc)
    numbers = (
        figures.duration,
        figures.covered,
        figures.wanted,
        figures.distance,
        figures.turning,
        figures.dirt,
        figures.energy,
    )
    return [
        run.number,
        began.strftime("%Y-%m-%dT%H:%M:%SZ"),
        source.program,
        source.home,
        "" if source.seed is None else source.seed,
        figures.kind,
        figures.outcome,
        figures.message,
        *(f"{number:.4f}" if math.isfinite(number) else "" for number in numbers),
        len(figures.missed),
        f"{sum(miss.area for miss in figures.missed):.4f}",
        source.repeat,
    ]


def runs_table(runs: Sequence[KeptRun]) -> Table:
    """Return a row for each run."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    for name in ("run", "began", "program", "home", "outcome"):
        table.add_column(name, no_wrap=True)
    for name in ("clean", "missed", "time", "way", "dirt"):
        table.add_column(name, justify="right", no_wrap=True)
    for run in runs:
        figures = run.figures
        table.add_row(
            str(run.number),
            words.moment(figures.began),
            figures.source.program,
            Text(figures.source.home),
            figures.outcome,
            f"{words.number(figures.covered, 1, 'm²')} ({words.share(figures.fraction)})",
            str(len(figures.missed)),
            words.duration(figures.duration),
            words.number(figures.distance, 0, "m"),
            words.number(figures.dirt, 1, "g"),
        )
    return table


def weeks_table(runs: Sequence[KeptRun]) -> Table:
    """Return a row for each week."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    table.add_column("week", no_wrap=True)
    for name in ("runs", "clean", "time", "way", "dirt", "energy"):
        table.add_column(name, justify="right", no_wrap=True)
    for week in totals_by_week(run.figures for run in runs):
        table.add_row(
            week.week,
            str(week.runs),
            f"{week.covered:.1f} m²",
            words.duration(week.duration),
            f"{week.distance:.0f} m",
            f"{week.dirt:.1f} g",
            f"{week.energy:.1f} Wh",
        )
    return table


def run_table(run: KeptRun) -> Table:
    """Return the figures of one run, and what it missed."""
    rows = [*words.figure_rows(run.figures)]
    if run.figures.message:
        rows.append(("Message", run.figures.message))
    for miss in run.figures.missed:
        where = f" in {miss.room}" if miss.room else ""
        rows.append(("Left", f"{miss.area:.2f} m²{where}: {miss.reason}"))
    if run.figures.source.repeat:
        rows.append(("Repeat", run.figures.source.repeat))
    return named_table(rows)
