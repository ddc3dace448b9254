"""The runs as tables: for a terminal, and as CSV."""

from __future__ import annotations

import csv
import datetime
import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, Final

from rich.table import Table
from rich.text import Text

from roomba.client.protocol import MissedFloor
from roomba.commands.output import named_table
from roomba.history.report import words
from roomba.history.run_rows import KeptRun
from roomba.history.totals import totals_by_week

COLUMNS: Final = (
    "run", "began", "program", "home", "seed", "kind", "outcome", "message", "duration_s",
    "covered_m2", "wanted_m2", "distance_m", "turning_rad", "dirt_g", "energy_wh", "missed_places",
    "missed_m2", "mapped_m2", "open_m", "repeat",
)  # fmt: skip


_TOLD: Final[dict[str, Callable[[KeptRun], str]]] = {
    "run": lambda run: str(run.number),
    "began": lambda run: words.moment(run.figures.began),
    "program": lambda run: run.figures.source.program,
    "home": lambda run: run.figures.source.home,
    "outcome": lambda run: run.figures.outcome,
    "clean": lambda run: (
        f"{words.number(run.figures.covered, 1, 'm²')} ({words.share(run.figures.fraction)})"
    ),
    "missed": lambda run: str(len(run.figures.missed)),
    "time": lambda run: words.duration(run.figures.duration),
    "way": lambda run: words.number(run.figures.distance, 0, "m"),
    "dirt": lambda run: words.number(run.figures.dirt, 1, "g"),
}
"""By column of the list, the function that gives its text, in the order of the columns."""
_BY_WORTH: Final = (
    "run", "began", "home", "outcome", "clean", "time", "missed", "dirt", "way", "program",
)  # fmt: skip
_TO_THE_RIGHT: Final = frozenset({"clean", "missed", "time", "way", "dirt"})
_GAP: Final = 2
"""Characters between two columns."""


def csv_of(runs: Sequence[KeptRun]) -> str:
    """Return the runs as CSV with a head (COLUMNS); what is not known is empty, times are UTC."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for run in runs:
        writer.writerow(["" if value is None else _in_csv(value) for value in _values(run)])
    return file.getvalue()


def json_of(runs: Sequence[KeptRun]) -> dict[str, Any]:
    """Return the runs as values of JSON, named as in CSV; what is not known is None."""
    return {
        "runs": [
            {
                **dict(zip(COLUMNS, _values(run), strict=True)),
                "missed": [_place_values(miss) for miss in run.figures.missed],
                "open_edges": [asdict(edge) for edge in run.figures.open_edges],
            }
            for run in runs
        ]
    }


def _place_values(missed: MissedFloor) -> dict[str, Any]:
    values = asdict(missed)
    return {"area_m2": values.pop("area"), **values}


def _in_csv(value: str | float) -> str:
    return f"{value:.4f}" if isinstance(value, float) else str(value)


def _values(run: KeptRun) -> list[str | float | None]:
    """Return the values of COLUMNS."""
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
        source.seed,
        figures.kind,
        figures.outcome,
        figures.message,
        *(number if math.isfinite(number) else None for number in numbers),
        len(figures.missed),
        math.fsum(miss.area for miss in figures.missed),
        figures.mapped if math.isfinite(figures.mapped) else None,
        math.fsum(edge.length for edge in figures.open_edges),
        source.repeat,
    ]


def runs_table(runs: Sequence[KeptRun], width: int) -> Table:
    """Return a row for each run, with as many columns as a terminal of ``width`` columns has room
    for: the most telling ones.
    """
    cells = {name: [of(run) for run in runs] for name, of in _TOLD.items()}
    table = Table(box=None, padding=(0, _GAP, 0, 0))
    shown = _fitting(cells, width)
    for name in shown:
        table.add_column(name, justify="right" if name in _TO_THE_RIGHT else "left", no_wrap=True)
    for row in range(len(runs)):
        table.add_row(*(Text(cells[name][row]) for name in shown))
    return table


def _fitting(cells: Mapping[str, Sequence[str]], width: int) -> list[str]:
    """Return the names of the columns that fit the width, in the table's order."""
    needed = {name: _GAP + max(map(len, (name, *texts))) for name, texts in cells.items()}
    taken: set[str] = set()
    for name in _BY_WORTH:
        if sum(needed[each] for each in (*taken, name)) > width:
            break
        taken.add(name)
    return [name for name in cells if name in taken]


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
    """Return the figures of one run, what it missed, and where its map stays open."""
    rows = [*words.figure_rows(run.figures)]
    if run.figures.message:
        rows.append(("Message", run.figures.message))
    for miss in run.figures.missed:
        where = f" in {miss.room}" if miss.room else ""
        rows.append(("Left", f"{miss.area:.2f} m²{where}: {miss.reason}"))
    for edge in run.figures.open_edges:
        at = words.place(edge.x, edge.y)
        rows.append(("Open", f"{edge.length:.1f} m at {at}: {edge.reason.value}"))
    if run.figures.source.repeat:
        rows.append(("Repeat", run.figures.source.repeat))
    return named_table(rows)
