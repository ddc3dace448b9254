"""Any number of logs as one drive: in the order of time, given in any order."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives.made_logs import (
    BEGAN,
    LASER,
    PERIOD,
    Item,
    at,
    changed,
    drive,
    write_bag,
    write_bag_2,
    write_carmen,
)

from roomba.geometry import Pose
from roomba.perception.matching.mounts import UPSIDE_DOWN, Mount
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.drives.sweeps import Sweep
from roomba.recordings.readings import LidarScan, LogError, Odometry, Reading

SECONDS = 6.0


def read(paths: Sequence[Path], wanted: Wanted | None = None) -> tuple[list[Reading], LoggedDrive]:
    with LoggedDrive(paths, wanted) as recorded:
        return list(recorded.readings()), recorded


def mount_of(readings: Sequence[Reading]) -> list[float]:
    [mount] = {
        tuple(value.lidar.mount.tolist())
        for _, value, _ in readings
        if isinstance(value, LidarScan)
    }
    return list(mount)


def assert_whole(readings: Sequence[Reading], items: Sequence[Item], within: float = 1e-6) -> None:
    """All items are there, in the order of time, at the times at which they were measured."""
    assert [stamp for stamp, *_ in readings] == sorted(stamp for stamp, *_ in readings)
    for type_, topic in ((Odometry, "/odom"), (LidarScan, "/scan")):
        stamps = [stamp for stamp, value, _ in readings if isinstance(value, type_)]
        expected = [item.stamp for item in items if item.topic == topic]
        assert stamps == pytest.approx(expected, abs=within)


def test_odometry_comes_before_the_scan_of_its_time(tmp_path: Path) -> None:
    items = drive(SECONDS)
    readings, recorded = read([write_bag(tmp_path / "made.bag", items)])
    assert_whole(readings, items)
    assert [type(value) for _, value, _ in readings[:3]] == [Odometry, LidarScan, Odometry]
    assert recorded.counts.words == f"{len(items)} messages: all in order"
    assert recorded.notes == []
    assert mount_of(readings) == [LASER.x, LASER.y, LASER.theta]


def later(by: float) -> Callable[[int, Item], Item]:
    return lambda _, item: at(item, item.stamp + by)


@pytest.mark.parametrize(
    ("change", "told", "within"),
    [
        (lambda n, item: at(item, item.stamp if n % 7 else 0.0), "5 without a stamp", 0.03),
        (lambda n, item: at(item, item.stamp + (n % 6 == 3)), "5 of a clock that had jumped", 0.03),
        (lambda n, item: at(item, 0.0), "30 without a stamp", 0.03),
        (later(37.0), "all in order", 0.03),
    ],
)
def test_stamps_of_scans_that_cannot_be_true_are_mended(
    tmp_path: Path, change: Callable[[int, Item], Item], told: str, within: float
) -> None:
    items = drive(SECONDS)
    path = write_bag(tmp_path / "made.bag", changed(items, "/scan", change))
    readings, recorded = read([path])
    assert_whole(readings, items, within)
    assert told in recorded.counts.words


def test_another_clock_is_told_with_its_difference(tmp_path: Path) -> None:
    items = changed(drive(SECONDS), "/scan", later(-37.0))
    _, recorded = read([write_bag(tmp_path / "made.bag", items)])
    assert any("clock of /scan is -37.0 s off that of the odometry" in n for n in recorded.notes)


def played(items: Sequence[Item], rate: float) -> list[Item]:
    """Return what is recorded of items that are played at a rate."""
    return [
        replace(item, arrival=BEGAN + (item.stamp - BEGAN) / rate + 0.02 + 1e-4 * (n % 3))
        for n, item in enumerate(items)
    ]


@pytest.mark.parametrize("rate", [0.5, 0.97, 1.0, 2.0, 5.0])
def test_what_was_played_faster_or_slower_keeps_its_times_though_scans_begin_later(
    tmp_path: Path, rate: float
) -> None:
    items = [i for i in drive(30.0) if i.topic == "/odom" or i.stamp > BEGAN + 8.0]
    readings, recorded = read([write_bag(tmp_path / "made.bag", played(items, rate))])
    assert_whole(readings, items)
    assert recorded.notes == []


def test_scans_that_are_few_keep_their_times_beside_odometry_of_a_clock_that_drifts(
    tmp_path: Path,
) -> None:
    items = [i for n, i in enumerate(drive(60.0)) if i.topic == "/odom" or n % 15 == 1]
    readings, recorded = read([write_bag(tmp_path / "made.bag", played(items, 0.98))])
    assert_whole(readings, items)
    assert recorded.notes == []


def test_a_clock_that_is_slow_beside_that_of_the_odometry_is_evened_out(tmp_path: Path) -> None:
    items = drive(40.0)
    slow = changed(items, "/scan", lambda _, i: at(i, BEGAN + 0.98 * (i.stamp - BEGAN)))
    readings, recorded = read([write_bag(tmp_path / "made.bag", slow)])
    assert_whole(readings, items, 0.03)
    [note] = recorded.notes
    assert note.startswith("the clock of /scan is slow beside that of the odometry, by 2 %")


def test_messages_that_overtook_each_other_are_sorted(tmp_path: Path) -> None:
    items = drive(SECONDS)
    held_up = changed(
        items,
        "/scan",
        lambda n, item: replace(item, arrival=item.arrival + (1.7 * PERIOD if n % 5 == 2 else 0.0)),
    )
    readings, recorded = read([write_bag(tmp_path / "made.bag", held_up)])
    assert_whole(readings, items)
    assert "6 out of order (sorted)" in recorded.counts.words


def test_what_was_recorded_twice_counts_once(tmp_path: Path) -> None:
    items = drive(SECONDS)
    twice = [each for item in items for each in (item, replace(item, arrival=item.arrival + 0.01))]
    readings, recorded = read([write_bag(tmp_path / "made.bag", twice)])
    assert_whole(readings, items)
    assert f"{len(items)} of a time that another one has" in recorded.counts.words


def test_a_bag_that_was_written_topic_by_topic_is_in_order(tmp_path: Path) -> None:
    items = drive(SECONDS)
    readings, _ = read([write_bag(tmp_path / "a.bag", sorted(items, key=lambda i: i.topic))])
    assert_whole(readings, items)


def test_of_a_bag_of_whole_seconds_the_order_counts(tmp_path: Path) -> None:
    items = drive(SECONDS)
    cut = [replace(item, stamp=item.stamp // 1.0, arrival=item.arrival // 1.0) for item in items]
    readings, recorded = read([write_bag(tmp_path / "made.bag", cut)])
    assert_whole(readings, items)
    assert recorded.counts.by_order == recorded.counts.messages == len(items)
    assert recorded.counts.equal == recorded.counts.without == 0
    for topic in ("/odom", "/scan"):
        told = f"the times of {topic} do not tell its messages apart: they go by their order"
        assert sum(told in note for note in recorded.notes) == 1


def test_a_clock_that_was_set_back_on_the_way_goes_on(tmp_path: Path) -> None:
    items = drive(SECONDS)
    half = len(items) // 2
    again = [
        replace(item, stamp=item.stamp - 30.0, arrival=item.arrival - 30.0) for item in items[half:]
    ]
    readings, recorded = read([write_bag(tmp_path / "made.bag", items[:half] + again)])
    stamps = [stamp for stamp, *_ in readings]
    assert stamps == sorted(stamps)
    assert stamps[-1] - stamps[0] == pytest.approx(SECONDS - 0.5 * PERIOD, abs=0.2)
    poses = [value.pose.x for _, value, _ in readings if isinstance(value, Odometry)]
    assert poses == pytest.approx([item.value.x for item in items if isinstance(item.value, Pose)])
    assert any("clock was set back" in note for note in recorded.notes)


def test_several_logs_are_one_drive_in_whatever_order_they_are_named(tmp_path: Path) -> None:
    items = drive(SECONDS)
    parts = [items[:30], items[30:60], items[60:]]
    paths = [
        write_bag(tmp_path / "one.bag", parts[0]),
        write_bag_2(tmp_path / "two", parts[1]),
        write_bag(tmp_path / "three.bag", parts[2], with_mount=False),
    ]
    readings, recorded = read([paths[2], paths[0], paths[1]])
    assert_whole(readings, items)
    assert mount_of(readings) == [LASER.x, LASER.y, LASER.theta]
    assert recorded.notes == []


def test_odometry_and_scans_may_be_in_logs_of_their_own(tmp_path: Path) -> None:
    items = drive(SECONDS)
    paths = [
        write_bag(tmp_path / f"{name}.bag", [item for item in items if item.topic == f"/{name}"])
        for name in ("scan", "odom")
    ]
    readings, _ = read(paths)
    assert_whole(readings, items)


def test_logs_that_overlap_and_gaps_between_them_are_told(tmp_path: Path) -> None:
    items = drive(12.0)
    paths = [
        write_bag(tmp_path / "a.bag", [i for i in items if i.stamp < BEGAN + 4.0]),
        write_bag(tmp_path / "b.bag", [i for i in items if BEGAN + 3.0 <= i.stamp < BEGAN + 6.0]),
        write_bag(tmp_path / "c.bag", [i for i in items if i.stamp >= BEGAN + 8.95]),
    ]
    readings, recorded = read(paths)
    assert_whole(readings, [i for i in items if not 6.0 <= i.stamp - BEGAN < 8.95])
    assert recorded.notes == [
        "b.bag begins 0.9 s before the end of a.bag: what both have counts once",
        "c.bag begins 3.1 s after the end of b.bag",
    ]


def test_where_the_lidar_is_can_be_told(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(1.0))
    readings, _ = read([path], Wanted(laser=Pose(-0.04, 0.1, 1.5)))
    assert mount_of(readings) == [-0.04, 0.1, 1.5]


def test_a_lidar_that_is_known_on_the_robots_footprint_is_there(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(1.0), body="base_footprint")
    readings, recorded = read([path])
    assert mount_of(readings) == [LASER.x, LASER.y, LASER.theta]
    assert recorded.notes == ["'laser' is where it is on 'base_footprint', not on 'base_link'"]


def test_without_transforms_the_lidar_is_in_the_middle_and_that_is_told(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(1.0), with_mount=False)
    readings, recorded = read([path])
    assert mount_of(readings) == [0.0, 0.0, 0.0]
    assert any("taken to be in the middle" in note for note in recorded.notes)
    told, recorded = read([path], Wanted(laser=Pose(0.2)))
    assert mount_of(told) == [0.2, 0.0, 0.0]
    assert recorded.notes == []


def test_a_lidar_that_was_recorded_to_be_too_far_away_is_untold(tmp_path: Path) -> None:
    path = tmp_path / "made.log"
    lines = ["PARAM robot_frontlaser_offset 145 nohost 0"]
    lines += [f"FLASER 3 1.0 2.0 1.5 {x} 0 0 {x} 0 0 {10 + x} nohost {10 + x}" for x in range(9)]
    path.write_text("\n".join(lines))
    readings, recorded = read([path])
    assert mount_of(readings) == [0.0, 0.0, 0.0]
    assert not recorded.is_mount_told
    [note] = recorded.notes
    assert note.startswith("'FLASER' was recorded to be 145 m from 'base_link', as if that were in")
    assert "taken to be in the middle" in note
    told, recorded = read([path], Wanted(laser=Pose(0.145)))
    assert mount_of(told) == [0.145, 0.0, 0.0]
    assert recorded.notes == []


def lidar_of(readings: Sequence[Reading]) -> LidarModel:
    return next(value.lidar for _, value, _ in readings if isinstance(value, LidarScan))


def test_a_lidar_that_is_said_to_hang_upside_down_does(tmp_path: Path) -> None:
    """What was said counts, and not the transform in the recording."""
    path = write_bag(tmp_path / "made.bag", drive(1.0))
    steps = [
        lidar_of(read([path], Wanted(laser=LASER, laser_is_upside_down=hangs))[0]).step
        for hangs in (None, False, True)
    ]
    assert steps == pytest.approx([steps[0], steps[0], -steps[0]])


def test_what_a_drive_shows_of_its_lidar_is_taken_where_nothing_tells(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(1.0), with_mount=False)
    with LoggedDrive([path]) as recorded:
        before = lidar_of(list(recorded.readings()))
        assert not recorded.is_mount_told
        recorded.take_mount(Mount(Pose(theta=-1.0), UPSIDE_DOWN))
        recorded.take_sweep(Sweep(is_backwards=True, turn=0.2))
        after = lidar_of(list(recorded.readings()))
        [note] = recorded.notes
    assert after.mount.tolist() == [0.0, 0.0, -1.0]
    # turned over, and listed from the other end
    assert after.step == pytest.approx(before.step)
    assert after.time_increment == pytest.approx(0.2 * before.step / math.tau)
    assert "to look 57 degrees to the right and to hang upside down, as its scans show" in note


def test_where_a_lidar_was_told_to_be_it_stays(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(1.0))
    with LoggedDrive([path]) as recorded:
        list(recorded.readings())
        assert recorded.is_mount_told
        recorded.take_mount(Mount(Pose(theta=1.0)))
        assert mount_of(list(recorded.readings())) == [LASER.x, LASER.y, LASER.theta]


def test_what_is_refused_is_counted_once_though_a_drive_is_read_twice(tmp_path: Path) -> None:
    items = changed(drive(SECONDS), "/scan", lambda n, item: replace(item, value=np.empty(0)))
    with LoggedDrive([write_bag(tmp_path / "made.bag", items)]) as recorded:
        for _ in range(2):
            list(recorded.readings())
        assert list(recorded.refused_scans.values()) == [30]


def test_odometry_can_be_left_out_and_that_is_told(tmp_path: Path) -> None:
    with LoggedDrive([write_bag(tmp_path / "made.bag", drive(SECONDS))]) as recorded:
        list(recorded.readings())
        recorded.leave_odometry("it is in feet")
        kinds = {type(value) for _, value, _ in recorded.readings()}
        assert kinds == {LidarScan}
        assert not recorded.chosen.has_odometry
        assert "the odometry is not used, it goes by scans alone: it is in feet" in recorded.notes


def test_odometry_that_was_named_is_kept(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "made.bag", drive(SECONDS))
    for wanted, keeps in ((Wanted(odometry="/odom"), True), (Wanted(), False)):
        with LoggedDrive([bag], wanted) as recorded:
            assert recorded.keeps_odometry is keeps


def test_what_of_a_log_cannot_be_read_is_told_with_what_is_missing(tmp_path: Path) -> None:
    (tmp_path / "made.log").write_text("FLASER 3 1.0\nODOM 1 2 0 0 0 0 1 h 1\n", "utf-8")
    with pytest.raises(LogError, match=r"no lines tell any.*; 1 lines of made\.log cannot be read"):
        LoggedDrive([tmp_path / "made.log"])


def test_a_log_and_a_bag_of_the_same_drive_say_the_same(tmp_path: Path) -> None:
    items = drive(SECONDS)
    readings, recorded = read([write_carmen(tmp_path / "made.log", items)])
    scans = [item.stamp for item in items if item.topic == "/scan"]
    assert [stamp for stamp, value, _ in readings if isinstance(value, LidarScan)] == pytest.approx(
        scans
    )
    assert [stamp for stamp, value, _ in readings if isinstance(value, Odometry)] == pytest.approx(
        scans
    )
    assert mount_of(readings) == pytest.approx([LASER.x, LASER.y, LASER.theta], abs=1e-5)
    assert any(
        "--odom FLASER (30) is taken; there is ODOM (60) as well" in n for n in recorded.notes
    )
    readings, _ = read([write_carmen(tmp_path / "made.log", items)], Wanted(odometry="ODOM"))
    assert_whole(readings, items, 1e-5)


def test_what_is_refused_is_counted_with_its_first_reason(tmp_path: Path) -> None:
    items = changed(
        drive(SECONDS),
        "/scan",
        lambda n, item: replace(item, value=np.empty(0)) if n % 3 == 0 else item,
    )
    readings, recorded = read([write_bag(tmp_path / "made.bag", items)])
    [(what, count)] = recorded.refused_scans.items()
    assert (count, "got 0 from" in what) == (10, True)
    assert sum(isinstance(value, LidarScan) for _, value, _ in readings) == 20
    assert math.isclose(readings[-1].stamp, BEGAN + SECONDS - 0.5 * PERIOD, abs_tol=1e-6)
