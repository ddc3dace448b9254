"""A lidar is examined before its drive is mapped: wrong and missing values are found."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives import made_logs
from fixtures.drives.made_logs import (
    BEGAN,
    FARTHEST,
    LASER,
    PERIOD,
    Item,
    changed,
    ranges_from,
    write_bag,
)
from fixtures.drives.round_drive import round_drive
from fixtures.drives.turning_drive import (
    BEAM_TIME,
    SECONDS,
    half_circle,
    readings_of,
    turning_drive,
    turning_pose,
)

from roomba.commands.map.drive.looking import hidden_beams, look_at_drive
from roomba.commands.map.drive.mapped import MappedDrive, mapped_drive
from roomba.commands.map.drive.report import lines_of, summary_of
from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.geometry import Pose, wrap_angle
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import LidarScan, Turning


def mapped(
    path: Path, items: list[Item], wanted: Wanted | None = None, *, with_mount: bool = False
) -> MappedDrive:
    bag = write_bag(path / f"{id(items)}.bag", items, with_mount=with_mount)
    return mapped_drive([bag], wanted or Wanted(), lambda share, words: None)


def off(done: MappedDrive) -> float:
    """How far the odometry, which is right, was off the map at most, m."""
    corrected = summary_of(done, 1.0).corrected_m
    assert corrected is not None
    return corrected


def mount_of(done: MappedDrive) -> list[float]:
    assert done.replay.lidar is not None
    return list(done.replay.lidar.mount.tolist())


@pytest.mark.parametrize("hangs", [False, True])
def test_a_lidar_that_looks_back_is_taken_so_and_told(tmp_path: Path, hangs: bool) -> None:
    done = mapped(tmp_path, turning_drive(yaw=math.pi, hangs=hangs))
    x, y, theta = mount_of(done)
    assert (x, y) == (0.0, 0.0)
    assert abs(wrap_angle(theta - math.pi)) < 0.1
    # It is 0.2 m ahead of the middle, which is not found out.
    assert off(done) < 0.5
    [note] = [note for note in done.notes if "no transform" in note]
    assert "degrees to the" in note
    assert ("hang upside down" in note) is hangs
    assert "--laser X,Y,YAW[,upside-down] says where it is" in note


def test_one_that_hangs_upside_down_makes_no_mirrored_map(tmp_path: Path) -> None:
    done = mapped(tmp_path, turning_drive(hangs=True))
    assert mount_of(done) == [0.0, 0.0, 0.0]
    assert off(done) < 0.5
    assert any("to look ahead and to hang upside down" in note for note in done.notes)


def test_a_mount_that_was_told_is_left_and_what_contradicts_it_is_told(tmp_path: Path) -> None:
    items = turning_drive(hangs=True)
    recorded = mapped(tmp_path, items, with_mount=True)
    assert mount_of(recorded) == pytest.approx([0.2, 0.0, 0.0])
    assert any("its scans turn one way and the odometry the other" in n for n in recorded.notes)
    looks_back = mapped(tmp_path, turning_drive(yaw=math.pi), Wanted(laser=Pose(0.2)))
    assert mount_of(looks_back) == [0.2, 0.0, 0.0]
    assert any("degrees to the" in note for note in looks_back.notes)


def test_one_that_is_said_to_hang_upside_down_does(tmp_path: Path) -> None:
    wanted = Wanted(laser=Pose(0.2), laser_is_upside_down=True)
    done = mapped(tmp_path, turning_drive(hangs=True), wanted)
    assert off(done) < 0.1
    assert done.notes == ()


def test_scans_that_are_bent_by_turns_are_straightened_and_that_is_told(tmp_path: Path) -> None:
    items = turning_drive(beam_time=BEAM_TIME, is_backwards=True)
    done = mapped(tmp_path, items, with_mount=True)
    assert done.replay.lidar is not None
    assert done.replay.lidar.time_increment == pytest.approx(BEAM_TIME)
    [note] = done.notes
    assert "from the last to the first" in note


def behind_a_screen(number: int, item: Item) -> Item:
    """A thing on the robot, 0.4 m away, hides 100 of its 180 beams."""
    ranges = np.array(item.value)
    ranges[40:140] = 0.4 + np.random.default_rng(number).normal(0.0, 0.005, 100)
    return replace(item, value=ranges)


def test_beams_that_a_thing_on_the_robot_hides_are_left_out_and_that_is_told(
    tmp_path: Path,
) -> None:
    items = turning_drive()
    done = mapped(tmp_path, changed(items, "/scan", behind_a_screen), with_mount=True)
    [note] = done.notes
    assert note.startswith("100 of 180 beams show the same wherever the robot turns, 0.40 m away")
    assert off(done) < 0.1
    assert mapped(tmp_path, items, with_mount=True).notes == ()


def in_feet(number: int, item: Item) -> Item:
    assert isinstance(item.value, Pose)
    return replace(item, value=Pose(3.28 * item.value.x, 3.28 * item.value.y, item.value.theta))


def in_degrees(number: int, item: Item) -> Item:
    assert isinstance(item.value, Pose)
    return replace(item, value=Pose(item.value.x, item.value.y, math.degrees(item.value.theta)))


def no_number(number: int, item: Item) -> Item:
    return replace(item, value=Pose(math.nan, 0.0, 0.0))


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (in_feet, "it tells ways of "),
        (no_number, "hardly any of it can be used: its numbers are not finite"),
    ],
)
def test_odometry_that_is_of_no_use_is_left_out_and_that_is_told(
    tmp_path: Path, spoil: Callable[[int, Item], Item], said: str
) -> None:
    items = round_drive()
    done = mapped(tmp_path, changed(items, "/odom", spoil), with_mount=True)
    [note] = [note for note in done.notes if "odometry" in note]
    assert note.startswith(f"the odometry is not used, it goes by scans alone: {said}")
    ours = done.trajectory
    told = np.array([(i.stamp, i.value.x, i.value.y) for i in items if isinstance(i.value, Pose)])
    true = np.column_stack([np.interp(ours[:, 0], told[:, 0], told[:, axis]) for axis in (1, 2)])
    away, true_away = (np.hypot(*(way - way[0]).T) for way in (ours[:, 1:3], true))
    assert away == pytest.approx(true_away, abs=0.1)
    summary = summary_of(done, 1.0)
    assert summary.corrected_m is None
    assert not any("odometry alone" in text for _, text in lines_of(summary))


@pytest.mark.parametrize(
    ("items", "spoil"), [(round_drive(), in_feet), (turning_drive(), in_degrees)]
)
def test_hidden_beams_and_odometry_of_no_use_are_both_told(
    tmp_path: Path, items: list[Item], spoil: Callable[[int, Item], Item]
) -> None:
    spoiled = changed(changed(items, "/scan", behind_a_screen), "/odom", spoil)
    screen, odometry = mapped(tmp_path, spoiled, with_mount=True).notes[:2]
    assert screen.startswith("100 of 180 beams show the same wherever the robot turns, 0.40 m away")
    assert odometry.startswith("the odometry is not used, it goes by scans alone: it tells ")


def along_a_hall() -> list[Item]:
    """A drive that turns by 0.2 rad to and fro, with walls 0.8 m beside it."""
    generator, items = np.random.default_rng(1), []
    for number in range(150):
        seconds = number * PERIOD
        moved = Pose(0.1 * seconds, 0.0, 0.2 * math.sin(1.2 * seconds))
        stamp = BEGAN + seconds
        ranges = ranges_from(Pose(1.0, 0.8).compose(moved), generator)
        items += [Item("/odom", moved, stamp, stamp), Item("/scan", ranges, stamp, stamp)]
    return items


def test_by_turns_that_odometry_tells_too_large_no_wall_is_taken_for_a_thing_on_the_robot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(made_logs, "ROOM", (0.0, 0.0, 6.0, 1.6))
    items = changed(along_a_hall(), "/odom", in_degrees)
    samples = LidarSamples(readings_of(items, half_circle()))
    assert hidden_beams(samples, [sample.pose[2] for sample in samples.scans]).any()
    with LoggedDrive([write_bag(tmp_path / "hall.bag", items)]) as hall:
        look_at_drive(hall)
        assert not hall.chosen.has_odometry
        assert not any("show the same" in note for note in hall.notes)
        scans = [scan for _, scan, _ in hall.readings() if isinstance(scan, LidarScan)]
    assert len(scans) == 150
    assert not any(np.isneginf(scan.ranges).any() for scan in scans)


def test_hidden_beams_are_looked_for_in_scans_of_as_many_beams_as_most_have() -> None:
    readings = readings_of(changed(turning_drive(), "/scan", behind_a_screen), half_circle())
    odd = LidarScan(np.array([0.4], np.float32), LidarModel(np.zeros(1), 0.05, FARTHEST, LASER))
    for number in range(0, len(readings), 50):
        readings[number] = readings[number]._replace(value=odd)
    samples = LidarSamples(readings)
    hidden = hidden_beams(samples, [sample.pose[2] for sample in samples.scans])
    assert np.flatnonzero(hidden).tolist() == list(range(40, 140))
    assert not hidden_beams(samples, [0.0] * len(samples.scans)).any()
    assert hidden_beams(LidarSamples([]), []).shape == (0,)


def test_odometry_that_was_named_is_used_all_the_same_with_a_word(tmp_path: Path) -> None:
    wanted = Wanted(odometry="/odom")
    done = mapped(tmp_path, changed(round_drive(), "/odom", in_feet), wanted, with_mount=True)
    [note] = [note for note in done.notes if "the odometry" in note]
    assert note.startswith("the odometry is doubtful: it tells ways of ")
    assert done.replay.has_odometry


def with_gyro(share: float) -> list[Item]:
    """Return a drive with a gyro that tells a ``share`` of each turn."""
    gyro = []
    for number in range(int(50 * SECONDS)):
        before, after = (
            turning_pose(max(0.02 * number + step, 0.0)).theta for step in (-0.01, 0.01)
        )
        stamp = BEGAN + 0.02 * number
        gyro.append(Item("/imu", share * (after - before) / 0.02, stamp, stamp + 0.02, "imu_link"))
    return sorted([*turning_drive(), *gyro], key=lambda item: item.stamp)


def test_a_gyro_that_tells_other_turns_is_left_out_and_that_is_told(tmp_path: Path) -> None:
    done = mapped(tmp_path, with_gyro(-1.0), with_mount=True)
    [note] = done.notes
    assert note.startswith("the gyro is not used: it turns the other way than scans and odometry")
    assert note.endswith("--imu /imu uses it all the same")
    assert off(done) < 0.05
    good = mapped(tmp_path, with_gyro(1.0), with_mount=True)
    assert good.notes == ()
    assert off(good) < 0.05


def test_a_gyro_that_was_named_is_used_all_the_same_with_a_word(tmp_path: Path) -> None:
    items = with_gyro(0.0)
    with LoggedDrive([write_bag(tmp_path / "named.bag", items)], Wanted(gyro="/imu")) as drive:
        look_at_drive(drive)
        [note] = drive.notes
        assert note.startswith("the gyro is doubtful: it tells turns of 0 rad where ")
        assert any(isinstance(reading.value, Turning) for reading in drive.readings())


def test_of_a_drive_that_is_recorded_right_nothing_is_told(tmp_path: Path) -> None:
    done = mapped(tmp_path, turning_drive(), with_mount=True)
    assert done.notes == ()
    assert off(done) < 0.05
