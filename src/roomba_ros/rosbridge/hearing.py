"""Topics heard for programs: one subscription of ROS each, however many programs listen."""

from __future__ import annotations

import asyncio
import json
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Final

import rospy

from roomba_ros.convert.errors import MessageError
from roomba_ros.plain.messages import plain_of

_MOST_UNREAD: Final = 50
"""Messages that wait for the thread of the server."""


class Heard:
    """A message; it becomes JSON once, for all programs that get it."""

    def __init__(self, message: Any) -> None:
        """Take a message."""
        self.message = message
        self._json: str | None = None

    @property
    def json(self) -> str:
        """The message as JSON; raises MessageError when it is too large for that."""
        if self._json is None:
            plain = plain_of(self.message)
            self._json = json.dumps(plain, separators=(",", ":"), allow_nan=False)
        return self._json


class Topic:
    """One topic that programs hear. All but :meth:`_hear` runs in the thread of the server.

    rospy delivers a latched message to each subscription once. All programs share one subscription
    here, so the message is kept for programs that come later.
    """

    def __init__(self, name: str, kind: type, loop: asyncio.AbstractEventLoop) -> None:
        """Subscribe to a topic by its resolved name."""
        self.name, self.kind, self._loop = name, kind, loop
        self.listeners: set[Callable[[Heard], None]] = set()
        self._lock = threading.Lock()
        self._unread: deque[Any] = deque(maxlen=_MOST_UNREAD)
        self._is_waking = False
        self._latched: dict[str, Any] = {}
        self._subscriber = rospy.Subscriber(name, kind, self._hear, queue_size=_MOST_UNREAD)

    def add(self, listener: Callable[[Heard], None]) -> None:
        """Give a listener the messages from now on, and the latched ones at once."""
        self.listeners.add(listener)
        with self._lock:
            kept = list(self._latched.values())
        for message in kept:
            listener(Heard(message))

    def close(self) -> None:
        """Subscribe no more."""
        self._subscriber.unregister()

    def _hear(self, message: Any) -> None:
        header = message._connection_header
        with self._lock:
            if header.get("latching") == "1":
                self._latched[header["callerid"]] = message
            self._unread.append(message)
            if self._is_waking:
                return
            self._is_waking = True
        self._loop.call_soon_threadsafe(self._give)

    def _give(self) -> None:
        with self._lock:
            messages = list(self._unread)
            self._unread.clear()
            self._is_waking = False
        for message in messages:
            heard = Heard(message)
            for listener in list(self.listeners):
                listener(heard)


class Topics:
    """All topics that are heard, each while a program listens."""

    def __init__(self) -> None:
        """Hear nothing yet."""
        self._topics: dict[str, Topic] = {}

    def listen(self, name: str, kind: type, listener: Callable[[Heard], None]) -> None:
        """Give a listener what comes on a topic.

        Raises MessageError if the topic is heard with messages of another type.
        """
        topic = self._topics.get(name)
        if topic is None:
            topic = Topic(name, kind, asyncio.get_running_loop())
            self._topics[name] = topic
        elif topic.kind is not kind:
            raise MessageError(
                f"{name}: expected its type {_name_of(topic.kind)}, got {_name_of(kind)}"
            )
        topic.add(listener)

    def leave(self, name: str, listener: Callable[[Heard], None]) -> None:
        """Give a listener nothing more; a topic without listeners is unsubscribed."""
        topic = self._topics.get(name)
        if topic is None:
            return
        topic.listeners.discard(listener)
        if not topic.listeners:
            del self._topics[name]
            topic.close()


def _name_of(kind: type) -> str:
    return str(getattr(kind, "_type", kind.__name__))
