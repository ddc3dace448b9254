"""Round trips over ROS: publish on one topic, wait for the same number on another.

Speaks the peers' protocol; parameters: ``kind`` of :mod:`roomba_bench.ros.messages`, ``ping`` and
``pong``, the topics, and, if trips are not to follow at once on each other, ``apart``, s. The rate
is that of the trips alone: pauses between them do not count.
"""

from __future__ import annotations

import threading
import time
from typing import Any

import rospy

from roomba_bench.peers.protocol import Parameters, Work
from roomba_bench.ros.messages import KINDS

DISTRIBUTION = "rospy"
_TRIPS = 50
_ANSWER_DEADLINE = 2.0
_CONNECT_DEADLINE = 15.0


def prepare(parameters: Parameters) -> Work:
    """Connect, and wait until the other side is there."""
    kind, apart = KINDS[parameters["kind"]], float(parameters.get("apart", 0.0))
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

    def timed_trip(number: int) -> float:
        """Make a trip; return what it took, s."""
        began = time.perf_counter()
        if not trip(number):
            raise TimeoutError(f"no answer on {parameters['pong']} within {_ANSWER_DEADLINE:g} s")
        return time.perf_counter() - began

    end = time.monotonic() + _CONNECT_DEADLINE
    while not (ping.get_num_connections() and trip(0)):
        if time.monotonic() > end:
            raise TimeoutError(f"no answer on {parameters['pong']} within {_CONNECT_DEADLINE:g} s")
        time.sleep(0.05)

    first = 0

    def trips() -> float:
        nonlocal first
        # New numbers each time: a late answer to an earlier round does not count.
        first = _TRIPS - first
        began, under_way = time.perf_counter(), 0.0
        for number in range(_TRIPS):
            under_way += timed_trip(first + number)
            time.sleep(apart)
        # The number of trips that the whole time would have had room for.
        return _TRIPS * (time.perf_counter() - began) / under_way

    return Work(trips)
