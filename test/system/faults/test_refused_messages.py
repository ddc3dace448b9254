"""Messages that make no sense have no effect on a robot that cleans, nor do forged ones."""

import itertools
import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from fixtures.graph import LAUNCHED, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.nodes.malformed import CANNOT_BE_WRONG, has_numbers, malformed, not_finite
from fixtures.nodes.onlooker import Onlooker
from fixtures.waiting import wait_until
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from roomba_robot.srv import EmergencyStop
from rosgraph_msgs.msg import Log
from roslib.message import get_message_class
from std_msgs.msg import String
from std_srvs.srv import Trigger

FLOOD = 200
"""Messages of one topic, sent as fast as one can steer."""
FORGED = 80
"""Commands of a program that wants to drive a robot that is held."""
OF_OTHER_BODIES = {"roomba_robot/LineTrouble", "std_msgs/UInt16"}
"""Kinds that nodes hear of a robot on a line, or of a body that tells in several messages."""

Counts = dict[tuple[str, str], int]
"""How many messages were refused by node and topic, both without slashes before them."""


@pytest.fixture(scope="module")
def shared_robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """The whole robot in two little rooms, in real time."""
    folder = tmp_path_factory.mktemp("robot")
    with RosGraph(folder) as own:
        own.launch(f"home:={tiny_home(folder)}")
        yield own


class Witness(Onlooker):
    """Hears what the vacuum does, what nodes log, and what they say that they refused."""

    def __init__(self, graph: RosGraph) -> None:
        super().__init__(graph)
        self.lines: Counter[str] = Counter()
        self.counts: Counts = {}
        rospy.Subscriber("/rosout", Log, self._on_line)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)

    def _on_line(self, line: Log) -> None:
        node = line.name.strip("/")
        if node in LAUNCHED and line.level >= Log.WARN:
            self.lines[node] += 1

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            node, _, part = status.name.partition(": ")
            if part == "messages":
                for value in status.values:
                    self.counts[node, value.key.strip("/")] = int(value.value)

    def is_heard(self, publisher: rospy.Publisher, ears: int) -> None:
        """Wait until so many nodes hear a publisher."""
        wait_until(lambda: publisher.get_num_connections() >= ears, 30.0)

    def hears_refusals(self, expected: Counts, what: str) -> None:
        """Wait until nodes told that they refused so many messages."""
        wait_until(
            lambda: all(self.counts.get(each, 0) >= count for each, count in expected.items()),
            10.0,
            lambda: f"{what}: {missing(expected, self.counts)}",
        )

    def stops(self) -> None:
        """Let it end what it does."""
        assert rospy.ServiceProxy("/stop", Trigger)().success
        wait_until(lambda: self.state.phase == "idle", 30.0, lambda: f"it stops: {self.state}")


def heard(graph: RosGraph) -> dict[str, tuple[str, list[str]]]:
    """Return the type of each topic that nodes of the robot hear, and these nodes."""
    types = graph.topic_types()
    _, subscribers, _ = graph.system_state()
    own = {
        topic: [node.strip("/") for node in nodes if node.strip("/") in LAUNCHED]
        for topic, nodes in subscribers.items()
    }
    return {topic: (types[topic], nodes) for topic, nodes in own.items() if nodes}


def test_what_cannot_be_wrong_is_said_with_the_reason(shared_robot: RosGraph) -> None:
    types = {kind for kind, _ in heard(shared_robot).values()}
    assert {kind for kind in types if not malformed(kind)} == types & set(CANNOT_BE_WRONG)
    assert set(CANNOT_BE_WRONG) <= types | OF_OTHER_BODIES


def test_bad_messages_on_every_topic_are_refused_and_have_no_effect(
    shared_robot: RosGraph,
) -> None:
    witness, topics = Witness(shared_robot), heard(shared_robot)
    bad = {topic: malformed(kind) for topic, (kind, _) in topics.items() if malformed(kind)}
    publishers = {
        topic: witness.probe.publisher(topic, type(next(iter(messages.values()))))
        for topic, messages in bad.items()
    }
    for topic, publisher in publishers.items():
        witness.is_heard(publisher, len(topics[topic][1]))
    witness.cleans()
    pids = {node: shared_robot.pid(node) for node in LAUNCHED}
    witness.states.clear()
    witness.lines.clear()
    began, identities = time.monotonic(), itertools.count()
    sent: Counter[str] = Counter()
    for what in sorted({what for messages in bad.values() for what in messages}):
        for topic in (topic for topic, messages in bad.items() if what in messages):
            message = bad[topic][what]
            if hasattr(message, "goal_id"):
                message.goal_id.id = f"bad {next(identities)}"
            publishers[topic].publish(message)
            sent[topic] += 1
        # One at a time: of several that come at once a node hears the last.
        expected = {
            (node, topic.strip("/")): count
            for topic, count in sent.items()
            for node in topics[topic][1]
        }
        witness.hears_refusals(expected, what)
    flood(witness)
    elapsed = time.monotonic() - began
    witness.goes_on()

    assert {node: shared_robot.pid(node) for node in LAUNCHED} == pids
    assert set(witness.states) == {"cleaning"}
    assert {node: count for node, count in witness.lines.items() if count > elapsed + 2.0} == {}
    assert set(witness.lines) >= {node for topic in bad for node in topics[topic][1]}
    witness.stops()


def test_forged_commands_and_a_forged_release_do_not_move_a_held_robot(
    shared_robot: RosGraph,
) -> None:
    witness = Witness(shared_robot)
    witness.cleans()
    hold = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    assert hold(True, "a child").success
    speeds: list[float] = []
    rospy.Subscriber("/odom", Odometry, lambda odom: speeds.append(odom.twist.twist.linear.x))
    wait_until(lambda: speeds and speeds[-1] == 0.0, 10.0, "it stands")
    speeds.clear()
    before = witness.counts.get(("home_sim_node", "cmd_vel_out"), 0)
    ahead = Twist()
    ahead.linear.x = 0.3

    def are_refused() -> bool:
        witness.probe.send("/emergency_stop", String(""), receivers=2)
        witness.probe.send("/cmd_vel_out", ahead)
        return witness.counts.get(("home_sim_node", "cmd_vel_out"), 0) >= before + FORGED

    # A program that drives fifty times a second; of what comes at once a node hears the last.
    wait_until(are_refused, 20.0, "the forged commands are refused", pause=0.02)
    assert speeds
    assert set(speeds) == {0.0}
    assert witness.state.phase == "emergency stop"
    assert hold(False, "").success
    wait_until(lambda: witness.state.phase == "paused", 20.0, lambda: f"released: {witness.state}")
    witness.stops()


def test_a_second_node_that_tells_the_place_is_noticed_and_the_robot_stands(
    shared_robot: RosGraph,
) -> None:
    witness = Witness(shared_robot)
    witness.cleans()
    forger = witness.probe.publisher("/pose", PoseStamped)
    witness.is_heard(forger, 4)
    forged = PoseStamped()
    forged.header.frame_id, forged.pose.orientation.w = "map", 1.0
    turning: list[float] = []
    rospy.Subscriber("/odom", Odometry, lambda odom: turning.append(odom.twist.twist.angular.z))

    def stands() -> bool:
        forged.header.stamp = rospy.Time.now()
        forger.publish(forged)
        return len(turning) > 60 and set(turning[-20:]) == {0.0}

    wait_until(stands, 20.0, "it stands", pause=0.02)
    assert "/position_pub_node and /probe" in witness.state.message, witness.state
    assert max(abs(turn) for turn in turning[20:]) < 0.1
    witness.goes_on()
    witness.stops()


def test_all_numbers_that_the_robot_tells_are_finite(shared_robot: RosGraph) -> None:
    witness = Witness(shared_robot)
    told: Counter[str] = Counter()
    found: set[str] = set()
    publishers, _, _ = shared_robot.system_state()
    types = shared_robot.topic_types()
    kinds = {
        topic: types[topic]
        for topic, nodes in publishers.items()
        if has_numbers(types[topic]) and any(node.strip("/") in LAUNCHED for node in nodes)
    }

    def look(message: Any, topic: str) -> None:
        told[topic] += 1
        found.update(f"{topic}: {field}" for field in not_finite(kinds[topic], message))

    for topic, kind in kinds.items():
        rospy.Subscriber(topic, get_message_class(kind), look, topic)
    witness.cleans()
    witness.goes_on()
    witness.stops()
    wait_until(lambda: told["/clean/result"] > 0, 30.0, "the result")
    # A beam that meets nothing is infinite (REP 117).
    assert found <= {"/scan: ranges"}
    assert len(told) > 20


def missing(expected: Counts, counts: Counts) -> list[str]:
    return [
        f"{node} refused {counts.get((node, topic), 0)} on {topic}, not {count}"
        for (node, topic), count in expected.items()
        if counts.get((node, topic), 0) < count
    ]


def flood(witness: Witness) -> None:
    """Steer by what is no number, so often that a line for each would be a hundred a second."""
    steering = witness.probe.publisher("/cmd_vel", Twist)
    before = witness.counts["speed_pub_node", "cmd_vel"]
    lines = Counter(witness.lines)
    began = time.monotonic()

    def are_refused() -> bool:
        steering.publish(malformed("geometry_msgs/Twist")["nan"])
        return witness.counts["speed_pub_node", "cmd_vel"] >= before + FLOOD

    # A program that steers a hundred times a second; of what comes at once a node hears the last.
    wait_until(are_refused, 20.0, "the flood is refused", pause=0.01)
    most = time.monotonic() - began + 2.0
    assert all(witness.lines[node] - lines[node] <= most for node in LAUNCHED)
