"""The newest latched messages of this process, for those who come to listen later.

rospy gives a latched message to a process once, when it connects: what subscribes to a topic that
the process hears already would wait for the next one. There is no hook for that, so one function of
rospy is replaced.
"""

from __future__ import annotations

import threading
from typing import Any, Final

import rospy.topics

_unremembering: Final = rospy.topics._SubscriberImpl.receive_callback
_lock = threading.Lock()
_newest: dict[str, dict[str, Any]] = {}
"""By topic and sender."""


def remember_latched() -> None:
    """Remember from now on; call before anything is subscribed."""
    rospy.topics._SubscriberImpl.receive_callback = _receive


def latched(topic: str) -> list[Any]:
    """Return the newest latched message of each sender of a topic, by its resolved name."""
    with _lock:
        return list(_newest.get(topic, {}).values())


def _receive(topic: Any, messages: list[Any], connection: Any) -> None:
    if messages and connection.is_latched:
        with _lock:
            _newest.setdefault(topic.resolved_name, {})[connection.callerid_pub] = messages[-1]
    _unremembering(topic, messages, connection)
