"""Whether floors are cut into rooms as people cut them, and how long it takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import mean

from roomba.grid import OccupancyMap
from roomba.perception.rooms.rooms import segment
from roomba_bench.bench import Bench
from roomba_bench.contestants import Local
from roomba_bench.peers.protocol import Work, once
from roomba_bench.record import Better, PeerFigure, Record
from roomba_bench.rooms.baseline import distance_split
from roomba_bench.rooms.furniture import furnished
from roomba_bench.rooms.picture import write_picture
from roomba_bench.rooms.truth import KnownRooms, RoomLabels, known_homes, known_maps, score
from roomba_bench.rounds import milliseconds

_TOPIC = "rooms"
_HOME_AIM = 0.9
_MAPS_AIM = 0.97
_TIME_AIM = 200.0 / 300.0
"""ms a square metre, at 5 cm a cell."""
_SEEDS = 5
_BASELINE = "distance split"

WAYS: dict[str, Callable[[OccupancyMap], RoomLabels]] = {
    "ours": lambda occupancy: segment(occupancy).labels,
    _BASELINE: distance_split,
}


def measure(bench: Bench) -> list[Record]:
    """Return all rows of the topic, and write a picture of each floor."""
    homes = [known for known in known_homes() if known.count > 1]
    plain = [known for known in known_homes() if known.count == 1]
    maps = list(known_maps(bench.maps)) if bench.maps else []
    records = []
    for known in (*plain, *homes, *maps):
        aim = None if known in maps else _HOME_AIM
        records += _floor_rows(bench, known, aim)
    if maps:
        records += _mean_rows(f"mean of {len(maps)} maps", maps, _MAPS_AIM)
    bench.say("random furniture")
    for what, floors in (("homes", homes), ("maps", maps)):
        if floors:
            more = [furnished(known, seed) for known in floors for seed in range(_SEEDS)]
            case = f"mean of {len(floors)} {what}, each {_SEEDS} times with random furniture"
            records += _mean_rows(case, more, None)
    return records


def _floor_rows(bench: Bench, known: KnownRooms, aim: float | None) -> list[Record]:
    """Return the rows of a floor, and write its picture."""
    case = f"{known.name}, {known.area:.0f} m², {known.count} rooms"
    bench.say(case)
    found = {name: way(known.map) for name, way in WAYS.items()}
    write_picture(bench.pictures / f"rooms-{known.name}.png", known, found)
    scores = [score(known, labels) for labels in found.values()]
    return [
        _record(case, "recall", [one.recall for one in scores], aim),
        _record(case, "precision", [one.precision for one in scores], aim),
        _record(case, "rooms told apart", [one.told_apart for one in scores], None, "rooms"),
        _record(case, "rooms in all", [one.segments for one in scores], None, "rooms"),
        _time_row(bench, case, known),
    ]


def _mean_rows(case: str, floors: Sequence[KnownRooms], aim: float | None) -> list[Record]:
    """Return mean scores over several floors, each counted the same."""
    scores = [[score(known, way(known.map)) for known in floors] for way in WAYS.values()]
    apart = [
        [one.told_apart / known.count for one, known in zip(of_way, floors, strict=True)]
        for of_way in scores
    ]
    return [
        _record(case, "recall", [mean(one.recall for one in of_way) for of_way in scores], aim),
        _record(
            case, "precision", [mean(one.precision for one in of_way) for of_way in scores], aim
        ),
        _record(case, "share of rooms told apart", [mean(shares) for shares in apart], None),
    ]


def _record(
    case: str, figure: str, values: Sequence[float], aim: float | None, unit: str = ""
) -> Record:
    """Return a row; ``values`` are ours and the baseline's."""
    peers = (PeerFigure(_BASELINE, "", float(values[1])),)
    return Record(_TOPIC, case, figure, float(values[0]), unit, Better.HIGHER, aim, peers)


def _time_row(bench: Bench, case: str, known: KnownRooms) -> Record:
    ours, baseline = bench.compete([_contestant(name, known.map) for name in WAYS])
    time = None if ours.rate is None else milliseconds(ours.rate)
    cells = known.area * (0.05 / known.map.frame.resolution) ** 2
    aim, peers = _TIME_AIM * cells, (baseline.figure(milliseconds),)
    return Record(_TOPIC, case, "time", time, "ms", Better.LOWER, aim, peers, ours.error)


def _contestant(name: str, occupancy: OccupancyMap) -> Local:
    return Local(name, lambda: Work(once(lambda: WAYS[name](occupancy))))
