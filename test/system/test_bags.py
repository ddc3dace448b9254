"""Recording a run and playing it again."""

import itertools
import json
import math
import signal
import sys
from pathlib import Path

import pytest
import rosbag
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe, Walker
from fixtures.processes.forked import run_forked
from fixtures.waiting import wait_until
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from roomba_robot.msg import Localization, RobotPosition

from roomba.commands.localize.command import main
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.recordings.bag_format.mending import mend_bag, needs_mending
from roomba.recordings.bags.exporting import Form, export_bag

NAMES = ("pose", "amcl")


SCAN_PERIOD = 1.0 / SimulatedRobotConfig().lidar.rate
"""s; between two scans of the robot's lidar."""


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short walk, recorded with everything."""
    folder = tmp_path_factory.mktemp("recorded")
    path = folder / "test.bag"
    with RosGraph(folder) as graph:
        graph.launch("speed:=3")
        recorder = graph.run("rosbag", "record", "-a", "-O", str(path))
        own = graph.run(sys.executable, "-m", "roomba_ros.bags.record", str(folder / "own.bag"))
        wait_until(lambda: path.with_suffix(".bag.active").exists(), 30.0, "the recorder records")
        sensors = ("/odom", "/imu", "/scan", "/clock", "/tf", "/tf_static", "/amcl_pose")
        topics = (*sensors, "/position", "/walk_to_point/status", "/map")
        wait_until(lambda: recording(graph, *topics), 30.0, "the recorder hears the robot")
        run_forked(lambda: walk(graph))
        own.send(signal.SIGKILL)
        recorder.send(signal.SIGINT)
        wait_until(path.exists, 30.0, "the recorder closes the bag")
    return path


def recording(graph: RosGraph, *topics: str) -> bool:
    """Whether both recorders hear topics."""
    _, subscribers, _ = graph.system_state()
    return all(sum("record" in node for node in subscribers.get(t, [])) == 2 for t in topics)


def walk(graph: RosGraph) -> None:
    probe = Probe(graph)
    probe.position()
    walker = Walker()
    # The recorder looks for new topics once a second; this client has just made these.
    wait_until(lambda: walker.listeners >= 3, 30.0, "server and recorders hear the client")
    walker.send(1.5, 2.0)
    walker.arrives(30.0)
    # A busy recorder hears of that later than this client.
    for _ in range(20):
        probe.position()


def positions(path: Path) -> list[tuple[float, float]]:
    with rosbag.Bag(str(path)) as recorded:
        return [(m.pos_x, m.pos_y) for _, m, _ in recorded.read_messages("/position")]


def on_the_way(track: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Leave out where it stood at first, which recorders heard for different times."""
    return track[next(n for n, place in enumerate(track) if math.dist(place, track[0]) > 0.05) :]


def test_our_own_recorder_loses_less_than_a_second_when_it_is_killed(bag: Path) -> None:
    own = bag.with_name("own.bag")
    mended = mend_bag(own) if needs_mending(own) else None
    assert mended is None or mended.messages > 1000
    told, kept = on_the_way(positions(bag)), on_the_way(positions(own))
    # A busy rosbag leaves out some of its own: what it has, ours has, in that order, to the end.
    ours = iter(kept)
    lost = list(itertools.dropwhile(lambda place: place in ours, told))
    # Three of the robot's seconds are one, in which it tells thirty positions.
    assert len(lost) <= 30
    assert len(kept) >= len(told) - len(lost)
    with rosbag.Bag(str(bag)) as theirs, rosbag.Bag(str(own)) as mine:
        topics = mine.get_type_and_topic_info().topics
        everything = theirs.get_type_and_topic_info().topics
    missing = {name for name in everything if "/camera/" not in name} - topics.keys()
    assert missing <= {"/rosout", "/rosout_agg"}
    assert not any("/camera/" in name for name in topics)


def test_it_is_exported_with_the_types_of_this_robot(bag: Path) -> None:
    path = bag.with_name("own.mcap")
    export_bag(bag.with_name("own.bag"), path, Form.MCAP)
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        newest = {
            channel.topic: message for _, channel, _, message in reader.iter_decoded_messages()
        }
    assert newest["/vacuum/state"].battery > 0.9
    assert newest["/walk_to_point/result"].status.status == 3
    assert newest["/map"].info.width > 100
    with rosbag.Bag(str(bag.with_name("own.bag"))) as ours:
        assert newest.keys() == ours.get_type_and_topic_info().topics.keys()


def test_every_topic_is_recorded(bag: Path) -> None:
    with rosbag.Bag(str(bag)) as recorded:
        topics = set(recorded.get_type_and_topic_info().topics)
    assert {
        "/position", "/speed", "/dirt", "/odom", "/map", "/tf", "/clock", "/bumper",
        "/change_position", "/change_speed", "/cmd_vel", "/cmd_vel_out", "/plan",
        "/walk_to_point/goal", "/walk_to_point/feedback", "/walk_to_point/result",
        "/walk_to_point/status",
    } <= topics  # fmt: skip
    track = positions(bag)
    assert math.dist(track[0], (0.0, 0.0)) < 0.3
    assert math.dist(track[-1], (1.5, 2.0)) < 0.1


@pytest.mark.parametrize("clock", [(), ("--clock", "/clock:=/recorded_clock")])
def test_a_replay_shows_the_same_run(bag: Path, graph: RosGraph, clock: tuple[str, ...]) -> None:
    graph.set_param("/use_sim_time", True)
    probe = Probe(graph)
    heard: list[tuple[float, float]] = []
    rospy.Subscriber("/position", RobotPosition, lambda m: heard.append((m.pos_x, m.pos_y)))
    probe.hear("/position", RobotPosition)
    # One that ends with its bag takes along what a busy listener has not read yet.
    player = graph.run("rosbag", "play", "-k", "-d", "2", "-r", "4", "-q", str(bag), *clock)
    recorded = positions(bag)
    wait_until(lambda: heard[-1:] == recorded[-1:], 60.0, "the end of the run")
    player.send(signal.SIGINT)
    assert player.ends(20.0) == 0
    assert len(heard) > 0.8 * len(recorded)
    assert set(heard) <= set(recorded)


def test_a_recording_is_localized_and_what_was_found_is_played(
    bag: Path, graph: RosGraph, tmp_path: Path
) -> None:
    output, figures = tmp_path / "localized.bag", tmp_path / "figures.json"
    words = ["--map", HOMES / "flat" / "map.yaml", "--bag", bag, "--quiet"]
    assert main(list(map(str, [*words, "--out", output, "--json", figures]))) == 0
    values = json.loads(figures.read_text("utf-8"))
    # The recorder may hear the first scans seconds after the rest.
    seen = values["scans"] * SCAN_PERIOD / values["seconds"]
    assert values["shares"]["known"] > 0.8 * seen > 0.4
    assert values["differences"][0]["median"] < 0.05
    graph.set_param("/use_sim_time", True)
    probe = Probe(graph)
    ends: dict[str, tuple[float, float]] = {}
    rospy.Subscriber("/pose", PoseStamped, lambda m: ends.update(pose=place_of(m.pose)))
    rospy.Subscriber(
        "/amcl_pose", PoseWithCovarianceStamped, lambda m: ends.update(amcl=place_of(m.pose.pose))
    )
    probe.hear("/localization", Localization)
    player = graph.run("rosbag", "play", "-d", "2", "-r", "4", "-q", "--clock", str(output))
    wait_until(
        lambda: probe.next("/localization", Localization).state == Localization.KNOWN,
        20.0,
        "a known place",
    )
    assert player.ends(60.0) == 0
    wait_until(
        lambda: all(math.dist(ends.get(topic, (0.0, 0.0)), (1.5, 2.0)) < 0.1 for topic in NAMES),
        10.0,
        "the end of the run",
    )


def place_of(pose: PoseMessage) -> tuple[float, float]:
    return pose.position.x, pose.position.y


def wait_for_a_jump_back() -> None:
    reached = 0.0

    def is_back() -> bool:
        nonlocal reached
        now = rospy.get_time()
        reached = max(reached, now)
        return bool(now < reached - 1.0)

    wait_until(is_back, 40.0, "the clock jumps back")


@pytest.mark.thorough
def test_nodes_go_on_while_a_bag_is_played_in_a_loop(bag: Path, graph: RosGraph) -> None:
    """The recorded clock jumps back at the end of every round."""
    graph.set_param("/use_sim_time", True)
    node = graph.rosrun("speed_pub_node.py", "speed:=/speed_again", "cmd_vel_out:=/nowhere")
    probe = Probe(graph)
    graph.run("rosbag", "play", "--loop", "-q", "-r", "4", str(bag))
    from std_msgs.msg import Float32

    probe.hear("/speed_again", Float32)
    for _ in range(2):
        wait_for_a_jump_back()
    probe.next("/speed_again", Float32)
    assert node.status is None
