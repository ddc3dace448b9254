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
"""Part of the names of topics that are only drawn while they are heard, and are large."""
_AGAIN: Final = "/rosout_agg"
"""The topic that repeats what all nodes tell on another one."""
_QUEUE: Final = 1000
"""Messages of a topic that wait while others are written."""
_EARLIEST: Final = 1_000_000
"""ns; a bag knows no time 0, at which a clock may begin anew."""


class GraphEar:
    """Subscribes to the topics that there are, and to those that come.

    The robot goes on as it would: but what is only told while it is heard is told.
    """

    def __init__(
        self,
        take: Callable[[Message], None],
        *,
        only: Collection[str] = (),
        has_camera: bool = False,
    ) -> None:
        """Hear nothing yet; ``only`` these topics.

        Without any it is all but those of cameras, and the one that repeats the log.
        """
        self._take, self._only, self._has_camera = take, set(only), has_camera
        self._heard: dict[str, rospy.Subscriber] = {}
        self._master = master(rospy.get_name())

    @property
    def topics(self) -> list[str]:
        """What is heard."""
        return sorted(self._heard)

    def look(self) -> None:
        """Subscribe to what came since the last look; a master that is gone is asked later."""
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
