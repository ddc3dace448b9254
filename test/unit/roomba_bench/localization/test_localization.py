"""Drives, kidnappings, rows and pictures of the localization's benchmark."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from roomba.configuration.robot import RobotConfig
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.localization.estimate import Knowledge
from roomba_bench.bench import Bench
from roomba_bench.localization.drive import STATES, Drive, Errors, Task, Wander, drive, errors
from roomba_bench.localization.kidnaps import TIME, Manner, Try, kidnap
from roomba_bench.localization.kidnaps import Task as KidnapTask
from roomba_bench.localization.peers import Followed, ScannedDrive, match_row, surfaces
from roomba_bench.localization.plot import plot_drive, plot_spread
from roomba_bench.localization.robot import Spots, home_named, with_closed_door
from roomba_bench.localization.rows import drive_rows, figures, kidnap_rows
from roomba_bench.record import Record
from roomba_bench.rounds import Pace

SHORT = Task("studio", 3, 12.0)


@pytest.fixture(scope="module")
def scanned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, Path]:
    path = tmp_path_factory.mktemp("drive") / "scans.npz"
    return drive(replace(SHORT, scans=path, scan_seconds=6.0)), path


def value(records: list[Record], figure: str) -> float | None:
    [record] = [record for record in records if record.figure == figure]
    return record.value


def test_a_drive_goes_somewhere_and_is_the_same_for_the_same_seed(
    scanned: tuple[Drive, Path],
) -> None:
    first, _ = scanned
    again = drive(SHORT)
    assert first.distance > 1.0
    assert len(first.ours) == len(first.states) == pytest.approx(12.0 * 20, abs=1)
    assert np.array_equal(first.ours, again.ours)
    assert not np.array_equal(first.ours, drive(replace(SHORT, seed=4)).ours)


def test_what_the_lidar_saw_is_written_for_the_peers(scanned: tuple[Drive, Path]) -> None:
    _, path = scanned
    with np.load(path) as arrays:
        count = len(arrays["ranges"])
        assert count == pytest.approx(60, abs=1)
        assert arrays["stamps"][-1] == pytest.approx(6.0, abs=0.11)
        for name in ("truth", "believed", "reckoned", "odometry"):
            assert arrays[name].shape == (count, 3)
        assert errors(arrays["truth"], arrays["believed"])[:, 0].max() < 0.05


def test_a_match_is_timed_and_peers_that_are_missing_are_named(
    scanned: tuple[Drive, Path], tmp_path: Path
) -> None:
    row = match_row(
        Bench(Pace(1, 0.0), tmp_path, peers=None), ScannedDrive("studio", "", scanned[1])
    )
    assert row.value is not None
    assert 0.0 < row.value < 1000.0
    assert [peer.value for peer in row.peers] == [None, None]


def test_the_wanderer_turns_to_where_there_is_room_and_backs_off() -> None:
    ranges = np.full(360, 0.3, np.float32)
    ranges[60:121] = 4.0  # open to the left alone
    wander = Wander(np.random.default_rng(0))
    assert wander.tick(0.0, 0.0, ranges, touches=False).linear < 0.0
    turning = wander.tick(1.0, 0.0, ranges, touches=False)
    assert (turning.linear, turning.angular > 0.0) == (0.0, True)
    going = wander.tick(2.0, 0.5 * math.pi, ranges, touches=False)
    assert going.linear > 0.0
    assert wander.tick(2.1, 0.5 * math.pi, ranges, touches=True).linear < 0.0


def test_spots_can_be_reached_and_are_not_on_stairs() -> None:
    home = home_named("family")
    spots = Spots(home, RobotConfig().body.radius)
    random = np.random.default_rng(1)
    for _ in range(500):
        spot = spots.random(random)
        assert not any(area.contains(spot.x, spot.y) for area in home.stairs)
        row, column = home.frame.cell_of(spot.x, spot.y)
        assert not home.map.solid[row - 3 : row + 4, column - 3 : column + 4].any()


def test_a_door_is_shut_that_the_map_shows_open() -> None:
    home = home_named("flat")
    shut = with_closed_door(home, np.random.default_rng(0))
    assert np.count_nonzero(shut.solid) > np.count_nonzero(home.solid)
    assert np.array_equal(shut.map.values, home.map.values)
    assert with_closed_door(home_named("empty"), np.random.default_rng(0)).name == "empty"


@pytest.mark.parametrize("manner", Manner)
def test_a_robot_that_was_carried_away_is_watched(manner: Manner) -> None:
    tries = kidnap(KidnapTask("studio", manner, 0, 2))
    assert len(tries) == 2
    assert all(each.noticed <= each.found for each in tries)
    assert tries == kidnap(KidnapTask("studio", manner, 0, 2))


def some_drive(off: Errors, states: list[Knowledge]) -> Drive:
    numbers = np.array([STATES.index(state) for state in states], np.int8)
    return Drive(SHORT, off, 10.0 * off, 20.0 * off, numbers, 5.0)


def test_errors_wrap_around() -> None:
    [[away, turn]] = errors(np.array([[1.0, 2.0, 3.1]]), np.array([[1.3, 2.4, -3.1]]))
    assert (away, turn) == (pytest.approx(0.5), pytest.approx(2.0 * math.pi - 6.2, abs=1e-5))


def test_rows_of_drives_count_all_ticks() -> None:
    off = np.array([[0.01, 0.1], [0.02, 0.2], [0.2, 0.3], [0.4, 0.4]], np.float32)
    states = [Knowledge.KNOWN, Knowledge.KNOWN, Knowledge.KNOWN, Knowledge.LOST]
    rows = drive_rows("home", [some_drive(off, states), some_drive(off, states)])
    assert value(rows, "position error, median") == pytest.approx(110.0)
    assert value(rows, "heading error, median") == pytest.approx(math.degrees(0.25))
    assert value(rows, "time KNOWN") == 75.0
    assert value(rows, "time LOST") == 25.0
    assert value(rows, "more than 15 cm off while KNOWN") == 2.0
    assert "time ROUGH" not in [row.figure for row in rows]
    assert [peer.value for peer in rows[0].peers] == pytest.approx([1100.0, 2200.0])


def test_rows_of_kidnappings_do_not_hide_those_that_failed() -> None:
    tries = [Try(1.0, 0.1, False)] * 9 + [Try(math.inf, 0.1, True)]
    rows = kidnap_rows("home", Manner.SILENT, tries)
    assert value(rows, f"KNOWN and right within {TIME:.0f} s") == 90.0
    assert value(rows, "until KNOWN and right, median") == 1.0
    assert value(rows, "KNOWN while wrong") == 1.0
    [late] = [row for row in rows if row.figure == "until KNOWN and right, 95th percentile"]
    assert (late.value, late.unit) == (TIME, "s or more")


def test_surfaces_run_between_free_and_solid_cells() -> None:
    frame = GridFrame(0.1, 1.0, 2.0, 4, 5)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[1:-1, 1:-1] = FREE
    points = surfaces(OccupancyMap(frame, values))
    assert len(points) == 5 * 2 * (2 + 3)
    x, y = points.T
    on_side = np.isclose(x, 1.1) | np.isclose(x, 1.4) | np.isclose(y, 2.1) | np.isclose(y, 2.3)
    assert on_side.all()
    assert (x.min(), x.max()) == (pytest.approx(1.1), pytest.approx(1.4))


def test_pictures_are_written(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    off = np.abs(random.normal(0.0, 0.01, (100, 2))).astype(np.float32)
    names = ("ours", "some peer 1.0", "wheels and gyro", "wheels alone")
    followed = Followed(np.arange(100) / 10.0, dict.fromkeys(names, off), ())
    assert figures(off)[0] > 0.0
    plot_drive(tmp_path / "new" / "drive.png", "a home", followed)
    plot_spread(tmp_path / "spread.png", {"one": off, "other": 0.0 * off}, [followed])
    for path in (tmp_path / "new" / "drive.png", tmp_path / "spread.png"):
        with Image.open(path) as picture:
            assert picture.width > 800
