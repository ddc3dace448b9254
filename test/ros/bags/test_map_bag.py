"""``./roomba map --bag``: a map of a recorded drive, and bags of which none can be made."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

import cv2
import genpy
import numpy as np
import pytest
import rosbag
from fixtures.robots.located import FURNISHED
from tf2_msgs.msg import TFMessage

from roomba.commands.map.drive.command import main
from roomba.commands.map.map_error import map_error
from roomba.commands.map.seen_floor import seen_floor
from roomba.configuration.robot import RobotConfig
from roomba.files.occupancy_map import load_map
from roomba.geometry import Pose
from roomba.grid import FREE
from roomba.headless.mission import HeadlessMission
from roomba_ros.convert.common import mount_message, odometry_message, pose_message
from roomba_ros.convert.sensors import imu_message, scan_message

BEGAN = 1_700_000_000.0
"""s; when the drive was recorded."""
START = Pose(1.4, 1.0, 0.3)
GOALS = ((3.6, 0.8), (3.8, 2.6), (1.4, 2.6), (1.5, 1.1))
SEEN = seen_floor(FURNISHED.solid, FURNISHED.frame, (START.x, START.y), RobotConfig())

Record = tuple[str, Any, float]


class RecordedRobot(HeadlessMission):
    """Notes down what its sensors say."""

    records: list[Record]

    def tick(self) -> None:
        scans = self.body.scans
        super().tick()
        seen = self.seen
        now = BEGAN + seen.time
        self._note(
            "/imu", imu_message(now, seen, self.robot_config.simulation.gyro, "imu_link"), now
        )
        odometry = odometry_message(now, seen.odometry, seen.odometry_twist, "odom", "base_link")
        self._note("/odom", odometry, now)
        self._note("/ground_truth/pose", pose_message(now, seen.pose, "map"), now)
        if self.body.scans != scans:
            ranges, taken = self.simulator.ranges, BEGAN + self.body.newest_scan().stamp
            self._note("/scan", scan_message(taken, ranges, self.robot_config.lidar, "laser"), now)

    def _note(self, topic: str, message: Any, now: float) -> None:
        self.records.append((topic, message, now))


@pytest.fixture(scope="module")
def records() -> list[Record]:
    """A drive around a room, with the usual noise."""
    robot = RecordedRobot(FURNISHED, seed=3, start=START)
    mount = mount_message("base_link", "laser", (0.0, 0.0, 0.08))
    robot.records = [("/tf_static", TFMessage([mount]), BEGAN)]
    for x, y in GOALS:
        robot.walk(x, y)
    return robot.records


def write(path: Path, records: list[Record], left_out: tuple[str, ...] = ()) -> Path:
    with rosbag.Bag(str(path), "w") as bag:
        for topic, message, time in records:
            if topic not in left_out:
                bag.write(topic, message, genpy.Time.from_sec(time))
    return path


def test_a_drive_is_mapped_as_truly_as_the_room_is(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "drive.bag", records)
    plot, out, figures = tmp_path / "map.png", tmp_path / "room", tmp_path / "map.json"
    words = ["--bag", bag, "--plot", plot, "--out", out, "--json", figures]
    assert main(list(map(str, words))) == 0
    told = capsys.readouterr().out
    assert "by odometry alone" in told
    assert "against the true poses in the bag" in told
    values = json.loads(figures.read_text("utf-8"))
    began = min(time for topic, _, time in records if topic == "/odom")
    taken = [each.header.stamp.to_sec() for topic, each, _ in records if topic == "/scan"]
    assert values["scans"] == sum(stamp >= began for stamp in taken)
    assert values["seconds"] == pytest.approx(records[-1][2] - BEGAN, abs=0.2)
    assert values["last_error_m"] <= values["largest_error_m"] < 0.03
    assert values["last_error_by_odometry_m"] <= values["largest_error_by_odometry_m"]
    assert values["width_m"] == pytest.approx(5.1, abs=0.15)
    assert values["height_m"] == pytest.approx(4.1, abs=0.15)
    assert 7.0 < values["way_m"] < 12.0
    # It came back to 14 cm from where it began.
    assert values["closure_m"] == pytest.approx(math.hypot(0.1, 0.1), abs=0.06)
    assert cv2.imread(str(plot)) is not None
    error = map_error(load_map(out / "map.yaml"), FURNISHED.frame, FURNISHED.solid, SEEN)
    assert error.walls > 0.97
    assert error.floor > 0.95
    assert error.doubled == 0


def test_by_wheels_alone_the_map_is_as_true_and_odometry_is_not(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "wheels.bag", records, ("/imu",))
    assert main(["--bag", str(bag), "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["largest_error_m"] < 0.03 < values["largest_error_by_odometry_m"]
    assert values["corrected_m"] > 0.03


def test_without_gyro_and_truth_a_map_is_made_in_a_frame_of_its_own(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "bare.bag", records, ("/imu", "/ground_truth/pose"))
    out = tmp_path / "room"
    assert main(["--bag", str(bag), "--out", str(out), "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["largest_error_m"] is values["last_error_m"] is None
    occupancy = load_map(out / "map.yaml")
    assert occupancy.values[occupancy.frame.cell_of(0.0, 0.0)] == FREE
    area = np.count_nonzero(occupancy.values == FREE) * occupancy.frame.resolution**2
    assert area == pytest.approx(np.count_nonzero(SEEN) * 0.05**2, rel=0.05)


def test_a_lidar_that_looks_back_is_known_by_its_transform(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    turned = []
    for topic, message, time in records:
        if topic == "/scan":
            message = copy.copy(message)
            message.angle_min -= math.pi
            message.angle_max -= math.pi
        if topic == "/tf_static":
            message = copy.deepcopy(message)
            rotation = message.transforms[0].transform.rotation
            rotation.x, rotation.y, rotation.z, rotation.w = 0.0, 0.0, 1.0, 0.0
        turned.append((topic, message, time))
    bag = write(tmp_path / "turned.bag", turned)
    assert main(["--bag", str(bag), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["largest_error_m"] < 0.04


def test_without_transforms_it_says_what_it_takes_the_lidar_for(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "bare.bag", records[: len(records) // 4], ("/tf_static",))
    assert main(["--bag", str(bag)]) == 0
    assert "is taken to be in the middle" in capsys.readouterr().out


def test_a_bag_without_scans_is_refused(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "bare.bag", records[:400], ("/scan",))
    assert main(["--bag", str(bag)]) == 1
    told = capsys.readouterr().err
    assert told.startswith(f"./roomba map: {bag}: ")
    assert "expected sensor_msgs/LaserScan on /scan, there is none" in told


def test_a_bag_without_odometry_is_mapped_by_its_scans_alone(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write(tmp_path / "bare.bag", records[:400], ("/odom",))
    assert main(["--bag", str(bag)]) == 0
    assert "it goes by scans alone" in " ".join(capsys.readouterr().out.split())


def test_scans_that_show_nothing_make_no_map(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = []
    for topic, message, time in records[:400]:
        if topic == "/scan":
            message = copy.copy(message)
            message.ranges = [math.inf] * len(message.ranges)
        empty.append((topic, message, time))
    bag = write(tmp_path / "empty.bag", empty)
    assert main(["--bag", str(bag)]) == 1
    assert "hardly anything in sight" in capsys.readouterr().err


def test_broken_scans_make_no_map_and_say_why(
    records: list[Record], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = []
    for topic, message, time in records[:400]:
        if topic == "/scan":
            message = copy.copy(message)
            message.ranges = []
        broken.append((topic, message, time))
    bag = write(tmp_path / "broken.bag", broken)
    assert main(["--bag", str(bag)]) == 1
    assert "no scan could be used" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ("--bag nowhere.bag", 1, "nowhere.bag: no such file; expected a bag"),
        ("--bag", 2, "expected at least one argument"),
        ("--out nowhere/at/all --bag some.bag", 2, "expected a folder, or a new one"),
        ("--bag some.png --plot some.png", 2, "is the file of --bag already"),
        ("--bag some.bag --home flat", 2, "unrecognized arguments: --home flat"),
    ],
)
def test_wrong_usage_is_told_in_a_line(
    words: str, status: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words.split()) == status
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.count("\n") == 1
    assert said in told.err
