"""The rows of cleans in the table, and their pictures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from roomba.grid import GridFrame
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba_bench.bench import Bench
from roomba_bench.coverage.aims import aims_of
from roomba_bench.coverage.clean import Clean, Task
from roomba_bench.coverage.floor import Patch, reachable
from roomba_bench.coverage.peers import Driven, Planned
from roomba_bench.coverage.plot import plot_over_time, plot_way
from roomba_bench.coverage.recorded import recorded
from roomba_bench.coverage.rows import (
    Case,
    broken_row,
    changed_rows,
    ideal_rows,
    noisy_rows,
    over_time_rows,
)
from roomba_bench.record import Record
from roomba_bench.rounds import QUICK
from roomba_bench.topics import coverage

NO_POSES = np.zeros((0, 4))
CLEAN = Clean(
    task=Task("apartment"),
    outcome=CleanOutcome.COMPLETED,
    message="",
    is_docked=True,
    area=70.0,
    share=0.998,
    exact=0.991,
    path=420.0,
    turning=550.0,
    hits=0,
    seconds=1980.0,
    setup=0.2,
    wall=1.1,
    cpu=0.9,
    planning=0.15,
    plans=2,
    told=((MissReason.LEFT_OVER, Patch(0.05, 1.0, 2.0)),),
    missed=(Patch(0.05, 1.0, 2.0),),
    wrong=0.0,
)
CASE = Case("apartment", "apartment", aims_of("apartment"))
LOST = replace(
    CLEAN,
    task=Task("apartment", 7),
    outcome=CleanOutcome.LOST,
    message="the robot does not know where it is",
    is_docked=False,
    share=0.6,
    wrong=12.0,
    what="sofa moved",
)


def figures(rows: list[Record]) -> dict[str, Record]:
    return {row.figure: row for row in rows}


def test_aims_stand_beside_figures_and_peers() -> None:
    lanes = Driven("boustrophedon, in order", 94.0, 95.0, 1.6, 1e3, 0.0, 44.0, False, NO_POSES)
    random = Driven("random bounce", 26.0, 27.0, 1.2, 900.0, 320.0, 34.0, True, NO_POSES)
    plan = Planned(0.999, 1.18, 520.0, 0.15, np.zeros((0, 2)))
    rows = figures(ideal_rows(CASE, CLEAN, plan, [lanes, random], recorded("apartment")))
    assert rows["coverage"].aim == 99.5
    assert rows["coverage"].is_reached
    noted = rows["coverage"].peers[2]
    assert [peer.value for peer in rows["coverage"].peers[:3]] == [94.0, 26.0, 92.1]
    assert noted.version == "as recorded, planned only"
    exact = rows["coverage, exact to the millimetre"]
    assert exact.value == pytest.approx(99.1)
    assert [peer.value for peer in exact.peers] == [95.0, 27.0]
    ratio = rows["way by (area by 0.20 m)"]
    assert ratio.value == pytest.approx(1.2)
    assert (ratio.aim, ratio.is_reached) == (1.22, True)
    assert [peer.name for peer in ratio.peers[:2]] == [lanes.name, noted.name]
    assert [peer.value for peer in rows["hits"].peers] == [0.0, 320.0]
    assert rows["planning, CPU"].value == pytest.approx(150.0)
    assert rows["closed loop, CPU"].is_reached
    assert rows["docked and done"].value == 100.0
    assert rows[f"missed, as the robot tells it: {MissReason.LEFT_OVER.value}"].value == 0.05
    assert rows["missed in truth"].value == pytest.approx(0.14)


def test_planner_that_failed_is_named() -> None:
    case = Case("map lab_ipa", "lab_ipa", aims_of("lab_ipa"))
    plan = Planned(0.999, 1.18, 520.0, 0.15, np.zeros((0, 2)))
    rows = figures(ideal_rows(case, CLEAN, plan, [], recorded("lab_ipa")))
    peers = rows["coverage"].peers
    assert [peer.error for peer in peers if peer.value is None] == ["it gave no way"]


def test_with_noise_the_worst_seed_counts() -> None:
    longer = replace(CLEAN, path=441.0, share=0.992, hits=2)
    rows = figures(noisy_rows(CASE, CLEAN, [CLEAN, longer]))
    assert rows["coverage, least"].value == pytest.approx(99.2)
    assert rows["coverage, least"].is_reached
    more = rows["way by (area by 0.20 m), most: above that with ideal sensors"]
    assert more.value == pytest.approx(0.06)
    assert more.is_reached
    assert rows["hits, most"].is_reached is False


def test_runs_that_fall_short_are_listed_with_their_seed() -> None:
    rows = changed_rows("apartment, moved furniture, 2 seeds", [CLEAN, LOST])
    by_figure = figures(rows)
    assert by_figure["docked and done"].value == 50.0
    assert by_figure["fell short"].value == 1.0
    assert by_figure["fell short without saying so"].value == 0.0
    wrong = by_figure["pose more than 15 cm off and taken for KNOWN, all runs together"]
    assert wrong.value == 12.0
    assert rows[-1].case == "apartment, moved furniture, seed 7 (sofa moved)"
    assert rows[-1].figure == "coverage, lost: the robot does not know where it is"
    assert rows[-1].is_reached is False


def test_silence_is_success_told_where_there_was_none() -> None:
    assert not CLEAN.is_silent(0.98)
    assert not LOST.is_silent(0.98)
    assert replace(CLEAN, is_docked=False).is_silent(0.98)
    missed = replace(CLEAN, share=0.9)
    assert missed.is_silent(0.98)
    assert not replace(missed, told=((MissReason.SHUT, Patch(6.5, 0, 0)),)).is_silent(0.98)


def test_rows_over_time_and_broken_ones() -> None:
    rows = over_time_rows("apartment", (15, 30), (0.5, 0.9), {"random bounce": (0.2, 0.4)})
    assert [row.figure for row in rows] == ["coverage after 15 min", "coverage after 30 min"]
    assert rows[1].ratio(rows[1].peers[0]) == pytest.approx(2.25)
    assert broken_row("flat", ValueError("no")).error == "ValueError: no"


def test_maps_of_the_folder_follow_the_homes(tmp_path: Path) -> None:
    for name in ("apartment", "small_house"):
        (tmp_path / f"{name}.yaml").touch()
    places = coverage.places_of(Bench(QUICK, tmp_path, tmp_path), coverage.QUICK)
    assert [place.case.title for place in places] == [*coverage.QUICK.homes, "map small_house"]
    assert places[-1].case.aims.ratio == 1.17
    assert places[-1].folder == str(tmp_path)


def test_pictures_are_drawn(tmp_path: Path) -> None:
    solid = np.ones((20, 20), np.bool_)
    solid[1:-1, 1:-1] = False
    floor = reachable(solid, GridFrame(0.05, 0.0, 0.0, 20, 20), (0.5, 0.5))
    time = np.arange(0.0, 60.0, 0.05)
    poses = np.column_stack([time, 0.5 + 0.3 * np.sin(time), 0.5 + 0.3 * np.cos(time), time])
    plot_over_time(tmp_path / "time.png", "room", floor, {"ours": poses, "other": poses}, 99.5)
    plot_way(tmp_path / "way.png", "room", floor, solid, poses)
    for name in ("time.png", "way.png"):
        with Image.open(tmp_path / name) as picture:
            assert picture.width > 600
            assert len(set(picture.convert("RGB").resize((90, 90)).tobytes())) > 20
