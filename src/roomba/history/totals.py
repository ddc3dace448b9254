"""Sums over runs: by week of the wall clock."""

from __future__ import annotations

import datetime as dt
import math
import sqlite3
import time
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

from roomba.history.run import RunFigures

_SUMMED: Final = ("covered", "duration", "dirt", "distance", "energy")
_THURSDAY: Final = "date(began, 'unixepoch', 'localtime', '-3 days', 'weekday 4')"
"""Of the week of a run, by local time: the day that says to which year a week belongs."""


@dataclass(frozen=True, slots=True)
class WeekTotals:
    """All runs of a week (``2026-W07``): m2, s, g, m, Wh; what is not known counts as nothing."""

    week: str
    runs: int
    covered: float
    duration: float
    dirt: float
    distance: float
    energy: float


def totals_by_week(runs: Iterable[RunFigures]) -> list[WeekTotals]:
    """Return the weeks in which there were runs, by local time, the newest first."""
    weeks: dict[str, list[RunFigures]] = defaultdict(list)
    for run in runs:
        weeks[time.strftime("%G-W%V", time.localtime(run.began))].append(run)
    return [
        WeekTotals(
            week,
            len(those),
            *(
                sum(value for run in those if math.isfinite(value := getattr(run, name)))
                for name in _SUMMED
            ),
        )
        for week, those in sorted(weeks.items(), reverse=True)
    ]


def weeks_of(database: sqlite3.Connection, which: str, values: tuple[Any, ...]) -> list[WeekTotals]:
    """Return the same of those runs in a database of which a condition of SQL is true."""
    sums = ", ".join(f"TOTAL({name})" for name in _SUMMED)
    rows = database.execute(
        f"SELECT {_THURSDAY} AS thursday, COUNT(*), {sums} FROM runs WHERE {which} "
        "GROUP BY thursday ORDER BY thursday DESC",
        values,
    )
    return [
        WeekTotals(dt.date.fromisoformat(thursday).strftime("%G-W%V"), *rest)
        for thursday, *rest in rows
    ]
