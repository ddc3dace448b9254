"""Subscriptions that convert messages to values and refuse those that cannot be used.

A node has one count of what it refused, as it has one set of connections. It logs one line a second
at most about that, and tells it on ``/diagnostics``.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final, TypeVar

import rospy
from diagnostic_msgs.msg import DiagnosticArray

from roomba_ros.convert.diagnostics import refused_message
from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.refusals import LINE_PERIOD, Refusals
from roomba_ros.runtime.senders import Senders

Value = TypeVar("Value")

REFUSALS: Final = Refusals()
"""What this node refused; times are of wall time."""


def refuse(topic: str, error: MessageError) -> None:
    """Count a message of a topic that cannot be used, and log it when a line is due."""
    REFUSALS.note(time.monotonic(), topic, str(error))
    _log()


def subscribe(
    topic: str,
    kind: type,
    convert: Callable[[Any], Value],
    take: Callable[[Value], object],
    *,
    queue_size: int = 1,
    tcp_nodelay: bool = False,
    senders: Senders | None = None,
) -> rospy.Subscriber:
    """Give ``take`` what ``convert`` makes of each message of a topic.

    A message for which one of these functions raises MessageError is refused: counted and reported.
    So is a message that ``senders`` refuse; without ``senders`` any node may send.
    """

    def hear(message: Any) -> None:
        try:
            value = convert(message)
            if senders is not None:
                senders.check(message._connection_header["callerid"])
            take(value)
        except MessageError as error:
            refuse(topic, error)
        except rospy.ROSException:
            # While the node ends, its own topics are closed one after the other.
            if not rospy.core.is_shutdown_requested():
                raise

    return rospy.Subscriber(topic, kind, hear, queue_size=queue_size, tcp_nodelay=tcp_nodelay)


def tell_refusals() -> None:
    """From now on, report refused messages: as lines of the log, and on ``/diagnostics``."""
    publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
    threading.Thread(target=_tell, args=(publisher,), name="refusals", daemon=True).start()


def _tell(publisher: rospy.Publisher) -> None:
    while not rospy.is_shutdown():
        _log()
        if publisher.get_num_connections() > 0:
            message = refused_message(
                rospy.get_time(),
                rospy.get_name().strip("/"),
                REFUSALS.counts,
                REFUSALS.newest,
                is_recent=REFUSALS.is_recent(time.monotonic()),
            )
            _publish(publisher, message)
        time.sleep(LINE_PERIOD)


def _log() -> None:
    line = REFUSALS.take_line(time.monotonic())
    if line:
        rospy.logwarn("%s", line)


def _publish(publisher: rospy.Publisher, message: DiagnosticArray) -> None:
    try:
        publisher.publish(message)
    except rospy.ROSException as error:
        # The node ends, and its connections were closed first.
        rospy.logdebug("what was refused is not told: %s", error)
