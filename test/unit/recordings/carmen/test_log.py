"""CARMEN logs: what each kind of line says, where the laser is, what met nothing."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives.made_logs import LASER, NO_ECHO, drive, write_carmen

from roomba.geometry import Pose
from roomba.perception.matching.mounts import Mount, Mounts
from roomba.perception.matching.plausible import FARTHEST_ECHO
from roomba.recordings.carmen.log import BASE, CarmenLog
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.log import Channel
from roomba.recordings.readings import Kind, LidarScan, Odometry, Refused, Value

FLASER = "FLASER 3 1.0 2.0 81.83 0.1 0.2 0.3 0.1 0.2 0.3 12.5 nohost 0.25"
ROBOT_LASER = (
    "ROBOTLASER1 0 -1.0 2.0 0.5 30.0 0.01 0 4 1.0 2.0 30.0 1.5 2 7 8 "
    "0.6 0.0 0.0 0.5 0.0 0.0 0.3 0.1 0.4 0.2 1e6 13.5 robot 1.25"
)
RAW_LASER = "RAWLASER1 0 -0.5 1.0 0.5 80.0 0.01 0 3 1.0 2.0 3.0 0 14.5 robot 2.25"
ODOM = "ODOM 1.0 2.0 7.0 0.3 0.1 0.0 11.5 nohost -0.75"


def log_of(tmp_path: Path, *lines: str) -> CarmenLog:
    (tmp_path / "made.log").write_text("\n".join(lines) + "\n", "utf-8")
    return CarmenLog(tmp_path / "made.log")


def channel(log: CarmenLog, name: str, kind: Kind) -> Channel:
    [found] = [each for each in log.channels if (each.name, each.kind) == (name, kind)]
    return found


def values(log: CarmenLog, *channels: Channel, mount: Pose | None = None) -> list[Value | Refused]:
    count = len(list(log.entries(channels)))
    given = log.values(channels, np.ones(count, np.bool_), lambda *_: Mount(mount or Pose()))
    return [value for value in given if value is not None]


def mount_of(log: CarmenLog, name: str) -> Pose:
    mounts = Mounts()
    mounts.add(log.transforms())
    found = mounts.mount(BASE, name)
    assert found is not None
    return found.pose


def test_a_front_laser_looks_ahead_over_half_a_turn(tmp_path: Path) -> None:
    log = log_of(tmp_path, "# message_name [message contents]", FLASER)
    [scan] = values(log, channel(log, "FLASER", Kind.SCAN))
    assert isinstance(scan, LidarScan)
    assert scan.ranges.tolist() == pytest.approx([1.0, 2.0, 81.83])
    beams = scan.lidar.arrays()
    assert beams.first_angle == pytest.approx(-0.5 * math.pi)
    assert beams.step == pytest.approx(0.5 * math.pi)
    # What is as far as the lidar can say met nothing.
    assert 2.0 < beams.farthest < 81.83
    [odometry] = values(log, channel(log, "FLASER", Kind.ODOMETRY))
    assert odometry == Odometry(Pose(0.1, 0.2, 0.3))
    [entry] = log.entries([channel(log, "FLASER", Kind.SCAN)])
    assert (entry.stamp, entry.arrival) == (12.5, 0.25)


@pytest.mark.parametrize(
    ("beams", "first", "last"),
    [(180, -90.0, 89.0), (181, -90.0, 90.0), (361, -90.0, 90.0), (401, -50.0, 50.0)],
)
def test_how_a_front_laser_is_set_follows_from_its_readings(
    tmp_path: Path, beams: int, first: float, last: float
) -> None:
    line = f"FLASER {beams} {'1.5 ' * beams} 0 0 0 0 0 0 12.5 nohost 0.25"
    log = log_of(tmp_path, line)
    [scan] = values(log, channel(log, "FLASER", Kind.SCAN))
    assert isinstance(scan, LidarScan)
    model = scan.lidar.arrays()
    assert math.degrees(model.first_angle) == pytest.approx(first)
    assert math.degrees(model.first_angle + model.step * (beams - 1)) == pytest.approx(last)


def test_a_laser_that_tells_how_it_is_set_is_believed(tmp_path: Path) -> None:
    log = log_of(tmp_path, ROBOT_LASER, RAW_LASER)
    [scan] = values(log, channel(log, "ROBOTLASER1", Kind.SCAN))
    assert isinstance(scan, LidarScan)
    model = scan.lidar.arrays()
    assert (model.first_angle, model.step) == pytest.approx((-1.0, 0.5))
    assert model.farthest < 30.0
    assert scan.ranges.tolist() == [1.0, 2.0, 30.0, 1.5]
    [odometry] = values(log, channel(log, "ROBOTLASER1", Kind.ODOMETRY))
    assert odometry == Odometry(Pose(0.5, 0.0, 0.0))
    [entry] = log.entries([channel(log, "ROBOTLASER1", Kind.SCAN)])
    assert (entry.stamp, entry.arrival) == (13.5, 1.25)
    [raw] = values(log, channel(log, "RAWLASER1", Kind.SCAN))
    assert isinstance(raw, LidarScan)
    assert raw.ranges.tolist() == [1.0, 2.0, 3.0]
    [entry] = log.entries([channel(log, "RAWLASER1", Kind.SCAN)])
    assert (entry.stamp, entry.arrival) == (14.5, 2.25)
    assert ("RAWLASER1", Kind.ODOMETRY) not in [(each.name, each.kind) for each in log.channels]


def test_lines_of_odometry_are_read_with_their_times(tmp_path: Path) -> None:
    log = log_of(tmp_path, ODOM, RAW_LASER)
    [odometry] = values(log, channel(log, "ODOM", Kind.ODOMETRY))
    assert isinstance(odometry, Odometry)
    assert (odometry.pose.x, odometry.pose.y) == (1.0, 2.0)
    assert odometry.pose.theta == pytest.approx(7.0 - math.tau)
    both = [channel(log, "RAWLASER1", Kind.SCAN), channel(log, "ODOM", Kind.ODOMETRY)]
    assert [entry.channel for entry in log.entries(both)] == [1, 0]


def test_where_the_laser_is_follows_from_its_poses_beside_the_robots(tmp_path: Path) -> None:
    log = CarmenLog(write_carmen(tmp_path / "made.log", drive(4.0)))
    found = mount_of(log, "FLASER")
    assert (found.x, found.y, found.theta) == pytest.approx(
        (LASER.x, LASER.y, LASER.theta), abs=1e-5
    )


def test_poses_of_a_laser_that_were_corrected_say_nothing_of_where_it_is(tmp_path: Path) -> None:
    lines = [
        f"FLASER 3 1.0 2.0 3.0 {0.3 + 0.1 * at} 0 0 0.3 0 0 {at} nohost {at}" for at in range(5)
    ]
    assert mount_of(log_of(tmp_path, *lines), "FLASER") == Pose()


def test_else_the_parameters_tell_where_the_laser_is(tmp_path: Path) -> None:
    log = log_of(
        tmp_path,
        "PARAM robot_frontlaser_offset 0.35 nohost 0",
        "PARAM robot_frontlaser_angular_offset 0.1 nohost 0",
        "PARAM robot_name lisa nohost 0",
        FLASER,
    )
    found = mount_of(log, "FLASER")
    assert (found.x, found.y, found.theta) == pytest.approx((0.35, 0.0, 0.1))


def test_no_echo_is_known_by_the_largest_number_of_the_log(tmp_path: Path) -> None:
    items = drive(4.0)
    for item in items:
        if isinstance(item.value, np.ndarray):
            item.value[::9] = NO_ECHO
            item.value[4::9] = 81.91
    log = CarmenLog(write_carmen(tmp_path / "made.log", items))
    scans = values(log, channel(log, "FLASER", Kind.SCAN))
    for scan in scans:
        assert isinstance(scan, LidarScan)
        used = scan.ranges <= scan.lidar.arrays().farthest
        assert not used[::9].any()
        assert not used[4::9].any()
        assert used[1::9].all()


def test_broken_lines_are_left_out_and_counted(tmp_path: Path) -> None:
    broken = ["FLASER 5 1.0 2.0", "ODOM nan 0 0 0 0 0 1 h 1", "FLASER x", "ODOM 1 2", "NEWS a b"]
    log = log_of(tmp_path, *broken, FLASER, "FLASER 0 0 0 0 0 0 0 13.0 nohost 1.0")
    [note] = log.notes
    assert note == (
        "4 lines of made.log cannot be read: left out (the first: line 1, FLASER: expected 5 "
        "ranges, got 2)"
    )
    assert [(each.name, each.kind) for each in log.channels] == [
        ("FLASER", Kind.SCAN),
        ("FLASER", Kind.ODOMETRY),
        ("NEWS", None),
    ]
    scan, empty = values(log, channel(log, "FLASER", Kind.SCAN))
    assert isinstance(scan, LidarScan)
    assert isinstance(empty, Refused)
    assert empty.what == "scans that cannot be used"
    assert "expected a scan with beams" in empty.reason


def test_scans_in_centimetres_are_refused(tmp_path: Path) -> None:
    ranges = " ".join(f"{400.0 + number}" for number in range(20))
    log = log_of(tmp_path, f"FLASER 20 {ranges} 0 0 0 0 0 0 12.5 nohost 0.25")
    [refused] = values(log, channel(log, "FLASER", Kind.SCAN))
    assert isinstance(refused, Refused)
    assert "20 of 20 that are farther, 409.5 m in the middle: are they in mm?" in refused.reason


def test_a_lone_beam_that_is_too_far_to_be_true_met_nothing(tmp_path: Path) -> None:
    scan = "FLASER 3 1.0 2.0 1e7 0 0 0 0 0 0 12.5 nohost 0.25"
    log = log_of(tmp_path, scan)
    [value] = values(log, channel(log, "FLASER", Kind.SCAN))
    assert isinstance(value, LidarScan)
    assert value.lidar.arrays().farthest <= FARTHEST_ECHO


def test_lines_without_times_have_no_stamp(tmp_path: Path) -> None:
    log = log_of(tmp_path, "FLASER 2 1.0 2.0 0 0 0 0 0 0")
    [entry] = log.entries([channel(log, "FLASER", Kind.SCAN)])
    assert entry.stamp == 0.0


@pytest.mark.parametrize(
    ("stamp", "arrival"),
    [("0", "0"), ("1.13486e+09", "1.13486e+09")],
    ids=["missing", "cut to few digits"],
)
def test_without_times_that_differ_the_order_of_lines_counts(
    tmp_path: Path, stamp: str, arrival: str
) -> None:
    lines = [f"FLASER 3 1.0 2.0 81.83 {x} 0 0 {x} 0 0 {stamp} made {arrival}" for x in range(5)]
    log = log_of(tmp_path, *lines)
    entries = list(log.entries([channel(log, "FLASER", Kind.SCAN)]))
    assert [entry.stamp for entry in entries] == [0.0] * 5
    assert [entry.is_by_order for entry in entries] == [stamp != "0"] * 5
    arrivals = np.array([entry.arrival for entry in entries])
    assert np.diff(arrivals) == pytest.approx(np.full(4, 10.0))
    assert log.notes == [
        "the times in made.log do not tell its scans apart: they go by their order"
    ]


def test_stamps_that_differ_count_even_if_no_time_of_recording_does(tmp_path: Path) -> None:
    lines = [f"FLASER 3 1.0 2.0 81.83 0 0 0 0 0 0 {12.5 + x} made 0" for x in range(5)]
    log = log_of(tmp_path, *lines)
    entries = list(log.entries([channel(log, "FLASER", Kind.SCAN)]))
    assert [entry.stamp for entry in entries] == [12.5 + x for x in range(5)]
    assert not log.notes


@pytest.mark.parametrize("has_arrivals", [True, False], ids=["recorded", "stamps alone"])
@pytest.mark.parametrize("begin", [0.5, 1000.0], ids=["the same times", "from long before"])
def test_of_two_drives_in_a_file_the_second_goes_on_after_the_first(
    tmp_path: Path, begin: float, has_arrivals: bool
) -> None:
    times = [1000.0 + 0.5 * at for at in range(40)] + [begin + 0.5 * at for at in range(40)]
    made = "FLASER 3 1.0 2.0 81.83 0 0 0 0 0 0 {stamp} made {arrival}"
    lines = [made.format(stamp=time, arrival=time if has_arrivals else 0.0) for time in times]
    (tmp_path / "made.log").write_text("\n".join(lines), "utf-8")
    with LoggedDrive([tmp_path / "made.log"]) as both:
        read = [each.stamp for each in both.readings() if isinstance(each.value, LidarScan)]
        assert read == sorted(read)
        assert np.diff(read) == pytest.approx(np.full(79, 0.5))
        assert both.counts.out_of_order == 0
        assert both.notes == [
            "the recorder's clock was set back on the way: the time goes on there"
        ]
