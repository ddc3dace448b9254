"""Publishes the supervisor's reports, and collects the log of all nodes on one topic."""

from __future__ import annotations

import json
import os
import selectors
import time
from typing import Final

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

from roomba_ros.convert.diagnostics import processes_message
from roomba_ros.runtime.node import leave, register, settle, told_to_end
from roomba_ros.runtime.senders import SUPERVISOR

_PERIOD: Final = 1.0
"""s of wall time between two diagnostics when nothing changes."""
_LOOK: Final = 0.1
"""s of wall time that it waits for news at most, each time."""


class SupervisorNode:
    """Publishes the state of the robot's processes, as the supervisor writes it into a pipe."""

    def __init__(self, pipe: int) -> None:
        """Connect; ``pipe`` brings lines of JSON: trouble by process, empty when it is well."""
        self._pipe = pipe
        self._rest = b""
        self._states: dict[str, str] = {}
        self._told = 0.0
        self._trouble = rospy.Publisher("trouble", String, queue_size=1, latch=True)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._log = rospy.Publisher("/rosout_agg", Log, queue_size=100)
        rospy.Subscriber("/rosout", Log, self._log.publish, queue_size=100)
        self._trouble.publish("")

    def run(self, now: float) -> None:
        """Tell what is new, or what is due; ``now`` in s of wall time."""
        states = self._news()
        if states is not None and states != self._states:
            self._states = states
            self._trouble.publish("; ".join(said for said in states.values() if said))
        elif now - self._told < _PERIOD:
            return
        self._told = now
        self._diagnostics.publish(processes_message(rospy.get_time(), self._states))

    def _news(self) -> dict[str, str] | None:
        """Return the newest line; None when there is none. Raises EOFError at the end."""
        try:
            read = os.read(self._pipe, 1 << 16)
        except BlockingIOError:
            return None
        if not read:
            raise EOFError
        *lines, self._rest = (self._rest + read).split(b"\n")
        return dict(json.loads(lines[-1])) if lines else None


def be_supervisor_node(pipe: int) -> None:
    """Run the node until it is told to end."""
    register(SUPERVISOR)
    node, selector = SupervisorNode(pipe), selectors.DefaultSelector()
    os.set_blocking(pipe, False)
    selector.register(pipe, selectors.EVENT_READ)
    settle()
    while not told_to_end():
        selector.select(_LOOK)
        try:
            node.run(time.monotonic())
        except EOFError:
            break
    leave(0)
