"""Totals by week."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest

from roomba.history.run import RunFigures
from roomba.history.totals import totals_by_week


def at(day: str) -> float:
    return time.mktime(time.strptime(f"{day} 12:00", "%Y-%m-%d %H:%M"))


def test_weeks_begin_on_monday_and_the_newest_comes_first(figures: RunFigures) -> None:
    days = ("2026-01-04", "2026-01-05", "2026-01-11", "2026-01-12")
    runs = [replace(figures, began=at(day)) for day in days]
    weeks = totals_by_week(runs)
    assert [(week.week, week.runs) for week in weeks] == [
        ("2026-W03", 1),
        ("2026-W02", 2),
        ("2026-W01", 1),
    ]
    assert weeks[1].covered == pytest.approx(2 * figures.covered)
    assert weeks[1].duration == pytest.approx(2 * figures.duration)
    assert weeks[1].distance == pytest.approx(2 * figures.distance)


def test_what_is_not_known_counts_as_nothing(figures: RunFigures) -> None:
    assert math.isnan(figures.energy)
    (week,) = totals_by_week([figures, replace(figures, energy=2.0)])
    assert week.energy == 2.0
    assert totals_by_week([]) == []
