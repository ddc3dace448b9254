"""Cleaning where the dirt is: a month by a fixed plan, and by what was learned of the rooms.

In each home the same dirt falls; each clean is driven, with noise. The first week, in which it is
learned, counts for the way, and not for how clean it is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from roomba_bench.bench import Bench
from roomba_bench.dirt.month import PLANS, Life, live
from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.workers import Workers

_TOPIC: Final = "dirt"
_HOMES: Final = ("flat", "family")
_SEEDS: Final = (1, 2, 3)
_DAYS, _QUICK_DAYS = 30, 10
_LEARNING: Final = 7
"""Days at the start that do not count for cleanliness."""
_LESS: Final = 30.0
"""% of the way that must be saved."""
_SAME: Final = 1.1
"""How many times dirtier rooms may get than by the fixed plan that is as clean."""
_OURS: Final = "due"
_FIXED: Final = "all rooms daily"


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    days = _QUICK_DAYS if bench.is_quick else _DAYS
    homes, seeds = (_HOMES[:1], _SEEDS[:1]) if bench.is_quick else (_HOMES, _SEEDS)
    records: list[Record] = []
    with Workers() as pool:
        for home in homes:
            case = f"{home}, {days} days, {len(seeds)} seeds"
            bench.say(case)
            begun = {
                plan: [pool.submit(live, home, seed, days, plan) for seed in seeds]
                for plan in PLANS
            }
            lives = {plan: [life.result() for life in each] for plan, each in begun.items()}
            records += rows_of(case, lives)
    return records


def rows_of(case: str, lives: Mapping[str, Sequence[Life]]) -> list[Record]:
    """Return the rows of a home; ``lives`` has by plan a life for each seed, and "due" is ours."""

    def row(
        figure: str, unit: str, of: Callable[[Life], float], same: float | None = None
    ) -> Record:
        means = {plan: sum(map(of, each)) / len(each) for plan, each in lives.items()}
        peers = tuple(PeerFigure(plan, "", means[plan]) for plan in lives if plan != _OURS)
        aim = None if same is None else same * means[_FIXED]
        return Record(_TOPIC, case, figure, means[_OURS], unit, Better.LOWER, aim, peers)

    ours = lives[_OURS]
    saved = [
        100.0 * (1.0 - one.way / other.way) for one, other in zip(ours, lives[_FIXED], strict=True)
    ]
    times = ", ".join(f"{name} {ours[0].times_cleaned(name)}" for name in ours[0].areas)
    return [
        row("way", "m", lambda life: life.way),
        Record(
            _TOPIC,
            case,
            "less way than by the fixed plan, the least of a seed",
            min(saved),
            "%",
            Better.HIGHER,
            _LESS,
        ),
        row(
            "dirt of the dirtiest room before its clean",
            "g/m2",
            lambda life: life.dirtiest(_LEARNING),
            _SAME,
        ),
        row("dirt of all floor, mean", "g/m2", lambda life: life.mean_dirt(_LEARNING), _SAME),
        row(
            f"cleans of rooms ({times})",
            "",
            lambda life: float(sum(map(life.times_cleaned, life.areas))),
        ),
    ]
