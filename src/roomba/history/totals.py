"""Sums over runs: by week of the wall clock."""

from __future__ import annotations

import math
import sqlite3
import time
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

from roomba.history.run import RunFigures

_SUMMED: Final = ("covered", "duration", "dirt", "distance", "energy")


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
        weeks[_week_of(run.began)].append(run)
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
    """Return the same for the runs in a database that meet ``which``, a condition of SQL."""
    database.create_function("week_of", 1, _week_of, deterministic=True)
    sums = ", ".join(f"TOTAL({name})" for name in _SUMMED)
    rows = database.execute(
        f"SELECT week_of(began) AS week, COUNT(*), {sums} FROM runs WHERE {which} "
        "GROUP BY week ORDER BY week DESC",
        values,
    )
    return [WeekTotals(*row) for row in rows]


def _week_of(began: float) -> str:
    """Return the week of a time, s since 1970, by local time."""
    return time.strftime("%G-W%V", time.localtime(began))
