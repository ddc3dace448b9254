"""A node that is told to end does so in time, also when its shutdown hangs."""

from __future__ import annotations

import signal
import sys

from fixtures.graph import RosGraph
from fixtures.waiting import promised, wait_until

NODE = """
import sys
import time
import rospy
from roomba_ros.runtime.node import run_node

class Holding:
    period = 0.05
    def start(self):
        rospy.core.add_shutdown_hook(lambda reason: time.sleep(60.0))
        print("starts", flush=True)
        time.sleep(float(sys.argv[1]))
    def tick(self, now):
        print("ticks", flush=True)
    def stop(self):
        print("stopped", flush=True)

run_node("holding", Holding)
"""
CALLS = """
import rospy
from roomba_ros.runtime.calls import call_service
from roomba_ros.runtime.node import run_node
from std_srvs.srv import Trigger

class Asking:
    period = 0.05
    def start(self):
        self.service = rospy.ServiceProxy("not_there", Trigger)
    def tick(self, now):
        print("asks", flush=True)
        call_service(self.service)
    def stop(self):
        pass

run_node("asking", Asking)
"""
KILLED = """
import time
import rospy
from roomba_ros.runtime.node import run_node
from std_msgs.msg import Empty

class Speaking:
    period = 0.05
    def start(self):
        self.said = rospy.Publisher("said", Empty, queue_size=1)
        # Its topics are closed by then, and it is not told yet that it is to end.
        rospy.core.add_preshutdown_hook(lambda reason: time.sleep(0.5))
    def tick(self, now):
        self.said.publish()
        print("ticks", flush=True)
    def stop(self):
        print("stopped", flush=True)

run_node("speaking", Speaking)
"""
ENDED = 1.8
"""s of wall time until the supervisor would tell it more firmly."""


def test_a_node_that_its_shutdown_holds_up_ends_all_the_same_after_its_last_word(
    graph: RosGraph,
) -> None:
    program = graph.run(sys.executable, "-c", NODE, "0")
    wait_until(lambda: "ticks" in program.output, 30.0, "it runs")
    program.send_to_leader(signal.SIGINT)
    promised(lambda: program.status is not None, ENDED, "it has ended")
    assert program.status == 0
    assert "stopped" in program.output


def test_a_start_however_long_is_not_waited_for(graph: RosGraph) -> None:
    program = graph.run(sys.executable, "-c", NODE, "60")
    wait_until(lambda: "starts" in program.output, 30.0, "it starts")
    program.send_to_leader(signal.SIGINT)
    promised(lambda: program.status is not None, ENDED, "it has ended")
    assert program.status == 0
    assert "ticks" not in program.output


def test_a_service_that_is_not_there_is_not_waited_for(graph: RosGraph) -> None:
    program = graph.run(sys.executable, "-c", CALLS)
    wait_until(lambda: "asks" in program.output, 30.0, "it waits")
    program.send_to_leader(signal.SIGINT)
    promised(lambda: program.status is not None, ENDED, "it has ended")


def test_a_node_that_another_one_ends_in_a_tick_ends_without_an_error(graph: RosGraph) -> None:
    program = graph.run(sys.executable, "-c", KILLED)
    wait_until(lambda: "ticks" in program.output, 30.0, "it runs")
    graph.run("rosnode", "kill", "/speaking")
    assert program.ends(30.0) == 0
    assert "Traceback" not in program.output
    assert "stopped" in program.output
