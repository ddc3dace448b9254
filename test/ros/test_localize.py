"""``./roomba localize``: recorded drives, whole and broken ones."""

from __future__ import annotations

import copy
import csv
import json
import math
import os
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import genpy
import numpy as np
import pytest
import rosbag
from fixtures.located import CONFIG, FURNISHED
from geometry_msgs.msg import PoseWithCovarianceStamped, Quaternion
from PIL import Image as Picture
from PIL import ImageColor
from roomba_robot.msg import Localization
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose, Twist
from roomba.headless.cleaner import HeadlessMission
from roomba.plots.style import BLUE
from roomba_ros.bags.localize_bag import main
from roomba_ros.bags.localize_recording import Heard, MessageKind
from roomba_ros.bags.localize_replay import Replay
from roomba_ros.convert.common import mount_message, odometry_message, pose_message
from roomba_ros.convert.mounts import Mounts
from roomba_ros.convert.sensors import imu_message, scan_message, wheel_drop_message

BEGAN = 1_700_000_000.0
"""s; when the drive was recorded."""
START = Pose(1.4, 1.0, 0.3)
GOALS = ((3.6, 0.8), (3.8, 2.6), (1.4, 1.2))
OFFSET = 0.1
"""m; how far what the bag calls the robot's own pose is from the truth."""
REPOSITORY = Path(__file__).parents[2]

Record = tuple[str, Any, float]
"""Topic, message, and time of its recording, s."""


@dataclass
class Drive:
    """What was recorded on a drive, and where the robot truly was at its end."""

    records: list[Record] = field(default_factory=list)
    end: Pose = START


class RecordedRobot(HeadlessMission):
    """Notes down what its sensors say, as the simulator's node would tell it."""

    drive: Drive

    def tick(self) -> None:
        scans = self.body.scans
        super().tick()
        seen = self.seen
        now = BEGAN + seen.time
        self._note("/imu", imu_message(now, seen, self.robot.simulation.gyro, "imu_link"), now)
        odometry = odometry_message(now, seen.odometry, seen.odometry_twist, "odom", "base_link")
        self._note("/odom", odometry, now)
        self._note("/wheel_drop", wheel_drop_message(now, seen.wheels, "base_link"), now)
        if self.body.scans != scans:
            scan = scan_message(now, self.simulator.ranges, self.robot.lidar, "laser")
            self._note("/scan", scan, now)
        beside = Pose(seen.pose.x + OFFSET, seen.pose.y, seen.pose.theta)
        self._note("/pose", pose_message(now, beside, "map"), now)
        self.drive.end = seen.pose

    def _note(self, topic: str, message: Any, now: float) -> None:
        self.drive.records.append((topic, message, now))


def recorded_robot(seed: int) -> RecordedRobot:
    """Return a robot in a furnished room, with the usual noise."""
    robot = RecordedRobot(FURNISHED, seed=seed, start=START)
    mount = mount_message("base_link", "laser", (0.0, 0.0, 0.08))
    robot.drive = Drive([("/tf_static", TFMessage([mount]), BEGAN)])
    return robot


@pytest.fixture(scope="module")
def drive() -> Drive:
    """A short drive."""
    robot = recorded_robot(seed=3)
    for x, y in GOALS:
        robot.walk(x, y)
    return robot.drive


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The room's map."""
    path = tmp_path_factory.mktemp("room") / "room.yaml"
    save_map(FURNISHED.map, path)
    return path


@dataclass
class Localized:
    """What one run of the program said and wrote."""

    status: int
    output: str
    error: str
    figures: dict[str, Any]
    rows: list[dict[str, str]]

    def is_at(self, pose: Pose) -> bool:
        """Whether the last row is at a pose, known."""
        last = self.rows[-1]
        distance = pose.distance_to(float(last["x"]), float(last["y"]))
        turn = abs(math.remainder(float(last["theta"]) - pose.theta, 2.0 * math.pi))
        return last["state"] == "known" and distance < 0.05 and turn < 0.05


Localize = Callable[..., Localized]


@pytest.fixture
def localize(room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Localize:
    """Run the program on a bag in this process, with more arguments."""

    def run(bag: Path, *arguments: object, map_: Path = room) -> Localized:
        figures, rows = tmp_path / "figures.json", tmp_path / "rows.csv"
        given = ["--map", map_, "--bag", bag, "--json", figures, "--csv", rows, *arguments]
        try:
            status = main(list(map(str, given)))
        except SystemExit as end:  # of a command line that argparse refuses
            status = int(str(end.code))
        output, error = capsys.readouterr()
        if status:
            return Localized(status, output, error, {}, [])
        with rows.open(encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        return Localized(status, output, error, json.loads(figures.read_text("utf-8")), table)

    return run


def write(path: Path, records: list[Record], **options: Any) -> Path:
    """Write a bag."""
    with rosbag.Bag(str(path), "w", **options) as bag:
        for topic, message, time in records:
            bag.write(topic, message, genpy.Time.from_sec(time))
    return path


def stamped(message: Any, shift: float) -> Any:
    """Return a message with its stamp shifted by so much, s."""
    if not hasattr(message, "header"):
        return message
    message = copy.copy(message)
    message.header = copy.copy(message.header)
    message.header.stamp = genpy.Time.from_sec(message.header.stamp.to_sec() + shift)
    return message


def at_start() -> list[object]:
    return ["--start", START.x, START.y, START.theta]


# ---------------------------------------------------------------- whole drives


def test_a_drive_is_followed_from_a_given_start(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    bag = write(tmp_path / "drive.bag", drive.records)
    plot, output = tmp_path / "drive.png", tmp_path / "localized.bag"
    done = localize(bag, *at_start(), "--plot", plot, "--output", output)
    assert done.status == 0
    assert done.is_at(drive.end)
    assert done.figures["shares"]["known"] > 0.98
    scans = sum(topic == "/scan" for topic, *_ in drive.records)
    assert scans - 1 <= done.figures["scans"] <= scans
    assert done.figures["seconds"] == pytest.approx(drive.records[-1][2] - BEGAN, abs=0.2)
    assert 5.0 < done.figures["way"] < 9.0
    assert float(done.rows[0]["t"]) == pytest.approx(BEGAN, abs=0.2)
    (difference,) = done.figures["differences"]
    assert difference["topic"] == "/pose"
    assert difference["median"] == pytest.approx(OFFSET, abs=0.02)
    assert "known 99." in done.output
    assert "\x1b" not in done.output + done.error
    with Picture.open(plot) as picture:
        assert picture.width >= 800
        counted = picture.convert("RGB").getcolors(1_000_000)
    colours = {colour: count for count, colour in counted or []}
    assert colours[ImageColor.getrgb(BLUE)] > 1000
    with rosbag.Bag(str(output)) as written:
        topics = written.get_type_and_topic_info().topics
        messages = list(written.read_messages())
    assert set(topics) == {"/pose", "/amcl_pose", "/tf", "/localization"}
    assert topics["/pose"].message_count == len(done.rows)
    assert all(abs(time.to_sec() - BEGAN) < 60.0 for *_, time in messages)
    states = [message.state for topic, message, _ in messages if topic == "/localization"]
    assert states.count(Localization.KNOWN) >= 15
    transform = next(message.transforms[0] for topic, message, _ in messages if topic == "/tf")
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert transform.transform.translation.x == pytest.approx(START.x, abs=0.03)


def test_without_a_start_it_finds_its_place(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    done = localize(write(tmp_path / "drive.bag", drive.records))
    assert done.is_at(drive.end)
    # Files begin when the place is first known: before that there is no pose to write.
    assert done.rows[0]["state"] == "known"
    assert done.figures["found_after"] < 5.0
    assert "searched for in the whole map" in done.output


def test_a_scan_waits_until_odometry_has_reached_its_last_beam() -> None:
    replay = Replay(FURNISHED.map, CONFIG, Mounts(), "base_link", START)
    scan = scan_message(BEGAN + 1.0, np.ones(360, np.float32), CONFIG.with_lidar("neato").lidar, "")
    sweep = scan.time_increment * 359
    assert sweep > 0.1

    def hear(kind: MessageKind, stamp: float, message: Any) -> int:
        replay.hear(Heard(stamp, kind, message, stamp, 0.0))
        return replay.scans

    def drive_on(stamp: float) -> int:
        odometry = odometry_message(stamp, Pose(), Twist(0.0, 0.0), "odom", "base_link")
        return hear(MessageKind.ODOMETRY, stamp, odometry)

    assert drive_on(BEGAN + 0.9) == 0
    assert hear(MessageKind.SCAN, BEGAN + 1.0, scan) == 0
    assert drive_on(BEGAN + 1.05) == 0
    assert drive_on(BEGAN + 1.01 + sweep) == 1


@pytest.mark.parametrize("topic", ["/initialpose", "/amcl_pose"])
def test_a_recorded_pose_is_the_start(
    drive: Drive, localize: Localize, tmp_path: Path, topic: str
) -> None:
    told = PoseWithCovarianceStamped()
    told.pose.pose = pose_message(0.0, START, "map").pose
    told.header.frame_id = "map"
    records = [*drive.records[:2], (topic, told, BEGAN), *drive.records[2:]]
    done = localize(write(tmp_path / "drive.bag", records))
    assert done.figures["start"] == f"as recorded on {topic}"
    assert all(row["state"] != "searching" for row in done.rows)
    assert done.is_at(drive.end)


def test_the_plainest_bag_will_do(drive: Drive, localize: Localize, tmp_path: Path) -> None:
    records = [record for record in drive.records if record[0] in ("/scan", "/odom")]
    done = localize(write(tmp_path / "drive.bag", records))
    assert done.is_at(drive.end)
    assert done.figures["differences"] == []
    assert any("no transform from 'base_link' to 'laser'" in note for note in done.figures["notes"])


def test_a_lidar_of_few_beams_that_sees_but_what_is_ahead(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    """60 beams from -90 to 90 degrees."""
    records = []
    for topic, message, time in drive.records:
        if topic == "/scan":
            message = copy.copy(message)
            message.angle_min, message.angle_increment = -math.pi / 2.0, math.radians(3.0)
            message.ranges = [message.ranges[(270 + 3 * beam) % 360] for beam in range(60)]
        records.append((topic, message, time))
    done = localize(write(tmp_path / "drive.bag", records), *at_start())
    assert done.is_at(drive.end)
    assert done.figures["shares"]["known"] > 0.95


def test_a_robot_with_other_names_for_its_topics(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    names = {"/scan": "/kitchen/base_scan", "/odom": "/kitchen/odom", "/pose": "/kitchen/pose"}
    records = [(names.get(topic, topic), message, time) for topic, message, time in drive.records]
    bag = write(tmp_path / "drive.bag", records)
    refused = localize(bag)
    assert refused.status == 1
    assert "--scan-topic /kitchen/base_scan" in refused.error
    assert "/kitchen/odom (nav_msgs/Odometry)" in refused.error
    assert refused.error.count("\n") == 1
    given = ("--scan-topic", "/kitchen/base_scan", "--odom-topic", "kitchen/odom")
    done = localize(bag, *given)
    assert done.is_at(drive.end)
    assert done.figures["differences"][0]["topic"] == "/kitchen/pose"


def test_a_lidar_that_hangs_upside_down_in_a_corner(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    """Its beams go clockwise; where it is stands in two transforms, one of them on /tf."""
    turned = mount_message("base_link", "plate", (0.0, 0.0, 0.1))
    turned.transform.rotation = Quaternion(0.0, 0.0, math.sin(0.25), math.cos(0.25))
    hanging = mount_message("plate", "laser", (0.0, 0.0, 0.0))
    hanging.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    # What odometry tells of need not be the root of all frames.
    base = mount_message("base_footprint", "base_link", (0.5, -0.2, 0.0))
    base.transform.rotation = Quaternion(0.0, 0.0, 1.0, 0.0)
    records: list[Record] = [("/tf_static", TFMessage([base, turned]), BEGAN)]
    records.append(("/tf", TFMessage([hanging]), BEGAN))
    for topic, message, time in drive.records[1:]:
        if topic == "/scan":
            message = copy.copy(message)
            # A beam at the angle a of this lidar looks to 0.5 - a of the robot.
            message.angle_min, message.ranges = 0.5, message.ranges[:1] + message.ranges[:0:-1]
        records.append((topic, message, time))
    assert localize(write(tmp_path / "drive.bag", records)).is_at(drive.end)


def test_a_gyro_that_hangs_upside_down(drive: Drive, localize: Localize, tmp_path: Path) -> None:
    """After a second without a lidar, so that wheels and gyro are all there is."""
    hanging = mount_message("base_link", "imu_link", (0.0, 0.0, 0.0))
    hanging.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    records: list[Record] = [("/tf_static", TFMessage([hanging]), BEGAN)]
    for topic, message, time in drive.records:
        if topic == "/imu":
            message = copy.deepcopy(message)
            message.angular_velocity.z *= -1.0
        if topic != "/scan" or time < BEGAN + 1.0:
            records.append((topic, message, time))
    done = localize(write(tmp_path / "drive.bag", records), *at_start())
    last = done.rows[-1]
    assert last["state"] == "rough"
    assert drive.end.distance_to(float(last["x"]), float(last["y"])) < 0.3


def test_it_says_where_and_why_a_robot_was_lost(localize: Localize, tmp_path: Path) -> None:
    """It is slid to another corner, without lifting its wheels."""
    robot = recorded_robot(seed=4)
    robot.walk(3.0, 0.8)
    slid = robot.drive.records[-1][2] - BEGAN
    robot.simulator.put(Pose(1.5, 3.0, 2.0))
    robot.walk(3.6, 0.8)
    bag, plot = write(tmp_path / "drive.bag", robot.drive.records), tmp_path / "drive.png"
    done = localize(bag, *at_start(), "--plot", plot)
    assert done.is_at(robot.drive.end)
    (loss,) = done.figures["losses"]
    assert slid < loss["elapsed"] < slid + 2.0
    assert math.dist((loss["x"], loss["y"]), (3.0, 0.8)) < 0.3
    assert "does not fit the map" in loss["reason"]
    assert "does not fit the map" in done.output
    assert plot.stat().st_size > 10_000


# ---------------------------------------------------------------- odd recordings


def test_a_clock_that_jumps_back(drive: Drive, localize: Localize, tmp_path: Path) -> None:
    half = BEGAN + 5.0
    records = [
        (topic, stamped(message, -4.0 * (time > half)), time - 4.0 * (time > half))
        for topic, message, time in drive.records
    ]
    done = localize(write(tmp_path / "drive.bag", records), *at_start())
    times = [float(row["t"]) for row in done.rows]
    assert min(np.diff(times)) < -3.0
    assert "the clock was set back on the way" in done.figures["notes"]
    assert done.figures["shares"]["known"] > 0.95
    assert done.is_at(drive.end)


def test_the_order_in_a_bag_does_not_matter(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    """Some arrive late by tenths of a second; and some programs write topic after topic."""
    random = np.random.default_rng(0)
    straight = localize(write(tmp_path / "straight.bag", drive.records), *at_start())
    late = [
        (topic, message, time + float(random.uniform(0.0, 0.4)))
        for topic, message, time in drive.records
    ]
    late.sort(key=lambda record: record[2])
    by_topic = sorted(drive.records, key=lambda record: record[0])
    for name, records in (("late", late), ("by topic", by_topic)):
        done = localize(write(tmp_path / f"{name}.bag", records), *at_start())
        assert done.rows == straight.rows, name


def test_a_lidar_whose_clock_is_wrong(drive: Drive, localize: Localize, tmp_path: Path) -> None:
    records = [
        (topic, stamped(message, 77.0) if topic == "/scan" else message, time)
        for topic, message, time in drive.records
    ]
    done = localize(write(tmp_path / "drive.bag", records), *at_start())
    assert done.is_at(drive.end)
    assert any("clock of /scan is +77.0 s off" in note for note in done.figures["notes"])


def test_numbers_that_are_not_finite_are_left_out(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    records = list(drive.records)
    for at in range(100, len(records), 50):
        topic, message, time = records[at]
        if topic == "/odom":
            message = copy.deepcopy(message)
            message.pose.pose.position.x = math.nan
        if topic == "/scan":
            message = copy.copy(message)
            message.ranges = []
        records[at] = (topic, message, time)
    done = localize(write(tmp_path / "drive.bag", records), *at_start())
    assert done.is_at(drive.end)
    assert any("odometry with numbers that are not finite" in n for n in done.figures["notes"])


def test_a_bag_that_was_cut_short_is_read_after_it_was_mended(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    bag = write(tmp_path / "drive.bag", drive.records, chunk_threshold=20_000)
    os.truncate(bag, bag.stat().st_size * 2 // 3)
    refused = localize(bag, *at_start())
    assert refused.status == 1
    assert f"rosbag reindex {bag}" in refused.error
    assert refused.error.count("\n") == 1
    with rosbag.Bag(str(bag), "a", allow_unindexed=True) as mended:
        for _ in mended.reindex():
            pass
    done = localize(bag, *at_start())
    assert done.status == 0
    assert 0.4 < done.figures["seconds"] / (drive.records[-1][2] - BEGAN) < 0.8
    assert done.figures["shares"]["known"] > 0.98


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_bag_that_is_damaged_in_its_middle(
    drive: Drive, localize: Localize, tmp_path: Path, compression: str
) -> None:
    bag = write(
        tmp_path / "drive.bag", drive.records, chunk_threshold=50_000, compression=compression
    )
    with bag.open("r+b") as file:
        file.seek(bag.stat().st_size // 2)
        file.write(b"\xff" * 3000)
    done = localize(bag, *at_start())
    assert done.status == 0
    assert any("the bag is damaged there" in note for note in done.figures["notes"])
    assert done.is_at(drive.end)


# ---------------------------------------------------------------- what is refused


def text_file(path: Path) -> None:
    path.write_text("this is no bag\n", encoding="utf-8")


def noise_file(path: Path) -> None:
    path.write_bytes(np.random.default_rng(1).bytes(5000))


def empty_bag(path: Path) -> None:
    write(path, [])


def bag_of_words(path: Path) -> None:
    write(path, [("/scan", String("words"), 1.0), ("/talk", String("words"), 2.0)])


def bag_without_odometry(path: Path) -> None:
    scan = scan_message(1.0, np.ones(360, np.float32), CONFIG.lidar, "laser")
    write(path, [("/scan", scan, 1.0)])


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda path: None, "no such file"),
        (Path.mkdir, "a folder"),
        (Path.touch, "the file is empty"),
        (text_file, "expected a bag of ROS 1"),
        (noise_file, "expected a bag of ROS 1"),
        (empty_bag, "the bag is empty"),
        (bag_of_words, "expected sensor_msgs/LaserScan on /scan, it is std_msgs/String"),
        (bag_without_odometry, "expected nav_msgs/Odometry on /odom, there is none"),
    ],
)
def test_what_is_no_recording_of_a_drive_is_refused_in_a_line(
    localize: Localize, tmp_path: Path, make: Callable[[Path], None], said: str
) -> None:
    bag = tmp_path / "given.bag"
    make(bag)
    refused = localize(bag)
    assert refused.status == 1
    assert said in refused.error
    assert refused.error.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--start", "nan", "0", "0"), "expected finite numbers (m, m, rad), got 'nan'"),
        (("--start", "-inf", "0", "0"), "expected finite numbers (m, m, rad), got '-inf'"),
        (("--start", "-1e9", "0", "0"), "expected a place on the map, x -0.1 to 5.1"),
        (("--start", "1", "1"), "expected 3 arguments"),
        (("--plot", "drive.gif"), "ends with .png"),
        (("--output", "/no/such/folder/a.bag"), "in a folder that is there"),
        (("--colour", "red"), "unrecognized arguments"),
    ],
)
def test_what_cannot_be_done_is_refused_in_a_line(
    drive: Drive, localize: Localize, tmp_path: Path, arguments: tuple[str, ...], said: str
) -> None:
    refused = localize(write(tmp_path / "drive.bag", drive.records[:50]), *arguments)
    assert refused.status == 2
    assert said in refused.error
    assert refused.error.count("\n") == 1


def test_a_bag_is_not_written_over(drive: Drive, localize: Localize, tmp_path: Path) -> None:
    bag = write(tmp_path / "drive.bag", drive.records[:50])
    before = bag.read_bytes()
    (tmp_path / "link.bag").symlink_to(bag)
    assert localize(bag, "--output", tmp_path / "link.bag").status == 2
    assert bag.read_bytes() == before


def test_a_map_that_cannot_be_read_is_refused_in_a_line(
    drive: Drive, localize: Localize, tmp_path: Path
) -> None:
    bag, broken = write(tmp_path / "drive.bag", drive.records[:50]), tmp_path / "broken.yaml"
    for text in ("image: [", "image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"):
        broken.write_text(text, encoding="utf-8")
        refused = localize(bag, map_=broken)
        assert refused.status == 1
        assert str(broken) in refused.error
        assert refused.error.count("\n") == 1
    assert localize(bag, map_=tmp_path / "none.yaml").status == 1


def test_the_command_writes_figures_to_standard_output(
    drive: Drive, room: Path, tmp_path: Path
) -> None:
    bag = write(tmp_path / "drive.bag", drive.records[:600])
    command = [REPOSITORY / "roomba", "localize", "--map", room, "--bag", bag, "--json", "-"]
    done = subprocess.run(
        list(map(str, [*command, *at_start()])),
        capture_output=True,
        check=False,
        text=True,
        timeout=180.0,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["shares"]["known"] > 0.98
    assert "known 99." in done.stderr
