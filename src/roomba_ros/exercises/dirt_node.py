"""Checks a node that tells the dirt: the newest value, five times a second, none before one."""

from __future__ import annotations

import itertools
import statistics
import sys
import time
from pathlib import Path
from typing import Final

import rospy
from std_msgs.msg import Float32

from roomba.commands.exercise.verdict import expect, judged
from roomba_ros.exercises.graph import OwnGraph

_QUIET: Final = 0.5
"""s in which the node must publish nothing, as the sensor has not measured yet."""
_LOOK: Final = 2.0
"""s in which messages are counted."""
_BETWEEN: Final = (0.17, 0.25)
"""s between two messages, as their median; five a second are asked for."""


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph:
        heard, times = list[float](), list[float]()

        def hear(message: Float32) -> None:
            heard.append(message.data)
            times.append(time.monotonic())

        rospy.Subscriber("dirt", Float32, hear)
        sensor = rospy.Publisher("dirt_raw", Float32, queue_size=10)
        graph.run_answer(file, "dirt_pub_node")
        graph.wait_for(lambda: sensor.get_num_connections() > 0, 5.0, "your node to hear dirt_raw")
        time.sleep(_QUIET)
        expect(
            not heard, f"expected nothing on dirt before dirt_raw told anything, got {heard[:1]}"
        )
        sensor.publish(0.25)
        graph.wait_for(lambda: heard, 5.0, "a message on dirt after one on dirt_raw")
        expect(heard[-1] == 0.25, f"dirt_raw was 0.25, dirt told {heard[-1]}")
        sensor.publish(0.4)
        sensor.publish(0.5)
        graph.wait_for(
            lambda: heard[-1] == 0.5, 5.0, "dirt to tell the newest value of dirt_raw, 0.5"
        )
        first = len(heard)
        time.sleep(_LOOK)
        expect_rate(times[first:])
        expect(set(heard[first:]) == {0.5}, f"dirt_raw was 0.5, dirt told {heard[-1]}")
    return "the newest value, five times a second"


def expect_rate(times: list[float]) -> None:
    """Raise NotYetError unless messages came five times a second at these times, s."""
    expect(len(times) > 1, f"expected 5 messages a second, got {len(times)} in {_LOOK:g} s")
    between = statistics.median(other - one for one, other in itertools.pairwise(times))
    expect(
        _BETWEEN[0] <= between <= _BETWEEN[1],
        f"expected a message each 0.2 s, one came each {between:.2f} s",
    )


if __name__ == "__main__":
    sys.exit(judged(check))
