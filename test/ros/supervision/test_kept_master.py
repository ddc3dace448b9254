"""A master that takes another's place knows parameters, topics and services; so do its clients."""

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from fixtures.graph import RosGraph
from fixtures.probe import Probe
from fixtures.processes.programs import Program
from fixtures.waiting import wait_until
from roomba_robot.srv import EmergencyStop
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse


@pytest.fixture
def own(tmp_path: Path) -> Iterator[RosGraph]:
    """A graph without a master."""
    with RosGraph(tmp_path) as made:
        yield made


MASTER = "import sys; from pathlib import Path; from roomba_ros.supervision.kept_master import *; "


def started(graph: RosGraph) -> Program:
    code = f"{MASTER}be_master({graph.port}, Path({str(graph.folder / 'master.xml')!r}))"
    program = graph.run(sys.executable, "-c", code)
    wait_until(graph.master_answers, 40.0, lambda: f"the master answers: {program.output}")
    return program


def killed(graph: RosGraph, master: Program, newest: str) -> None:
    """Kill the master once it has kept what it knows, the ``newest`` topic as well."""
    text = graph.folder / "master.xml"
    wait_until(lambda: text.exists() and newest in text.read_text(), 20.0, "it is kept")
    seen = text.stat().st_mtime_ns
    wait_until(lambda: os.stat(text).st_mtime_ns == seen, 5.0)
    os.kill(master.process.pid, signal.SIGKILL)
    master.ends(20.0)


def test_all_is_known_to_the_next_one_and_new_clients_find_it(own: RosGraph) -> None:
    master = started(own)
    own.set_param("/map/name", {"floor": 1, "names": ["a", "b"], "size": 0.5, "is_new": True})
    probe = Probe(own)
    rospy.Service("/said", Trigger, lambda _: TriggerResponse(True, "here"))
    said = rospy.Publisher("/said/loud", String, queue_size=1, latch=True)
    said.publish("hello")
    killed(own, master, "/said/loud")
    started(own)
    assert own.param("/map/name") == {
        "floor": 1,
        "names": ["a", "b"],
        "size": 0.5,
        "is_new": True,
    }
    assert rospy.ServiceProxy("/said", Trigger)().message == "here"
    assert own.topic_types()["/said/loud"] == "std_msgs/String"
    # A node that comes now hears those from before, and they hear it.
    listener = own.run("rostopic", "echo", "-n", "1", "/said/loud")
    listener.says("hello", 20.0)
    speaker = own.run("rostopic", "pub", "-l", "/answer", "std_msgs/String", "back")
    assert probe.next("/answer", String).data == "back"
    assert speaker.status is None


def test_a_node_that_goes_by_a_parameter_still_hears_of_it(own: RosGraph) -> None:
    master = started(own)
    own.set_param("/most", 1.0)
    Probe(own)
    assert rospy.get_param_cached("/most") == 1.0
    killed(own, master, "/most/")
    started(own)
    own.set_param("/most", 2.0)
    wait_until(lambda: rospy.get_param_cached("/most") == 2.0, 20.0, "it hears of it")


def test_a_node_that_ended_meanwhile_is_forgotten(own: RosGraph) -> None:
    master = started(own)
    speaker = own.run("rostopic", "pub", "-l", "/said", "std_msgs/String", "back")
    wait_until(lambda: "/said" in own.system_state()[0], 20.0, "it speaks")
    killed(own, master, "/said")
    os.killpg(speaker.process.pid, signal.SIGKILL)
    speaker.ends(20.0)
    started(own)
    assert "/said" not in own.system_state()[0]


def test_the_emergency_stop_outlives_master_and_node_that_are_killed_together(
    own: RosGraph,
) -> None:
    """Right after the answer: the master looks five times a second at what it is to keep."""
    master = started(own)
    node = own.rosrun("speed_pub_node.py")
    wait_until(lambda: "/emergency_stop" in own.system_state()[2], 40.0, "the node is up")
    probe = Probe(own)
    call = rospy.ServiceProxy("/emergency_stop", EmergencyStop)
    assert call(True, "a child came in").success
    for program in (master, node):
        os.kill(program.process.pid, signal.SIGKILL)
    for program in (master, node):
        program.ends(20.0)
    started(own)
    own.rosrun("speed_pub_node.py")
    wait_until(lambda: own.answers("speed_pub_node"), 40.0, "the node is back")
    assert probe.next("/emergency_stop", String).data == "a child came in"


def test_what_a_damaged_file_says_is_lost_and_the_master_works(own: RosGraph) -> None:
    (own.folder / "master.xml").write_text("no such thing", encoding="utf-8")
    started(own)
    own.set_param("/a", 1)
    assert own.param("/a") == 1
