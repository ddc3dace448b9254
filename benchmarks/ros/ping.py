"""Round trips over ROS: publish on one topic, wait for the same number on another.

Speaks the peers' protocol; parameters: ``kind`` of :mod:`benchmarks.ros.messages`, ``ping`` and
``pong``, the topics.
"""

from __future__ import annotations

import threading
import time
from typing import Any

import rospy

from benchmarks.peers.protocol import Parameters, Work
from benchmarks.ros.messages import KINDS

DISTRIBUTION = "rospy"
_TRIPS = 50
_ANSWER_DEADLINE = 2.0
_CONNECT_DEADLINE = 15.0


def prepare(parameters: Parameters) -> Work:
    """Connect, and wait until the other side is there."""
    kind = KINDS[parameters["kind"]]
    heard = threading.Event()
    waited_for = -1

    def on_pong(message: Any) -> None:
        if kind.number(message) == waited_for:
            heard.set()

    rospy.init_node("ping", anonymous=True, disable_signals=True)
    rospy.Subscriber(parameters["pong"], kind.message, on_pong, queue_size=1, tcp_nodelay=True)
    ping = rospy.Publisher(parameters["ping"], kind.message, queue_size=1, tcp_nodelay=True)
    numbers = [kind.number(kind.make(number)) for number in range(2 * _TRIPS)]
    messages = [kind.make(number) for number in range(2 * _TRIPS)]
    if numbers != list(range(2 * _TRIPS)):
        raise ValueError(f"{parameters['kind']}: its messages do not keep their numbers")

    def trip(number: int) -> bool:
        nonlocal waited_for
        heard.clear()
        waited_for = number
        ping.publish(messages[number])
        return heard.wait(_ANSWER_DEADLINE)

    end = time.monotonic() + _CONNECT_DEADLINE
    while not (ping.get_num_connections() and trip(0)):
        if time.monotonic() > end:
            raise TimeoutError(f"no answer on {parameters['pong']} within {_CONNECT_DEADLINE:g} s")
        time.sleep(0.05)

    first = 0

    def trips() -> float:
        nonlocal first
        # Other numbers than last time: a late answer of then is none of now.
        first = _TRIPS - first
        if not all(trip(first + number) for number in range(_TRIPS)):
            raise TimeoutError(f"no answer on {parameters['pong']} within {_ANSWER_DEADLINE:g} s")
        return float(_TRIPS)

    return Work(trips)
