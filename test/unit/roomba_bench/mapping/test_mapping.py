"""The ring, what mapping costs, and the rows of the mapping's benchmark."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from roomba.commands.map.map_error import MapError
from roomba.commands.map.runs import Drawn
from roomba.commands.trials.warm import closet
from roomba.geometry import Pose
from roomba.grid import FREE, GridFrame, OccupancyMap
from roomba.perception.matching.scan_view import LidarModel
from roomba_bench.bench import Bench
from roomba_bench.mapping import explore as exploring
from roomba_bench.mapping import loop as looping
from roomba_bench.mapping.cost import Heard, Recorded, share_of_core
from roomba_bench.mapping.explore import Cleaned, Explored, Task
from roomba_bench.mapping.loop import LONG, SHORT, WAY, Looped, loop, ring
from roomba_bench.mapping.rows import (
    BLIND,
    clean_rows,
    core_row,
    explored_rows,
    loop_rows,
    newcomer_rows,
    seeds,
    speed_row,
)
from roomba_bench.record import Better, Record
from roomba_bench.rounds import Pace
from roomba_bench.topics import mapping
from roomba_bench.topics.mapping import Extent, measured, results

NOTHING = OccupancyMap(GridFrame(0.05, 0.0, 0.0, 1, 1), np.full((1, 1), FREE, np.int8))


def _error(walls: float, floor: float, doubled: int, turned: float = 0.0) -> MapError:
    return MapError(walls, 0.001, floor, doubled, 0, (0.0, 0.0), turned, 0.0, 0.0)


def _explored(seed: int, seconds: float, ours: MapError, theirs: MapError) -> Explored:
    made, blind = Drawn(NOTHING, ours, 0.01, 0.001), Drawn(NOTHING, theirs, 0.4, 0.3)
    return Explored(Task("flat", seed), made, blind, seconds, 70.0, 0, seed == 0)


def _row(records: list[Record], figure: str) -> Record:
    [record] = [record for record in records if record.figure == figure]
    return record


def test_of_the_seeds_the_worst_counts() -> None:
    done = [
        _explored(0, 300.0, _error(0.99, 0.99, 0), _error(0.6, 0.8, 100, 0.02)),
        _explored(1, 350.0, _error(0.98, 0.995, 3, -0.001), _error(0.5, 0.9, 50)),
    ]
    rows = explored_rows("flat, 2 seeds", done, "flat")
    walls = _row(rows, "walls within 5 cm")
    assert walls.value == pytest.approx(98.0)
    assert walls.is_reached
    [peer] = walls.peers
    assert peer.name == BLIND
    assert peer.value == pytest.approx(50.0)
    assert _row(rows, "free floor, IoU").value == pytest.approx(99.0)
    doubled = _row(rows, "walls mapped twice")
    assert (doubled.value, doubled.peers[0].value) == (3.0, 100.0)
    assert doubled.is_reached is False
    turned = _row(rows, "map turned by")
    assert turned.value == pytest.approx(math.degrees(0.001))
    longest = _row(rows, "robot time, longest")
    assert (longest.value, longest.aim, longest.is_reached) == (350.0, 360.0, True)
    assert _row(rows, "docked, and says that it saw all").value == 50.0
    # Elsewhere nothing was promised of the time.
    assert _row(explored_rows("x", done, ""), "robot time, longest").aim is None


def test_a_clean_of_an_unknown_home_is_beside_one_that_was_explored_first() -> None:
    good = _error(1.0, 1.0, 0)
    explored = [_explored(seed, 300.0, good, good) for seed in range(2)]
    later = [Cleaned(0.997, 1500.0, True), Cleaned(0.995, 2100.0, True)]
    new = [Cleaned(0.996, 2400.0, True), Cleaned(0.985, 2700.0, True)]
    rows = newcomer_rows("flat", new, explored, later)
    least = _row(rows, "coverage of the true floor, least")
    assert (least.value, least.is_reached) == (pytest.approx(98.5), False)
    assert least.peers[0].value == pytest.approx(99.5)
    taken = _row(rows, "robot time, mean")
    assert (taken.value, taken.peers[0].value) == (pytest.approx(42.5), pytest.approx(35.0))
    assert _row(rows, "home and done").value == 100.0


def test_rows_of_the_ring_of_cleans_and_of_costs() -> None:
    loops = [
        Looped(105.0, end, 0.02, 0.4, _error(1.0, 1.0, 0), _error(0.3, 0.6, 9), NOTHING)
        for end in (0.01, 0.06)
    ]
    end = _row(loop_rows(loops), "end off its place")
    assert end.value == pytest.approx(60.0)
    assert end.is_reached is False
    assert end.peers[0].value == pytest.approx(400.0)
    cleans = clean_rows(
        "flat",
        [Cleaned(0.995, 1800.0, True), Cleaned(0.985, 2400.0, False)],
        [Cleaned(1.0, 1800.0, True)],
    )
    share = _row(cleans, "coverage of the true floor, least")
    assert share.value == pytest.approx(98.5)
    assert share.is_reached is False
    assert share.peers[0].value == pytest.approx(100.0)
    assert _row(cleans, "home and done").value == pytest.approx(50.0)
    core, speed = core_row("flat", 0.05), speed_row("flat", "", 250.0)
    assert core.value == pytest.approx(5.0)
    assert core.better is Better.LOWER
    assert core.is_reached
    assert (speed.value, speed.better, speed.is_reached) == (250.0, Better.HIGHER, True)


def test_names_of_cases() -> None:
    assert seeds("flat", "", 1) == "flat, 1 seed"
    assert seeds("lab", "/maps", 5) == "map lab, 5 seeds"


def test_the_ring_is_a_corridor_of_a_hundred_metres() -> None:
    home = ring(0)
    free = home.map.values == FREE
    frame = home.frame
    for along in np.arange(0.0, WAY, 0.5):
        assert free[frame.cell_of(*looping.middle(float(along)))]
    # Its middle is not free, and it is as wide as it should be, doorways apart.
    assert not free[frame.cell_of(LONG / 2.0, SHORT / 2.0)]
    area = np.count_nonzero(free) * frame.resolution**2
    assert 1.6 * WAY < area < 1.6 * WAY + 40.0
    assert not np.array_equal(free, ring(1).map.values == FREE)


def test_the_way_along_the_ring_is_found_from_any_pose() -> None:
    for along in (0.5, 29.0, 35.0, 62.0, 99.0):
        x, y = looping.middle(along)
        assert looping.along_of(Pose(x + 0.1, y - 0.1)) == pytest.approx(along, abs=0.15)
    assert looping.middle(WAY + 3.0) == pytest.approx(looping.middle(3.0))


@pytest.mark.thorough
def test_a_short_ring_closes(monkeypatch: pytest.MonkeyPatch) -> None:
    corners = np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 5.0], [0.0, 5.0], [0.0, 0.0]])
    for name, value in {"LONG": 6.0, "SHORT": 5.0, "WAY": 22.0, "_CORNERS": corners}.items():
        monkeypatch.setattr(looping, name, value)
    monkeypatch.setattr(looping, "_BEGIN", 2.0)
    done = loop(0)
    assert done.way == pytest.approx(24.0, abs=0.1)
    assert done.end < 0.05
    assert done.error.walls > 0.97
    assert done.error.doubled == 0
    assert done.end_blind > done.end


def test_time_is_counted_by_the_robot_s_clock() -> None:
    lidar = LidarModel.all_around(360, 0.15, 12.0)
    ranges = np.full(360, 2.0, np.float32)
    heard = [Heard(0.05 * n, Pose(), 0.0, ranges if n % 2 == 0 else None) for n in range(41)]
    share = share_of_core(Recorded(heard, lidar, Pose()))
    assert 0.0 < share < 10.0
    slower = [Heard(10.0 * each.stamp, each.odometry, 0.0, each.ranges) for each in heard]
    assert share_of_core(Recorded(slower, lidar, Pose())) < share


def test_a_clean_by_the_robot_s_own_map_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exploring, "home_named", lambda name, folder: closet())
    home = closet()
    done = exploring.clean(Task("closet", 1), home.map)
    assert done.is_home_and_done
    assert done.share > 0.97
    half = home.map.values.copy()
    half[:, 30:] = 100
    assert exploring.clean(Task("closet", 1), OccupancyMap(home.frame, half)).share < 0.7


def test_what_breaks_is_a_row_and_the_others_still_come() -> None:
    good: Future[int] = Future()
    good.set_result(7)
    bad: Future[int] = Future()
    bad.set_exception(RuntimeError("it broke"))
    done, broken = results([good, bad], "case")
    assert done == [7]
    assert [(row.case, row.value) for row in broken] == [("case: seed 1", None)]
    assert "it broke" in broken[0].error


class _Pool:
    """Does everything at once, here."""

    def __init__(self, *_: object, **__: object) -> None:
        pass

    def __enter__(self) -> _Pool:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future


def test_homes_and_maps_of_a_folder_are_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("flat", "lab"):
        (tmp_path / f"{name}.yaml").write_text("", encoding="utf-8")
    asked: list[Task] = []

    def explored(task: Task) -> Explored:
        asked.append(task)
        if task.home == "lab":
            raise ValueError("no map")
        return _explored(task.seed, 300.0, _error(0.99, 0.99, 0), _error(0.6, 0.8, 100))

    looped = Looped(105.0, 0.01, 0.02, 0.4, _error(1.0, 1.0, 0), _error(0.3, 0.6, 9), NOTHING)
    monkeypatch.setattr(mapping, "Workers", _Pool)
    monkeypatch.setattr(mapping, "warm_up", lambda: None)
    monkeypatch.setattr(mapping, "explore", explored)
    monkeypatch.setattr(mapping, "clean", lambda task, known: Cleaned(1.0, 1800.0, True))
    monkeypatch.setattr(mapping, "clean_unknown", lambda task: Cleaned(0.99, 2000.0, True))
    monkeypatch.setattr(mapping, "loop", lambda seed: looped)
    monkeypatch.setattr(mapping, "recorded", lambda home, seed: None)
    monkeypatch.setattr(mapping, "share_of_core", lambda drive: 0.05)
    monkeypatch.setattr(mapping, "speed", lambda home, seed, folder: 250.0)
    bench = Bench(Pace(1, 0.1), tmp_path, tmp_path)
    records = measured(bench, Extent(("flat",), seeds=2, rounds=1))
    assert asked == [
        Task("flat", 0),
        Task("flat", 1),
        Task("lab", 0, str(tmp_path)),
        Task("lab", 1, str(tmp_path)),
    ]
    cases = list(dict.fromkeys(record.case for record in records))
    assert cases == [
        "flat, in real time, scans of 10 Hz",
        "flat, headless",
        "map lab, headless",
        "flat, 2 seeds",
        "flat, cleaned by its own map, 2 seeds",
        "flat, cleaned while it is mapped, 2 seeds",
        "map lab, 2 seeds: seed 0",
        "map lab, 2 seeds: seed 1",
        "ring of 100 m, driven around once, 2 seeds",
    ]
