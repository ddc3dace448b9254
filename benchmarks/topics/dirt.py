"""Cleaning where the dirt is: a month by a fixed plan, and by what was learned of the rooms.

In each home the same dirt falls; each clean is driven, with noise. The first week, in which it is
learned, counts for the way, and not for how clean it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from benchmarks.bench import Bench
from benchmarks.dirt.month import (
    Day,
    Household,
    Plan,
    all_rooms,
    every_other_day,
    live,
    what_is_due,
)
from benchmarks.record import Better, PeerFigure, Record

_TOPIC: Final = "dirt"
_HOMES: Final = ("flat", "family")
_DAYS, _QUICK_DAYS = 30, 10
_LEARNING: Final = 7
"""Days that do not count for how clean it is."""
_LESS: Final = 30.0
"""% of the way that is to be saved."""
_FIXED: Final = "all rooms daily"
_HALF: Final = "all rooms every other day"


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    days = _QUICK_DAYS if bench.is_quick else _DAYS
    records: list[Record] = []
    for home in _HOMES[:1] if bench.is_quick else _HOMES:
        lives: dict[str, tuple[Household, list[Day]]] = {}
        plans: list[tuple[str, Plan]] = [("due", what_is_due), (_FIXED, all_rooms)]
        if not bench.is_quick:
            plans.append((_HALF, every_other_day))
        for name, plan in plans:
            bench.say(f"{home}, {days} days: {name}")
            lives[name] = live(home, 1, days, plan)
        records += rows_of(f"{home}, {days} days", lives)
    return records


def rows_of(case: str, lives: dict[str, tuple[Household, list[Day]]]) -> list[Record]:
    """Return the rows of a home, whose lives are by the names of plans; "due" is ours."""

    def row(figure: str, unit: str, of: dict[str, float], aim: float | None = None) -> Record:
        peers = tuple(PeerFigure(name, "", of[name]) for name in lives if name != "due")
        return Record(_TOPIC, case, figure, of["due"], unit, Better.LOWER, aim, peers)

    ways = {name: way_of(days) for name, (_, days) in lives.items()}
    worst = {name: dirtiest(*each) for name, each in lives.items()}
    means = {name: mean_dirt(*each) for name, each in lives.items()}
    saved = 100.0 * (1.0 - ways["due"] / ways[_FIXED])
    household, days = lives["due"]
    times = ", ".join(f"{name} {times_cleaned(days, name)}" for name in household.names)
    return [
        row("way", "m", ways),
        Record(_TOPIC, case, "less way than by the fixed plan", saved, "%", Better.HIGHER, _LESS),
        row("dirt of the dirtiest room before its clean", "g/m2", worst, 1.1 * worst[_FIXED]),
        row("dirt of all floor, mean", "g/m2", means),
        Record(
            _TOPIC,
            case,
            f"cleans of rooms ({times})",
            float(sum(len(day.rooms) for day in days)),
            "",
            Better.LOWER,
        ),
    ]


def way_of(days: Sequence[Day]) -> float:
    """Return the way of all days, m."""
    return sum(day.way for day in days)


def times_cleaned(days: Sequence[Day], room: str) -> int:
    """Return on how many days a room was cleaned."""
    return sum(room in day.rooms for day in days)


def dirtiest(household: Household, days: Sequence[Day]) -> float:
    """Return the dirt of the dirtiest room at its dirtiest on a day, mean over the days, g/m2."""
    counted = days[_LEARNING:]
    return sum(max(day.before.values()) for day in counted) / len(counted)


def mean_dirt(household: Household, days: Sequence[Day]) -> float:
    """Return the mean over all floor and time, g/m2."""
    whole = sum(household.areas.values())
    total = 0.0
    counted = days[_LEARNING:]
    for day, following in pairwise(counted):
        for name, area in household.areas.items():
            total += 0.5 * (day.after[name] + following.before[name]) * area
    return total / whole / max(len(counted) - 1, 1)
