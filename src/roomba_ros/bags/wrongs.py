"""Notices mishaps: the robot reports an error, is held, or one of its processes ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import rospy

from roomba.recordings.bags.ring import Message
from roomba_ros.convert.client import failure_of, held_or_troubled

_TELLERS: Final[dict[str, Callable[[bytes], str]]] = {
    "trouble": held_or_troubled,
    "emergency_stop": held_or_troubled,
    "vacuum/state": failure_of,
}
"""By topic the function that reads the reason from its messages; empty when all is well."""


class Wrongs:
    """Notices when a topic begins to report something wrong."""

    def __init__(self) -> None:
        """Know of nothing yet."""
        self._tellers = {rospy.resolve_name(name): (name, tell) for name, tell in _TELLERS.items()}
        self._said: dict[str, str] = {}

    def heard(self, message: Message) -> str:
        """Return what this message newly reports wrong, as ``topic: reason``; empty if nothing.

        Raises MessageError for a broken message.
        """
        teller = self._tellers.get(message.source.topic)
        if teller is None:
            return ""
        name, tell = teller
        reason = tell(message.raw)
        before, self._said[name] = self._said.get(name, ""), reason
        return f"{name}: {reason}" if reason and reason != before else ""
