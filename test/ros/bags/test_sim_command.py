"""``./roomba sim --bag``: the contents of the bag of a run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import rosbag

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba_ros.bags.sim_bag import main
from roomba_ros.convert.common import map_of, pose_of

RATES = {
    "/clock": 10.0,
    "/tf": 10.0,
    "/odom": 10.0,
    "/pose": 10.0,
    "/ground_truth/pose": 10.0,
    "/scan": SimulatedRobotConfig().lidar.rate,
    "/battery_state": 1.0,
    "/coverage_map": 0.1,
}

AHEAD = 0.05
"""m; where its lidar is before the middle between its wheels."""


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Iterator[rosbag.Bag]:
    """A bag of the clean of a room of 2.4 x 1.6 m."""
    folder = tmp_path_factory.mktemp("run")
    values = np.full((36, 52), OCCUPIED, np.int8)
    values[2:-2, 2:-2] = FREE
    save_map(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 36, 52), values), folder / "room.yaml")
    (folder / "robot.yaml").write_text(f"lidar: {{mount_ahead: {AHEAD}}}", "utf-8")
    words = ["--map", str(folder / "room.yaml"), "--station", "0.3", "0.8", "3.1416", "--quiet"]
    words += ["--config", str(folder / "robot.yaml")]
    assert main([*words, "--bag", str(folder / "run.bag")]) == 0
    with rosbag.Bag(str(folder / "run.bag")) as opened:
        yield opened


def messages(bag: rosbag.Bag, topic: str) -> list[Any]:
    return [message for _, message, _ in bag.read_messages([topic])]


def test_topics_have_their_rates_over_the_whole_run(bag: rosbag.Bag) -> None:
    seconds = bag.get_end_time() - bag.get_start_time()
    counts = {name: info.message_count for name, info in bag.get_type_and_topic_info()[1].items()}
    assert counts.keys() == RATES.keys() | {"/map", "/tf_static", "/plan"}
    assert (counts["/map"], counts["/tf_static"]) == (1, 1)
    assert counts["/plan"] >= 1
    for topic, rate in RATES.items():
        # where something comes up every tick is looked at
        assert 0.95 * rate <= counts[topic] / seconds <= 2.1 * rate + 2.0 / seconds, topic


def test_its_sensors_are_where_the_configuration_says(bag: rosbag.Bag) -> None:
    (mounts,) = messages(bag, "/tf_static")
    frames = {each.child_frame_id: each for each in mounts.transforms}
    assert {"laser", "imu_link", "camera"} <= frames.keys()
    assert frames["laser"].header.frame_id == "base_link"
    assert frames["laser"].transform.translation.x == AHEAD


def test_the_robot_took_itself_to_be_where_it_was(bag: rosbag.Bag) -> None:
    believed = [pose_of(message) for message in messages(bag, "/pose")]
    true = [pose_of(message) for message in messages(bag, "/ground_truth/pose")]
    off = [one.distance_to(other.x, other.y) for one, other in zip(believed, true, strict=True)]
    assert max(off) < 0.05
    transforms = messages(bag, "/tf")[-1].transforms
    chain = Pose()
    for each in transforms:
        assert (each.header.frame_id, each.child_frame_id) in (
            ("map", "odom"),
            ("odom", "base_link"),
        )
        rotation = 2.0 * np.arctan2(each.transform.rotation.z, each.transform.rotation.w)
        place = each.transform.translation
        chain = chain.compose(Pose(place.x, place.y, float(rotation)))
    assert chain.distance_to(believed[-1].x, believed[-1].y) < 1e-6


def test_the_coverage_map_fills(bag: rosbag.Bag) -> None:
    swept = [np.count_nonzero(map_of(m).values == OCCUPIED) for m in messages(bag, "/coverage_map")]
    last = map_of(messages(bag, "/coverage_map")[-1]).values
    assert swept == sorted(swept)
    assert swept[0] < 0.2 * swept[-1]
    assert np.count_nonzero(last == FREE) < 0.05 * swept[-1]
    assert last.shape == map_of(messages(bag, "/map")[0]).values.shape
