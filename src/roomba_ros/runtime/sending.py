"""Sends each message at once, on the thread that publishes it, while its receiver keeps up.

rospy has a thread for each receiver of each topic and wakes it for each message, which takes longer
than the sending itself. There is no hook for that, so its class is replaced.
"""

from __future__ import annotations

import socket
import threading
from collections import deque
from typing import Any, Final

import rospy.topics

_NOW: Final = socket.MSG_DONTWAIT


def send_at_once() -> None:
    """Send all topics of this process in this way; call before ``rospy.init_node``."""
    rospy.topics.QueuedConnection = OutgoingConnection


class OutgoingConnection:
    """A connection to one receiver of a topic, in place of rospy's QueuedConnection.

    The publisher never waits. A receiver that falls behind gets a thread of its own until it has
    caught up. Meanwhile the newest ``queue_size`` messages wait for it, or all if that is 0.
    """

    def __init__(self, connection: Any, queue_size: int) -> None:
        """Send by ``connection``, a TCPROSTransport of rospy."""
        self._connection = connection
        self._lock = threading.Lock()
        self._waiting: deque[bytes] = deque(maxlen=queue_size or None)
        self._is_behind = False
        self._error: Exception | None = None

    def __getattr__(self, name: str) -> Any:
        """Return any other attribute of the connection."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Send a message, or queue it; raises the error that an earlier message met."""
        with self._lock:
            error, self._error = self._error, None
            if error is not None:
                raise error
            if self._is_behind:
                self._waiting.append(data)
                return True
            rest = self._sent_now(data)
            if rest:
                self._is_behind = True
                threading.Thread(target=self._catch_up, args=(rest,), daemon=True).start()
        return True

    def _sent_now(self, data: bytes) -> bytes:
        """Send as much as the socket's buffer has room for; return the rest."""
        connection = self._connection
        if connection.done or connection.socket is None:
            connection.write_data(data)  # raises the error that rospy expects
            return b""
        try:
            sent = connection.socket.send(data, _NOW)
        except BlockingIOError:
            return data
        except OSError:
            connection.write_data(data)  # fails again, and closes the connection as rospy does
            return b""
        connection.stat_bytes += sent
        connection.stat_num_msg += sent == len(data)
        return data[sent:]

    def _catch_up(self, data: bytes) -> None:
        """Send the rest of a message and all that wait, as fast as the receiver takes them."""
        while True:
            try:
                self._connection.write_data(data)
            except Exception as error:
                with self._lock:
                    self._error = error
                    self._waiting.clear()
                    self._is_behind = False
                return
            with self._lock:
                if not self._waiting:
                    self._is_behind = False
                    return
                data = self._waiting.popleft()
