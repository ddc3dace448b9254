"""Checks a node that tells the dirt: the newest value, five times a second, none before one."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Final

import rospy
from std_msgs.msg import Float32

from roomba.commands.exercise.verdict import expect, judged
from roomba_ros.exercises.graph import OwnGraph, wait_for

_QUIET: Final = 0.5
"""s in which nothing is to be told, before the sensor felt anything."""
_LOOK: Final = 2.0
"""s in which messages are counted."""
_RATE: Final = (3.0, 7.0)
"""1/s; five are asked for."""


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    with OwnGraph() as graph:
        heard: list[float] = []
        rospy.Subscriber("dirt", Float32, lambda message: heard.append(message.data))
        sensor = rospy.Publisher("dirt_raw", Float32, queue_size=10)
        graph.run_answer(file, "dirt_pub_node")
        wait_for(lambda: sensor.get_num_connections() > 0, 5.0, "your node to hear dirt_raw")
        time.sleep(_QUIET)
        expect(
            not heard, f"expected nothing on dirt before dirt_raw told anything, got {heard[:1]}"
        )
        sensor.publish(0.25)
        wait_for(lambda: heard, 5.0, "a message on dirt after one on dirt_raw")
        expect(heard[-1] == 0.25, f"dirt_raw was 0.25, dirt told {heard[-1]}")
        sensor.publish(0.4)
        sensor.publish(0.5)
        wait_for(lambda: heard[-1] == 0.5, 5.0, "dirt to tell the newest value of dirt_raw, 0.5")
        first = len(heard)
        time.sleep(_LOOK)
        rate = (len(heard) - first) / _LOOK
        expect(_RATE[0] <= rate <= _RATE[1], f"expected 5 messages a second, got {rate:.1f}")
        expect(set(heard[first:]) == {0.5}, f"dirt_raw was 0.5, dirt told {heard[-1]}")
    return f"the newest value, {rate:.1f} times a second"


if __name__ == "__main__":
    sys.exit(judged(check))
