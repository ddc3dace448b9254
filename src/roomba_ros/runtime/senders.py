"""Which node may send on a topic: messages of any other node are refused.

Each message carries the name of its sender. A node that takes another node's name is not noticed
here: the master ends the older of two nodes with the same name.
"""

from __future__ import annotations

import math
import threading
import time
from typing import Final, Protocol

import rospy

from roomba_ros.convert.errors import MessageError

SPEED_NODE: Final = "speed_pub_node"
"""The node that alone decides the drive's twist, and whether the drive is held."""
SUPERVISOR: Final = "supervisor_node"
"""The node that tells how the robot's processes are."""
_SILENT_AFTER: Final = 1.0
"""s of wall time without a message, after which a node is no sender any more."""
SELDOM_SILENT_AFTER: Final = 3.0
"""s of wall time; the same for topics of one message a second."""


class Senders(Protocol):
    """Which nodes may send."""

    def check(self, sender: str) -> None:
        """Raise MessageError if a message of this node does not count."""


class OnlyFrom:
    """Takes what one node sends."""

    def __init__(self, node: str) -> None:
        """Take the name of the node, in this node's namespace unless it begins with a slash."""
        self._node = rospy.resolve_name(node)

    def check(self, sender: str) -> None:
        """Raise MessageError if another node is the sender."""
        if sender != self._node:
            raise MessageError(f"expected messages of {self._node} alone, got one of {sender}")


class OneSender:
    """Accepts the node that sends first, until it is silent; notices a second sender."""

    def __init__(self, silent_after: float = _SILENT_AFTER) -> None:
        """Begin without a sender; one that is silent for so many s of wall time is forgotten."""
        self._lock = threading.Lock()
        self._silent_after = silent_after
        self._sender, self._heard = "", -math.inf
        self._rival, self._rival_heard = "", -math.inf

    def check(self, sender: str) -> None:
        """Raise MessageError if another node sends already."""
        now = time.monotonic()
        with self._lock:
            if sender == self._sender or now - self._heard > self._silent_after:
                self._sender, self._heard = sender, now
                return
            self._rival, self._rival_heard = sender, now
        raise MessageError(f"expected one sender, {self._sender}, got a message of {sender}")

    @property
    def conflict(self) -> str:
        """Which two nodes send at the same time, and what to do; empty while one does."""
        now = time.monotonic()
        with self._lock:
            newest = min(self._heard, self._rival_heard)
            if self._sender == self._rival or now - newest > self._silent_after:
                return ""
            return f"both {self._sender} and {self._rival} tell it: end one of them"
