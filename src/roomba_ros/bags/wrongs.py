"""When something goes wrong: the robot says so, is held, or a process of it ended."""

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
"""Topics, and what makes of their messages the reason; empty when all is well."""


class Wrongs:
    """Notices what begins to be wrong, by the topic that tells it."""

    def __init__(self) -> None:
        """Know of nothing yet."""
        self._tellers = {rospy.resolve_name(name): (name, tell) for name, tell in _TELLERS.items()}
        self._said: dict[str, str] = {}

    def heard(self, message: Message) -> str:
        """Return what is wrong since this message, as ``topic: reason``; empty if nothing new is.

        Raises MessageError for a broken message.
        """
        teller = self._tellers.get(message.source.topic)
        if teller is None:
            return ""
        name, tell = teller
        reason = tell(message.raw)
        before, self._said[name] = self._said.get(name, ""), reason
        return f"{name}: {reason}" if reason and reason != before else ""
