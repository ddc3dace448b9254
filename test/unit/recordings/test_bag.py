"""Bags of ROS 1 and 2, whole and damaged."""

from __future__ import annotations

import gzip
import math
import sqlite3
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fixtures.drives import made_logs
from fixtures.drives.made_logs import (
    BEGAN,
    LASER,
    PERIOD,
    Item,
    Messages,
    changed,
    drive,
    write_bag,
    write_bag_2,
)
from rosbags.rosbag1 import Reader, Writer
from rosbags.rosbag2 import StoragePlugin

from roomba.geometry import Pose
from roomba.perception.matching.mounts import UPRIGHT, UPSIDE_DOWN, Mount, Mounts
from roomba.recordings.bag import BagLog
from roomba.recordings.bag_file import BagFile
from roomba.recordings.log import Channel
from roomba.recordings.message_types import known_types
from roomba.recordings.readings import (
    Kind,
    LidarScan,
    Lifted,
    LogError,
    Odometry,
    OwnPose,
    Refused,
    ToldPose,
    Turning,
    Value,
)

SECONDS = 6.0
SCANS = int(SECONDS / PERIOD)


def written(path: Path, form: str, items: list[Item]) -> Path:
    """Write a bag of a form, and return what a person would name."""
    if form == "bag":
        return write_bag(path / "made.bag", items)
    storage = StoragePlugin.MCAP if form == "mcap" else StoragePlugin.SQLITE3
    folder = write_bag_2(path / "made", items, storage)
    return next(folder.glob(f"*.{form}")) if form != "folder" else folder


def read(log: BagLog, *channels: Channel) -> list[tuple[float, Value | Refused | None]]:
    entries = list(log.entries(channels))
    values = log.values(channels, np.ones(len(entries), np.bool_), lambda *_: Mount(LASER))
    return [(entry.stamp, value) for entry, value in zip(entries, values, strict=True)]


@pytest.mark.parametrize("form", ["bag", "folder", "db3", "mcap"])
def test_each_form_of_a_bag_says_the_same(tmp_path: Path, form: str) -> None:
    items = drive(SECONDS)
    log = BagLog(written(tmp_path, form, items))
    channels = {each.name: each for each in log.channels}
    assert {name: (each.kind, each.type, each.messages) for name, each in channels.items()} == {
        "/scan": (Kind.SCAN, "sensor_msgs/LaserScan", SCANS),
        "/odom": (Kind.ODOMETRY, "nav_msgs/Odometry", 2 * SCANS),
        "/tf_static": (None, "tf2_msgs/TFMessage", 1),
    }
    assert log.frames(channels["/odom"]) == ("odom", "base_link")
    mounts = Mounts()
    mounts.add(log.transforms())
    mount = mounts.mount("base_link", "laser")
    assert mount is not None
    assert mount.pose.x == pytest.approx(LASER.x)
    found = read(log, channels["/scan"], channels["/odom"])
    assert [stamp for stamp, _ in found] == pytest.approx(
        sorted(item.stamp for item in items), abs=1e-6
    )
    scans = [value for _, value in found if isinstance(value, LidarScan)]
    odometry = [value for _, value in found if isinstance(value, Odometry)]
    ranges = [item.value for item in items if isinstance(item.value, np.ndarray)]
    assert len(scans) == SCANS
    for scan, expected in zip(scans, ranges, strict=True):
        assert scan.ranges == pytest.approx(expected, abs=1e-6)
        assert scan.lidar is scans[0].lidar
        assert scan.lidar.mount.tolist() == [LASER.x, LASER.y, LASER.theta]
    poses = [item.value for item in items if isinstance(item.value, Pose)]
    assert [each.pose.x for each in odometry] == pytest.approx([pose.x for pose in poses])
    log.close()


@pytest.mark.parametrize("form", ["bag", "mcap"])
def test_of_several_echoes_of_a_beam_the_first_one_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, form: str
) -> None:
    """The last beam has none: it met nothing."""
    plain = Messages.of

    def of(made: Messages, item: Item) -> tuple[Any, str]:
        message, type_ = plain(made, item)
        if not type_.endswith("/LaserScan"):
            return message, type_
        echoes = [[each, each + 1.0] for each in message.ranges[:-1]] + [[]]
        fields = {name: getattr(message, name) for name in message.__dataclass_fields__}
        fields["ranges"] = [
            made._make("sensor_msgs/msg/LaserEcho", echoes=np.array(each, np.float32))
            for each in echoes
        ]
        fields["intensities"] = []
        type_ = "sensor_msgs/msg/MultiEchoLaserScan"
        fields.pop("__msgtype__", None)
        return made._make(type_, **fields), type_

    monkeypatch.setattr(Messages, "of", of)
    items = drive(2.0)
    log = BagLog(written(tmp_path, form, items))
    [channel] = [each for each in log.channels if each.kind is Kind.SCAN]
    scans = [value for _, value in read(log, channel) if isinstance(value, LidarScan)]
    ranges = [item.value for item in items if isinstance(item.value, np.ndarray)]
    for scan, expected in zip(scans, ranges, strict=True):
        assert scan.ranges[:-1] == pytest.approx(expected[:-1], abs=1e-6)
        assert scan.ranges[-1] == math.inf
        assert scan.lidar is scans[0].lidar
    assert log.transforms()
    log.close()


def test_ranges_that_are_cut_met_nothing_there(tmp_path: Path) -> None:
    """A driver cuts at 2.5 m and tells another farthest range, until longer ones come."""
    clean = drive(4.0)

    def shorter(number: int, item: Item) -> Item:
        assert isinstance(item.value, np.ndarray)
        return replace(item, value=np.minimum(item.value, 2.5)) if number < 10 else item

    cut = changed(clean, "/scan", shorter)
    longest = [float(each.value.max()) for each in clean if isinstance(each.value, np.ndarray)]
    assert min(longest) > 2.5
    log = BagLog(write_bag(tmp_path / "made.bag", cut))
    [scan] = [each for each in log.channels if each.kind is Kind.SCAN]
    scans = [value for _, value in read(log, scan) if isinstance(value, LidarScan)]
    farthest = [each.lidar.arrays().farthest for each in scans]
    assert farthest[:10] == [2.5] * 10
    assert min(farthest[10:]) > max(longest)
    log.close()


@pytest.mark.parametrize(("bound", "told"), [("NEAREST", math.nan), ("FARTHEST", 0.0)])
def test_of_a_driver_that_tells_no_bound_of_ranges_all_of_them_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, bound: str, told: float
) -> None:
    monkeypatch.setattr(made_logs, bound, told)
    items = drive(2.0)
    ranges = [each.value for each in items if isinstance(each.value, np.ndarray)]
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    [channel] = [each for each in log.channels if each.kind is Kind.SCAN]
    scans = [value for _, value in read(log, channel)]
    assert len(scans) == len(ranges)
    for scan, expected in zip(scans, ranges, strict=True):
        assert isinstance(scan, LidarScan)
        assert len(scan.lidar.view(scan.ranges)) == len(expected)
    log.close()


def test_what_is_not_wanted_is_not_decoded(tmp_path: Path) -> None:
    log = BagLog(write_bag(tmp_path / "made.bag", drive(2.0)))
    [scan] = [each for each in log.channels if each.kind is Kind.SCAN]
    wanted = np.array([True, False] * 5)
    values = list(log.values([scan], wanted, lambda *_: Mount()))
    assert [value is not None for value in values] == wanted.tolist()
    log.close()


def test_what_is_recorded_while_a_bag_is_read_is_left_out(tmp_path: Path) -> None:
    path = written(tmp_path, "db3", drive(2.0))
    log = BagLog(path)
    channels = [each for each in log.channels if each.kind in (Kind.SCAN, Kind.ODOMETRY)]
    entries = list(log.entries(channels))
    with sqlite3.connect(path) as database:
        columns = "topic_id, timestamp, data"
        later = columns.replace("timestamp", "timestamp + 2000000000")
        database.execute(f"INSERT INTO messages ({columns}) SELECT {later} FROM messages")
    values = list(log.values(channels, np.ones(len(entries), np.bool_), lambda *_: Mount(LASER)))
    kinds = {Kind.SCAN: LidarScan, Kind.ODOMETRY: Odometry}
    expected = [kinds[channels[each.channel].kind or Kind.SCAN] for each in entries]
    assert [type(value) for value in values] == expected
    log.close()


def test_odometry_that_is_only_in_the_transforms_is_found_there(tmp_path: Path) -> None:
    items = [
        replace(item, topic="/tf") if item.topic == "/odom" else item for item in drive(SECONDS)
    ]
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    [odometry] = [each for each in log.channels if each.kind is Kind.ODOMETRY]
    assert odometry.name == "/tf"
    assert log.frames(odometry) == ("odom", "base_link")
    found = read(log, odometry)
    assert [stamp for stamp, _ in found] == pytest.approx(
        [item.stamp for item in items if item.topic == "/tf"], abs=1e-6
    )
    assert all(isinstance(value, Odometry) for _, value in found)
    assert {each.child for each in log.transforms()} == {"laser"}
    log.close()


def test_what_first_comes_late_on_tf_is_found(tmp_path: Path) -> None:
    """Odometry that begins when a robot does, beside a publisher of mounts that is quick."""
    items = [replace(item, topic="/tf") if item.topic == "/odom" else item for item in drive(2.0)]
    late = max(item.arrival for item in items)
    path = tmp_path / "made.bag"
    store = known_types(is_first=True)
    made = Messages(store)
    screen, laser = (
        made.transforms([made.transform(BEGAN, "base_link", name, LASER)])
        for name in ("screen", "laser")
    )
    early = [("/tf", screen, "tf2_msgs/msg/TFMessage", BEGAN - 400.0 + at) for at in range(400)]
    told = [(item.topic, *made.of(item), item.arrival) for item in items]
    messages = [*early, *told, ("/tf", laser, "tf2_msgs/msg/TFMessage", late)]
    with Writer(path) as writer:
        topics: dict[str, Any] = {}
        for topic, message, type_, arrival in messages:
            if topic not in topics:
                topics[topic] = writer.add_connection(topic, type_, typestore=store)
            raw = store.serialize_ros1(message, type_)
            writer.write(topics[topic], round(1e9 * arrival), raw)
    log = BagLog(path)
    [odometry] = [each for each in log.channels if each.kind is Kind.ODOMETRY]
    assert log.frames(odometry) == ("odom", "base_link")
    assert len(read(log, odometry)) == sum(item.topic == "/tf" for item in items)
    mounts = Mounts()
    mounts.add(log.transforms())
    assert mounts.mount("base_link", "laser") == Mount(LASER)
    log.close()


def test_a_gyro_that_hangs_upside_down_turns_the_other_way(tmp_path: Path) -> None:
    items = [*drive(2.0), Item("/imu", 0.25, BEGAN + 0.01, BEGAN + 0.01, "imu_link")]
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    [gyro] = [each for each in log.channels if each.kind is Kind.GYRO]
    for upside_down, expected in ((False, 0.25), (True, -0.25)):
        mount = Mount(up=UPSIDE_DOWN if upside_down else UPRIGHT)
        [value] = log.values([gyro], np.ones(1, np.bool_), lambda *_, mount=mount: mount)
        assert value == Turning(expected)
    log.close()


@pytest.mark.parametrize("form", ["bag", "folder"])
def test_wheels_that_hang_and_poses_are_read(tmp_path: Path, form: str) -> None:
    pose = Pose(1.5, -2.0, 0.25)
    told = ToldPose(pose, (0.3, 0.2))
    items = [
        Item("/wheel_drop", Lifted(True), BEGAN, BEGAN),
        Item("/initialpose", told, BEGAN, BEGAN),
        Item("/amcl_pose", told, BEGAN, BEGAN),
        Item("/amcl_pose", told, BEGAN + 0.5, BEGAN + 0.5),
        Item("/robot/pose", OwnPose(pose), BEGAN, BEGAN),
        Item("/position", OwnPose(pose), BEGAN, BEGAN),
    ]
    log = BagLog(written(tmp_path, form, items))
    channels = {(e.name, e.kind, e.messages): e for e in log.channels if e.kind is not None}
    expected = [
        ("/wheel_drop", Kind.LIFTED, 1),
        ("/initialpose", Kind.TOLD, 1),
        ("/amcl_pose", Kind.TOLD, 2),
        ("/amcl_pose", Kind.OWN_POSE, 2),
        ("/robot/pose", Kind.OWN_POSE, 1),
        ("/position", Kind.OWN_POSE, 1),
    ]
    assert channels.keys() == set(expected)
    found = (read(log, channels[key]) for key in expected)
    drop, start, first, own, named, position = found
    assert drop == [(BEGAN, Lifted(True))]
    for [(stamp, value), *_] in (start, first):
        assert stamp == BEGAN
        assert isinstance(value, ToldPose)
        assert value.deviation == pytest.approx((0.3, 0.2))
        assert (value.pose.x, value.pose.y, value.pose.theta) == pytest.approx((1.5, -2.0, 0.25))
    assert [type(value) for _, value in own] == [OwnPose, OwnPose]
    assert [type(value) for _, value in named] == [OwnPose]
    # It has no stamp, and tells no heading.
    assert position == [(0.0, OwnPose(Pose(1.5, -2.0)))]
    log.close()


@pytest.mark.parametrize(
    ("value", "why"),
    [
        (OwnPose(Pose(math.nan, 0.0)), "its numbers are not finite"),
        (ToldPose(Pose(0.0, math.inf), (0.1, 0.1)), "its numbers are not finite"),
        (ToldPose(Pose(), (math.nan, 0.1)), "its numbers are not finite"),
    ],
)
def test_poses_that_are_none_are_refused(
    tmp_path: Path, value: OwnPose | ToldPose, why: str
) -> None:
    topic = "/pose" if isinstance(value, OwnPose) else "/initialpose"
    log = BagLog(write_bag(tmp_path / "made.bag", [Item(topic, value, BEGAN, BEGAN)]))
    [(_, refused)] = read(log, *[each for each in log.channels if each.kind is not None])
    assert isinstance(refused, Refused)
    assert refused.reason == why
    log.close()


@pytest.mark.parametrize("topic", ["/pose", "/initialpose"])
def test_poses_of_another_frame_are_none_on_the_map(tmp_path: Path, topic: str) -> None:
    value = OwnPose(Pose()) if topic == "/pose" else ToldPose(Pose(), (0.1, 0.1))
    items = [Item(topic, value, BEGAN, BEGAN, frame) for frame in ("map", "", "odom")]
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    found = read(log, *[each for each in log.channels if each.kind is not None])
    assert [isinstance(each, Refused) for _, each in found] == [False, False, True]
    log.close()


def test_messages_that_make_no_sense_are_refused_with_the_reason(tmp_path: Path) -> None:
    def spoil(number: int, item: Item) -> Item:
        return replace(item, value=np.empty(0)) if number == 1 else item

    items = changed(drive(2.0), "/scan", spoil)
    items = changed(
        items, "/odom", lambda at, item: item if at else replace(item, value=Pose(np.nan, 0.0, 0.0))
    )
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    refused = [value for _, value in read(log, *log.channels[1:3]) if isinstance(value, Refused)]
    refused += [value for _, value in read(log, *log.channels[:1]) if isinstance(value, Refused)]
    assert {each.what for each in refused} == {"scans that cannot be used", "messages of odometry"}
    log.close()


def test_odometry_without_an_orientation_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def zeros(made: Messages, theta: float) -> object:
        return made._make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=0.0)

    monkeypatch.setattr(Messages, "_turn", zeros)
    items = [item for item in drive(2.0) if item.topic == "/odom"]
    log = BagLog(write_bag(tmp_path / "made.bag", items, with_mount=False))
    [odometry] = [each for each in log.channels if each.kind is Kind.ODOMETRY]
    refused = {value for _, value in read(log, odometry)}
    assert refused == {
        Refused("messages of odometry", "its orientation is (0, 0, 0, 0), which is none")
    }
    log.close()


@pytest.mark.parametrize("farthest", [10.0, 10_000.0])
def test_scans_in_millimetres_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, farthest: float
) -> None:
    def in_millimetres(number: int, item: Item) -> Item:
        assert isinstance(item.value, np.ndarray)
        return replace(item, value=1e3 * item.value)

    items = changed(drive(1.0), "/scan", in_millimetres)
    monkeypatch.setattr(made_logs, "FARTHEST", farthest)
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    [scans] = [each for each in log.channels if each.kind is Kind.SCAN]
    for _, value in read(log, scans):
        assert isinstance(value, Refused)
        assert "are they in mm?" in value.reason
    log.close()


def test_a_damaged_piece_costs_that_piece_alone(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(60.0))
    data = bytearray(path.read_bytes())
    # A chunk of 60 s is 220 kB: what is written over are the lengths of some records in it.
    middle = len(data) // 2
    data[middle : middle + 3000] = b"\xff" * 3000
    path.write_bytes(data)
    log = BagLog(path)
    [scan] = [each for each in log.channels if each.kind is Kind.SCAN]
    found = read(log, scan)
    assert 250 < len(found) < 300
    assert found[-1][0] > BEGAN + 59.0
    assert any("/scan: the bag is damaged" in note for note in log.notes)
    log.close()


def packed(path: Path, source: Path) -> Path:
    """Write the messages of a bag into one of small chunks that are packed."""
    writer = Writer(path)
    writer.set_compression(Writer.CompressionFormat.BZ2)
    writer.chunk_threshold = 40_000
    store = known_types(is_first=True)
    with Reader(source) as reader, writer:
        connections = {
            each.id: writer.add_connection(each.topic, each.msgtype, typestore=store)
            for each in reader.connections
        }
        for connection, time, raw in reader.messages():
            writer.write(connections[connection.id], time, raw)
    return path


def test_of_a_bag_with_a_broken_packed_chunk_the_others_are_read(tmp_path: Path) -> None:
    path = packed(tmp_path / "packed.bag", write_bag(tmp_path / "made.bag", drive(60.0)))
    data = bytearray(path.read_bytes())
    second = data.index(b"BZh", data.index(b"BZh") + 1)
    data[second + 50 : second + 80] = bytes(30)
    path.write_bytes(data)
    log = BagLog(path)
    # Each topic is read by itself, and one after another.
    for channel in log.channels:
        if channel.kind is not None:
            found = read(log, channel)
            assert found[0][0] == pytest.approx(BEGAN)
            assert found[-1][0] > BEGAN + 59.0
            assert 0.4 * channel.messages < len(found) < channel.messages
    assert any("/odom: the bag is damaged" in note for note in log.notes)
    log.close()


def test_after_a_broken_last_chunk_the_ones_before_are_read_again(tmp_path: Path) -> None:
    path = packed(tmp_path / "packed.bag", write_bag(tmp_path / "made.bag", drive(5.0)))
    data = bytearray(path.read_bytes())
    assert data.count(b"BZh") == 2
    last = data.rindex(b"BZh")
    data[last + 50 : last + 80] = bytes(30)
    path.write_bytes(data)
    bag = BagFile(path)
    first = list(bag.messages("/odom"))
    assert first
    assert list(bag.messages("/odom")) == first
    bag.close()


@pytest.mark.parametrize("kept", [0.3, 0.9])
@pytest.mark.parametrize("form", ["bag", "bag.gz"])
def test_of_a_bag_that_was_cut_short_is_read_what_is_there(
    tmp_path: Path, kept: float, form: str
) -> None:
    data = write_bag(tmp_path / "made.bag", drive(20.0)).read_bytes()
    cut = data[: int(kept * len(data))]
    path = tmp_path / f"cut.{form}"
    path.write_bytes(cut if form == "bag" else gzip.compress(cut))
    before = path.read_bytes()
    log = BagLog(path)
    [scans] = [each for each in log.channels if each.kind is Kind.SCAN]
    stamps = [stamp for stamp, _ in read(log, scans)]
    assert stamps == pytest.approx([BEGAN + PERIOD * number for number in range(len(stamps))])
    # What is cut off is the index at first, some hundredth of the file.
    assert len(stamps) == pytest.approx(100 * kept, abs=6)
    [note] = log.notes
    assert note.startswith(f"cut.{form}: its recording or copying was cut short, or it is still ")
    log.close()
    assert path.read_bytes() == before


def test_a_bag_without_an_index_is_read(tmp_path: Path) -> None:
    path = write_bag(tmp_path / "made.bag", drive(2.0))
    data = path.read_bytes()
    at = data.index(b"index_pos=") + len(b"index_pos=")
    path.write_bytes(data[:at] + bytes(8) + data[at + 8 :])
    log = BagLog(path)
    [scans] = [each for each in log.channels if each.kind is Kind.SCAN]
    assert scans.messages == 10
    log.close()


@pytest.mark.parametrize("form", ["bag", "db3", "mcap"])
def test_a_bag_of_which_nothing_is_left_is_refused_with_what_may_help(
    tmp_path: Path, form: str
) -> None:
    path = written(tmp_path, form, drive(20.0))
    data = path.read_bytes()
    path.write_bytes(data[: 5000 if form == "bag" else len(data) // 2])
    help_ = {"bag": "was cut short", "db3": ".recover", "mcap": "mcap recover"}[form]
    with pytest.raises(LogError, match=help_):
        BagLog(path)


def test_an_empty_bag_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="the bag is empty"):
        BagLog(write_bag(tmp_path / "made.bag", [], with_mount=False))


@pytest.mark.parametrize("rounds", [2, 3])
def test_a_clock_that_was_set_back_goes_on_in_the_order_of_recording(
    tmp_path: Path, rounds: int
) -> None:
    # As while a bag is played in a loop: stamps and the recorder's clock begin anew.
    items = drive(SECONDS) * rounds
    log = BagLog(write_bag(tmp_path / "made.bag", items))
    [odometry] = [each for each in log.channels if each.kind is Kind.ODOMETRY]
    [scan] = [each for each in log.channels if each.kind is Kind.SCAN]
    entries = list(log.entries([odometry, scan]))
    arrivals = [entry.arrival for entry in entries]
    assert arrivals == sorted(arrivals)
    assert [entry.stamp for entry in entries] == pytest.approx([item.stamp for item in items])
    expected = [item.value.x for item in items if isinstance(item.value, Pose)]
    found = [value.pose.x for _, value in read(log, odometry) if isinstance(value, Odometry)]
    assert found == pytest.approx(expected)
    assert log.notes == ["the recorder's clock was set back on the way: the time goes on there"]
    log.close()


def test_single_messages_of_long_ago_set_no_clock_back(tmp_path: Path) -> None:
    items = drive(SECONDS)
    late = [replace(item, arrival=item.arrival - 3.0 * (n == 42)) for n, item in enumerate(items)]
    log = BagLog(write_bag(tmp_path / "made.bag", late))
    assert log.notes == []
    log.close()


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (
            AssertionError(),
            r"cannot follow \(AssertionError\); `rosbag reindex .*made.bag` of ROS 1",
        ),
        (
            KeyError("conn"),
            r"cannot follow \(KeyError 'conn'\); .*`rosbag filter .*made.bag new.bag",
        ),
    ],
)
def test_what_the_reader_does_not_name_is_told_with_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, said: str
) -> None:
    def fail(_: Reader) -> None:
        raise error

    path = write_bag(tmp_path / "made.bag", drive(1.0))
    monkeypatch.setattr(Reader, "open", fail)
    with pytest.raises(LogError, match=said):
        BagFile(path)
    packed = tmp_path / "made.bag.gz"
    packed.write_bytes(gzip.compress(path.read_bytes()))
    with pytest.raises(LogError, match=r"unpack it first; `rosbag reindex [^`]*made\.bag`") as told:
        BagFile(packed)
    assert "reindex made.bag.gz" not in str(told.value)
