"""A node that is told to end does so in time, also when its shutdown hangs."""

from __future__ import annotations

import signal
import sys

from fixtures.graph import RosGraph
from fixtures.waiting import promised, wait_until

NODE = """
import time
import rospy
from roomba_ros.runtime.node import run_node

class Holding:
    period = 0.05
    def start(self):
        rospy.core.add_shutdown_hook(lambda reason: time.sleep(60.0))
        print("begun", flush=True)
    def tick(self, now):
        pass
    def stop(self):
        print("stopped", flush=True)

run_node("holding", Holding)
"""
ENDED = 1.8
"""s of wall time until the supervisor would tell it more firmly."""


def test_a_node_that_its_shutdown_holds_up_ends_all_the_same_after_its_last_word(
    graph: RosGraph,
) -> None:
    program = graph.run(sys.executable, "-c", NODE)
    wait_until(lambda: "begun" in program.output, 30.0, "it runs")
    program.send_to_leader(signal.SIGINT)
    promised(lambda: program.status is not None, ENDED, "it has ended")
    assert program.status == 0
    assert "stopped" in program.output
