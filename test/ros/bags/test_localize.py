"""``./roomba localize`` beside ROS: it reads rosbag's bags, and ROS reads its own."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import genpy
import pytest
import rosbag
from fixtures.drives.made_logs import BEGAN, drive, pose_at, room_map, write_bag
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from roomba_robot.msg import Localization, RobotPosition, WheelDrop
from tf2_msgs.msg import TFMessage

from roomba.commands.localize.command import main
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.perception.localization.estimate import Knowledge
from roomba.recordings.drives.choice import Wanted
from roomba.recordings.drives.drive import LoggedDrive
from roomba.recordings.readings import Kind, Lifted, OwnPose, ToldPose
from roomba_ros.convert.common import pose_message, pose_of
from roomba_ros.convert.localization import STATES, told_pose_of

REPOSITORY = Path(__file__).parents[3]
START = pose_at(0.0)
SECONDS = 4.0


@pytest.fixture
def words(tmp_path: Path) -> list[str]:
    """Options for a made drive, which begins to the right of what is told first."""
    save_map(room_map(), tmp_path / "room.yaml")
    bag = write_bag(tmp_path / "made.bag", drive(SECONDS))
    start = map(str, (START.x, START.y, START.theta))
    return ["--map", str(tmp_path / "room.yaml"), "--bag", str(bag), "--start", *start]


def test_what_was_written_are_messages_of_ros(words: list[str], tmp_path: Path) -> None:
    output, way = tmp_path / "out.bag", tmp_path / "way.txt"
    assert main([*words, "--quiet", "--out", str(output), "--trajectory", str(way)]) == 0
    rows = [list(map(float, line.split())) for line in way.read_text("utf-8").splitlines()]
    messages: dict[str, list[Any]] = {}
    with rosbag.Bag(str(output)) as written:
        connections = {each.topic: each for each in written._get_connections()}
        for topic, message, time in written.read_messages():
            messages.setdefault(topic, []).append(message)
            assert 0.0 <= time.to_sec() - BEGAN < SECONDS + 0.1
    types = {
        "/pose": PoseStamped,
        "/amcl_pose": PoseWithCovarianceStamped,
        "/localization": Localization,
        "/tf": TFMessage,
    }
    assert {topic: each.datatype for topic, each in connections.items()} == {
        topic: type_._type for topic, type_ in types.items()
    }
    # By these sums a player and a listener agree that they mean the same type.
    assert {topic: each.md5sum for topic, each in connections.items()} == {
        topic: type_._md5sum for topic, type_ in types.items()
    }
    poses = [pose_of(message) for message in messages["/pose"]]
    for pose, row in zip(poses, rows, strict=True):
        assert [pose.x, pose.y, pose.theta] == pytest.approx(row[1:], abs=1e-5)
    stamps = [message.header.stamp.to_sec() for message in messages["/pose"]]
    assert stamps == pytest.approx([row[0] for row in rows], abs=1e-5)
    assert {message.header.frame_id for message in messages["/pose"]} == {"map"}
    pose, deviation = told_pose_of(messages["/amcl_pose"][-1])
    assert pose.distance_to(*rows[-1][1:3]) < 0.1
    assert all(0.001 < each < 0.1 for each in deviation)
    assert messages["/localization"][-1].state == Localization.KNOWN
    assert messages["/localization"][-1].agreement > 0.9
    transform = messages["/tf"][0].transforms[0]
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert transform.transform.translation.x == pytest.approx(START.x, abs=0.03)


def test_states_have_the_codes_of_the_message() -> None:
    assert [STATES[knowledge] for knowledge in Knowledge] == list(range(len(Knowledge)))


def test_messages_of_this_robot_are_read(words: list[str], tmp_path: Path) -> None:
    """Recorded by rosbag, with the messages that the nodes send."""
    bag = tmp_path / "recorded.bag"
    told = PoseWithCovarianceStamped()
    told.header.frame_id = "map"
    told.pose.pose = pose_message(0.0, START, "map").pose
    told.pose.covariance[0] = told.pose.covariance[7] = 0.04
    drop = WheelDrop(is_left_dropped=True, is_right_dropped=True)
    with rosbag.Bag(words[3]) as made, rosbag.Bag(str(bag), "w") as recorder:
        for topic, message, time in made.read_messages():
            recorder.write(topic, message, time)
        for topic, message in (
            ("/initialpose", told),
            ("/wheel_drop", drop),
            ("/position", RobotPosition(1.5, -2.0)),
        ):
            recorder.write(topic, message, genpy.Time.from_sec(BEGAN + 1.0))
    beside = frozenset({Kind.LIFTED, Kind.TOLD, Kind.OWN_POSE})
    with LoggedDrive([bag], Wanted(beside=beside)) as recorded:
        readings = list(recorded.readings())
    values = [each.value for each in readings]
    assert Lifted(True) in values
    assert OwnPose(Pose(1.5, -2.0)) in values
    [start] = [each for each in values if isinstance(each, ToldPose)]
    assert start.pose.distance_to(START.x, START.y) < 1e-9
    assert start.deviation == pytest.approx((0.2, 0.1))
    [position] = [each for each in readings if isinstance(each.value, OwnPose)]
    # Without a stamp of its own: by its arrival, less the delay of the odometry.
    assert position.stamp == pytest.approx(BEGAN + 1.0 - 0.02, abs=1e-3)
    assert position.arrival == pytest.approx(BEGAN + 1.0, abs=1e-6)


def test_the_command_writes_figures_to_standard_output(words: list[str]) -> None:
    done = subprocess.run(
        [str(REPOSITORY / "roomba"), "localize", *words, "--json", "-"],
        capture_output=True,
        check=False,
        text=True,
        timeout=180.0,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["shares"]["known"] > 0.9
    assert "known" in done.stderr
