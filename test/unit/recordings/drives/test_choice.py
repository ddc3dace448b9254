"""Which channels are read when none is named, and errors for those that are not there."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.recordings.drives.choice import Wanted, chosen
from roomba.recordings.log import Channel
from roomba.recordings.readings import Kind, LogError

PATHS = [Path("a.bag"), Path("b.bag")]
SCAN = Channel("/scan", Kind.SCAN, "sensor_msgs/LaserScan", 50)
REAR = Channel("/rear_scan", Kind.SCAN, "sensor_msgs/LaserScan", 90)
OTHER_SCAN = Channel("/two/scan", Kind.SCAN, "sensor_msgs/LaserScan", 99)
ODOM = Channel("/odom", Kind.ODOMETRY, "nav_msgs/Odometry", 100)
OTHER_ODOM = Channel("/two/odom", Kind.ODOMETRY, "nav_msgs/Odometry", 70)
FUSED = Channel("/odometry/filtered", Kind.ODOMETRY, "nav_msgs/Odometry", 200)
IMU = Channel("/imu", Kind.GYRO, "sensor_msgs/Imu", 300)
CAMERA_IMU = Channel("/camera/imu", Kind.GYRO, "sensor_msgs/Imu", 900)
IMAGE = Channel("/image", None, "sensor_msgs/Image", 7)
TRUTH = Channel("/ground_truth/pose", Kind.TRUTH, "geometry_msgs/PoseStamped", 5)


DROP = Channel("/wheel_drop", Kind.LIFTED, "roomba_robot/WheelDrop", 40)
START = Channel("/initialpose", Kind.TOLD, "geometry_msgs/PoseWithCovarianceStamped", 1)
AMCL = Channel("/amcl_pose", Kind.TOLD, "geometry_msgs/PoseWithCovarianceStamped", 9)
OWN_AMCL = AMCL._replace(kind=Kind.OWN_POSE)
POSE = Channel("/pose", Kind.OWN_POSE, "geometry_msgs/PoseStamped", 80)
OTHER_POSE = POSE._replace(name="/two/pose")
BESIDE = frozenset({Kind.LIFTED, Kind.TOLD, Kind.OWN_POSE})


def names(channels: list[Channel], wanted: Wanted | None = None) -> list[str]:
    return [each.name for each in chosen(PATHS, channels, wanted or Wanted()).channels]


def test_the_usual_ones_are_taken_whatever_else_there_is() -> None:
    channels = [IMAGE, REAR, SCAN, FUSED, ODOM, CAMERA_IMU, IMU, TRUTH]
    assert names(channels) == ["/scan", "/odom", "/imu", "/ground_truth/pose"]
    told = chosen(PATHS, channels, Wanted()).notes
    assert told == (
        "--scan /scan (50) is taken; there is /rear_scan (90) as well",
        "--odom /odom (100) is taken; there is /odometry/filtered (200) as well",
    )


def test_of_unusual_ones_the_one_with_most_messages_is_taken() -> None:
    assert names([REAR, FUSED]) == ["/rear_scan", "/odometry/filtered"]
    assert names([REAR, REAR._replace(name="/front", messages=10), FUSED])[0] == "/rear_scan"


def test_odometry_is_that_of_the_robot_whose_scans_are_read() -> None:
    channels = [SCAN, OTHER_SCAN, ODOM, OTHER_ODOM]
    assert names(channels, Wanted(scan="/two/scan")) == ["/two/scan", "/two/odom"]
    assert names(channels, Wanted(scan="two/scan"))[0] == "/two/scan"
    assert names(channels, Wanted(scan="scan")) == ["/scan", "/odom"]


def test_of_a_log_odometry_is_what_comes_with_the_scans() -> None:
    laser = Channel("FLASER", Kind.SCAN, "scans", 50)
    channels = [
        Channel("ODOM", Kind.ODOMETRY, "odometry", 500),
        laser,
        laser._replace(kind=Kind.ODOMETRY, type="odometry"),
    ]
    assert names(channels) == ["FLASER", "FLASER"]
    assert names(channels, Wanted(odometry="ODOM")) == ["FLASER", "ODOM"]


def test_without_odometry_scans_may_do_unless_one_is_named() -> None:
    done = chosen(PATHS, [SCAN, IMU, DROP], Wanted())
    assert names([SCAN, IMU, DROP]) == ["/scan", DROP.name]
    assert not done.has_odometry
    assert "it goes by scans alone" in done.notes[0]
    with pytest.raises(LogError, match="expected nav_msgs/Odometry on /odom"):
        names([SCAN, IMU], Wanted(odometry="/odom"))


def test_a_gyro_of_an_unusual_name_is_only_told() -> None:
    channels = [SCAN, ODOM, CAMERA_IMU]
    assert names(channels) == ["/scan", "/odom"]
    assert "--imu /camera/imu would be" in chosen(PATHS, channels, Wanted()).notes[0]
    assert names(channels, Wanted(gyro="/camera/imu"))[2] == "/camera/imu"


@pytest.mark.parametrize(
    ("beside", "expected"),
    [
        ([DROP, AMCL, OWN_AMCL, START, OTHER_POSE, POSE], [DROP, START, POSE]),
        ([TRUTH, OTHER_POSE, AMCL, OWN_AMCL], [AMCL, OWN_AMCL]),
        ([OTHER_POSE, IMAGE], []),
    ],
)
def test_poses_are_read_by_their_usual_names_if_they_are_wanted(
    beside: list[Channel], expected: list[Channel]
) -> None:
    found = chosen(PATHS, [*beside, SCAN, ODOM], Wanted(beside=BESIDE))
    assert list(found.channels) == [SCAN, ODOM, *expected]
    assert found.name(Kind.TOLD) == next((e.name for e in expected if e.kind is Kind.TOLD), None)
    assert set(names([*beside, SCAN, ODOM])) <= {"/scan", "/odom", TRUTH.name, DROP.name}


def test_poses_of_a_named_robot_are_those_beside_its_odometry() -> None:
    channels = [POSE, OTHER_POSE, OTHER_SCAN, OTHER_ODOM]
    assert names(channels, Wanted(beside=BESIDE))[2:] == ["/two/pose"]


def test_a_topic_that_tells_two_kinds_is_listed_once() -> None:
    with pytest.raises(LogError) as refusal:
        chosen(PATHS, [ODOM, AMCL, OWN_AMCL], Wanted())
    assert str(refusal.value).count("/amcl_pose") == 1


@pytest.mark.parametrize(
    ("channels", "wanted", "said"),
    [
        ([ODOM, IMAGE], Wanted(), "expected sensor_msgs/LaserScan on /scan, there is none; no"),
        (
            [SCAN, IMAGE],
            Wanted(odometry="/odom"),
            "expected nav_msgs/Odometry on /odom, there is none; no other",
        ),
        ([SCAN, ODOM, IMAGE], Wanted(scan="/image"), "on /image, it is sensor_msgs/Image; try"),
        ([SCAN, ODOM, REAR], Wanted(scan="/none"), "try --scan /scan or --scan /rear_scan"),
        ([SCAN, ODOM], Wanted(gyro="/imu"), "expected sensor_msgs/Imu on /imu, there is none"),
    ],
)
def test_what_is_missing_is_told_with_what_there_is(
    channels: list[Channel], wanted: Wanted, said: str
) -> None:
    with pytest.raises(LogError) as refusal:
        chosen(PATHS, channels, wanted)
    told = str(refusal.value)
    assert told.startswith("a.bag, b.bag: expected ")
    assert said in told
    for channel in channels:
        assert f"{channel.name} ({channel.type}, {channel.messages})" in told


def test_of_clouds_alone_it_is_told_how_to_make_scans_of_them() -> None:
    cloud = Channel("/points", None, "sensor_msgs/PointCloud2", 7)
    with pytest.raises(LogError, match=r"on /points .* is not read: make scans .*_to_laserscan"):
        chosen(PATHS, [cloud, ODOM], Wanted())
    with pytest.raises(LogError) as refusal:
        chosen(PATHS, [cloud, SCAN, ODOM], Wanted(scan="/none"))
    assert "is not read" not in str(refusal.value)


def test_of_a_text_log_what_is_missing_is_told_in_its_words() -> None:
    odometry = Channel("ODOM", Kind.ODOMETRY, "line", 9)
    for channels, wanted, said in (
        ([odometry], Wanted(), "expected scans of a lidar, there is none; no lines tell any"),
        ([odometry], Wanted(scan="FLASER"), "expected scans of a lidar in lines FLASER, there"),
    ):
        with pytest.raises(LogError, match=said):
            chosen([Path("a.log")], channels, wanted)


def test_odometry_may_be_left_out_afterwards() -> None:
    found = chosen(PATHS, [SCAN, ODOM, IMU], Wanted())
    assert found.has_odometry
    left = found.without(Kind.ODOMETRY)
    assert not left.has_odometry
    assert list(left.channels) == [each for each in found.channels if each != ODOM]


def test_of_very_many_channels_only_some_are_listed() -> None:
    many = [IMAGE._replace(name=f"/image{number}") for number in range(100)]
    with pytest.raises(LogError, match=r"/image29 .*and 70 more$"):
        chosen(PATHS, many, Wanted())
