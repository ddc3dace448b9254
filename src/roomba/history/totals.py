"""Sums over runs: by week of the wall clock."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from roomba.history.run import RunFigures


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
                for name in ("covered", "duration", "dirt", "distance", "energy")
            ),
        )
        for week, those in sorted(weeks.items(), reverse=True)
    ]
