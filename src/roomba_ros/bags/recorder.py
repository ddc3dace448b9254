"""Hears all topics of a graph, and hands on their messages as they come."""

from __future__ import annotations

import io
from collections.abc import Callable, Collection
from functools import partial
from typing import Any, Final

import rosgraph
import rospy

from roomba.recordings.bag_format.records import MessageSource
from roomba.recordings.bags.ring import Message
from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.graph.master import master
from roomba_ros.runtime.subscriptions import subscribe

_CAMERA: Final = "/camera/"
"""Part of the names of camera topics; their pictures are large, and drawn only for subscribers."""
_AGAIN: Final = "/rosout_agg"
"""The topic that repeats the log messages of all nodes (``/rosout``)."""
_QUEUE: Final = 1000
"""Messages of a topic that wait while others are written."""
_EARLIEST: Final = 1_000_000
"""ns; a bag has no time 0, but a clock may begin there."""


class GraphEar:
    """Subscribes to all topics of the graph, also to those that are advertised later.

    The robot behaves as without it, but also publishes what it publishes only for subscribers.
    """

    def __init__(
        self,
        take: Callable[[Message], None],
        *,
        only: Collection[str] = (),
        has_camera: bool = False,
    ) -> None:
        """Hear nothing yet; ``only`` these topics.

        Without ``only`` all topics are heard but those of cameras and the one that repeats the log.
        """
        self._take, self._only, self._has_camera = take, set(only), has_camera
        self._heard: dict[str, rospy.Subscriber] = {}
        self._master = master(rospy.get_name())

    @property
    def topics(self) -> list[str]:
        """What is heard."""
        return sorted(self._heard)

    def look(self) -> None:
        """Subscribe to topics that are new since the last look; does nothing without a master."""
        try:
            found = self._master.getPublishedTopics("/")
        except (rosgraph.MasterException, OSError):
            return
        for topic, _ in found:
            if topic not in self._heard and self._wants(topic):
                self._heard[topic] = subscribe(
                    topic,
                    rospy.AnyMsg,
                    partial(_came, topic),
                    self._take,
                    queue_size=_QUEUE,
                )

    def _wants(self, topic: str) -> bool:
        if self._only:
            return topic in self._only
        return topic != _AGAIN and (self._has_camera or _CAMERA not in topic)


def _came(topic: str, message: Any) -> Message:
    now = max(rospy.get_rostime().to_nsec(), _EARLIEST)
    buffer = io.BytesIO()
    message.serialize(buffer)
    return Message(_source_of(topic, message), now, buffer.getvalue())


def _source_of(topic: str, message: rospy.AnyMsg) -> MessageSource:
    """Return where a message comes from; raises MessageError if its sender does not tell."""
    header: dict[str, str] = message._connection_header
    try:
        return MessageSource(
            topic,
            header["type"],
            header["md5sum"],
            header["message_definition"],
            header.get("callerid", ""),
            header.get("latching") == "1",
        )
    except KeyError as missing:
        raise MessageError(f"expected a connection with {missing} in its header") from None
