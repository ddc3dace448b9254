"""How true the maps are that the robot makes, what making them takes, and whether they will do."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import TypeVar

from roomba.commands.map.warm import warm_up
from roomba_bench.bench import Bench
from roomba_bench.mapping.cost import recorded, share_of_core, speed
from roomba_bench.mapping.explore import Explored, Task, clean, clean_unknown, explore
from roomba_bench.mapping.loop import loop
from roomba_bench.mapping.rows import (
    broken_row,
    clean_rows,
    core_row,
    explored_rows,
    loop_rows,
    newcomer_rows,
    seeds,
    speed_row,
)
from roomba_bench.record import Record
from roomba_bench.workers import Workers

_SHIPPED = ("flat", "studio", "family", "apartment", "empty", "lshape")
"""Shipped homes, without the hall: in a plane of 200 m the lidar mostly sees nothing."""
_TIMED = "flat"
_CLEANED = "flat"
_Done = TypeVar("_Done")


@dataclass(frozen=True)
class Extent:
    """How much is done: in which homes, of how many seeds, and rounds of what is timed."""

    homes: tuple[str, ...] = _SHIPPED
    seeds: int = 5
    rounds: int = 3


THOROUGH = Extent()
QUICK = Extent(seeds=1, rounds=1)


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic."""
    return measured(bench, QUICK if bench.is_quick else THOROUGH)


def measured(bench: Bench, extent: Extent) -> list[Record]:
    """Return the rows of homes and, if there is a folder of them, maps.

    What is timed comes first, while nothing else runs; then all else, on all cores.
    """
    warm_up()
    records = _timed_rows(bench, extent)
    with Workers() as pool:
        return records + _rest(bench, pool, extent)


def _timed_rows(bench: Bench, extent: Extent) -> list[Record]:
    bench.say(f"{_TIMED}, what mapping costs")
    drive = recorded(_TIMED, 0)
    core = min(share_of_core(drive) for _ in range(extent.rounds))
    rows = [core_row(_TIMED, core)]
    for home, folder in _places(bench, extent):
        bench.say(f"{home}, how fast it is explored")
        fastest = max(speed(home, 0, folder) for _ in range(extent.rounds))
        rows.append(speed_row(home, folder, fastest))
    return rows


def _rest(bench: Bench, pool: Executor, extent: Extent) -> list[Record]:
    places = _places(bench, extent)
    range_of_seeds = range(extent.seeds)
    explored = {
        place: [pool.submit(explore, Task(place[0], seed, place[1])) for seed in range_of_seeds]
        for place in places
    }
    looped = [pool.submit(loop, seed) for seed in range_of_seeds]
    records: list[Record] = []
    for (home, folder), futures in explored.items():
        case = seeds(home, folder, extent.seeds)
        bench.say(case)
        done, broken = results(futures, case)
        records += explored_rows(case, done, "" if folder else home) if done else []
        records += broken
        if home == _CLEANED and not folder:
            records += _clean_rows(bench, pool, done)
    bench.say("ring")
    loops, broken = results(looped, "ring")
    return records + (loop_rows(loops) if loops else []) + broken


def _places(bench: Bench, extent: Extent) -> list[tuple[str, str]]:
    """Return homes, and maps with their folder."""
    places = [(home, "") for home in extent.homes]
    if bench.maps is not None:
        names = [path.stem for path in sorted(bench.maps.glob("*.yaml"))]
        # The folder may have the reference maps, which are shipped homes as well.
        others = [name for name in names if name not in extent.homes]
        places += [(name, str(bench.maps.resolve())) for name in others]
    return places


def _clean_rows(bench: Bench, pool: Executor, done: Sequence[Explored]) -> list[Record]:
    """Clean the home by each map that was made of it, by the true one, and while it is mapped."""
    bench.say(f"{_CLEANED}, cleaned by its own map")
    own = [pool.submit(clean, each.task, each.made.occupancy) for each in done]
    true = [pool.submit(clean, each.task, None) for each in done]
    case = f"{_CLEANED}, cleaned by its own map"
    cleaned, broken = results(own, case)
    by_truth, broken_by_truth = results(true, f"{_CLEANED}, cleaned by the true map")
    rows = clean_rows(_CLEANED, cleaned, by_truth) if cleaned and by_truth else []
    unknown = [pool.submit(clean_unknown, each.task) for each in done]
    new, broken_new = results(unknown, f"{_CLEANED}, cleaned while it is mapped")
    if new and cleaned:
        rows += newcomer_rows(_CLEANED, new, done, cleaned)
    return rows + broken + broken_by_truth + broken_new


def results(futures: Sequence[Future[_Done]], case: str) -> tuple[list[_Done], list[Record]]:
    """Return the results, and a row for each one that failed."""
    done: list[_Done] = []
    broken: list[Record] = []
    for seed, future in enumerate(futures):
        try:
            done.append(future.result())
        except Exception as error:
            broken.append(broken_row(f"{case}: seed {seed}", error))
    return done, broken
