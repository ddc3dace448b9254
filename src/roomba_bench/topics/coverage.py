"""Whether all the floor gets clean, by how long a way, and what that takes to compute.

Everything is driven: closed loop with sensors, localization, planning and control.
"""

from __future__ import annotations

from concurrent.futures import Executor, Future
from dataclasses import dataclass, field, replace

import numpy as np

from roomba.commands.trials.warm import warm_up
from roomba.world.home.home import Home
from roomba_bench.bench import Bench
from roomba_bench.coverage.aims import COVERAGE, aims_of
from roomba_bench.coverage.changes import Change
from roomba_bench.coverage.clean import Clean, Task, clean, home_named, true_floor
from roomba_bench.coverage.floor import Reachable
from roomba_bench.coverage.lanes import Order
from roomba_bench.coverage.peers import (
    BOUNCE,
    Driven,
    context_of,
    drive_bounce,
    drive_lanes,
    name_of,
    planned,
    shares_at,
)
from roomba_bench.coverage.plot import OURS, plot_over_time, plot_way
from roomba_bench.coverage.recorded import recorded
from roomba_bench.coverage.rows import (
    Case,
    broken_row,
    changed_rows,
    ideal_rows,
    noisy_rows,
    over_time_rows,
)
from roomba_bench.record import PeerFigure, Record
from roomba_bench.workers import Workers

_SHIPPED = ("empty", "lshape", "apartment", "flat", "studio", "family")
"""Shipped homes, without the hall: a plane of 200 m is no floor to clean."""
_CHANGED = ("flat", "apartment", "family")
_DRAWN = "apartment"
_BOUNCED = (15, 30, 60, 120)
"""min; robots bounce for the last of these times."""
_BOUNCED_AS_RECORDED = (0.24, 0.39, 0.59, 0.81)
_BLIND = "it follows its lanes and does not go around what moves"


@dataclass(frozen=True)
class Extent:
    """How much is done: rounds of what is timed, seeds with noise, of bouncing, and of changes."""

    homes: tuple[str, ...] = _SHIPPED
    changed: tuple[str, ...] = _CHANGED
    rounds: int = 3
    seeds: int = 5
    bounces: int = 3
    changes: int = 20


THOROUGH = Extent()
QUICK = Extent(rounds=1, seeds=1, bounces=1, changes=3)


@dataclass(eq=False)
class _Place:
    """A home or map that is cleaned, and what is known of it by now."""

    case: Case
    folder: str
    ideal: Clean | None = None
    records: list[Record] = field(default_factory=list)


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic, and write the pictures."""
    return measured(bench, QUICK if bench.is_quick else THOROUGH)


def measured(bench: Bench, extent: Extent) -> list[Record]:
    """Return the rows of homes and, if there is a folder of them, maps.

    What is timed comes first, while nothing else runs; then all else, on all cores.
    """
    warm_up()
    places = places_of(bench, extent)
    for place in places:
        bench.say(f"{place.case.title}, ideal sensors, and peers")
        try:
            place.records += _timed_rows(bench, place, extent)
        except Exception as error:
            place.records.append(broken_row(place.case.title, error))
    with Workers() as pool:
        return _rest(bench, pool, places, extent)


def places_of(bench: Bench, extent: Extent) -> list[_Place]:
    places = [_Place(Case(home, home, aims_of(home)), "") for home in extent.homes]
    if bench.maps is not None:
        folder = str(bench.maps.resolve())
        names = [path.stem for path in sorted(bench.maps.glob("*.yaml"))]
        # The folder may have the reference maps, which are shipped homes as well.
        others = [name for name in names if name not in extent.homes]
        places += [_Place(Case(f"map {name}", name, aims_of(name)), folder) for name in others]
    return places


def _timed_rows(bench: Bench, place: _Place, extent: Extent) -> list[Record]:
    """Return the rows with ideal sensors; of the times the best of some rounds count."""
    task = Task(place.case.home, 0, place.folder, "ideal")
    rounds = [clean(task, keeps_poses=True) for _ in range(extent.rounds)]
    done = replace(
        rounds[0],
        cpu=min(one.cpu for one in rounds),
        wall=min(one.wall for one in rounds),
        setup=min(one.setup for one in rounds),
    )
    place.ideal = done
    home = home_named(task.home, task.folder)
    context = context_of(home)
    floor = true_floor(home, (context.staging.x, context.staging.y))
    plan = planned(home, context, floor, max(2, extent.rounds))
    orders = [] if home.moving else list(Order)
    left_out = [PeerFigure(name_of(order), error=_BLIND) for order in Order if home.moving]
    lanes = [drive_lanes(home, context.staging, floor, order) for order in orders]
    bounced = [drive_bounce(home, context.staging, floor, done.seconds, 0)]
    records = ideal_rows(place.case, done, plan, [*lanes, *bounced], recorded(task.home), left_out)
    if task.home == _DRAWN and not task.folder:
        records += _over_time(bench, home, floor, done, lanes, extent.bounces)
    return records


def _over_time(
    bench: Bench, home: Home, floor: Reachable, done: Clean, lanes: list[Driven], bounces: int
) -> list[Record]:
    """Return how coverage grows with time, ours and the peers', and draw it."""
    start = context_of(home).staging
    seconds = 60.0 * _BOUNCED[-1]
    bounced = [drive_bounce(home, start, floor, seconds, seed) for seed in range(bounces)]
    poses = {OURS: done.poses, **{one.name: one.poses for one in lanes}}
    poses[BOUNCE] = bounced[0].poses
    plot_over_time(
        bench.pictures / "coverage-time.png", f"{home.name}, ideal sensors", floor, poses, COVERAGE
    )
    solid = home.solid | home.drop
    way = f"{home.name}, as driven: {100.0 * done.share:.2f} %, {done.path:.0f} m"
    plot_way(bench.pictures / "coverage-way.png", way, floor, solid, done.poses)
    shares = np.array([shares_at(floor, one.poses, _BOUNCED) for one in bounced])
    peers = {one.name: shares_at(floor, one.poses, _BOUNCED) for one in lanes}
    peers[f"{BOUNCE}, mean of {bounces} seeds"] = shares.mean(axis=0).tolist()
    peers[f"{BOUNCE}, as recorded"] = list(_BOUNCED_AS_RECORDED)
    ours = shares_at(floor, done.poses, _BOUNCED)
    return over_time_rows(f"{home.name}, over time", _BOUNCED, ours, peers)


def _rest(bench: Bench, pool: Executor, places: list[_Place], extent: Extent) -> list[Record]:
    """Return all rows, once all that need not be timed is done."""
    noisy = [
        (place, [_order(pool, place, seed) for seed in range(extent.seeds)]) for place in places
    ]
    changes = {
        f"{home}, {change.value}, {extent.changes} seeds": [
            pool.submit(clean, Task(home, seed, change=change)) for seed in range(extent.changes)
        ]
        for home in extent.changed
        for change in Change
    }
    records: list[Record] = []
    for place, futures in noisy:
        bench.say(f"{place.case.title}, noise")
        records += place.records
        done, broken = _results(futures, f"{place.case.title}, noise")
        records += noisy_rows(place.case, place.ideal, done) if done else []
        records += broken
    for title, futures in changes.items():
        bench.say(title)
        done, broken = _results(futures, title)
        records += changed_rows(title, done) if done else []
        records += broken
    return records


def _order(pool: Executor, place: _Place, seed: int) -> Future[Clean]:
    return pool.submit(clean, Task(place.case.home, seed, place.folder))


def _results(futures: list[Future[Clean]], title: str) -> tuple[list[Clean], list[Record]]:
    """Return the cleans, and a row for each one that failed."""
    done: list[Clean] = []
    broken: list[Record] = []
    for seed, future in enumerate(futures):
        try:
            done.append(future.result())
        except Exception as error:
            broken.append(broken_row(f"{title}: seed {seed}", error))
    return done, broken
