"""Where a node hears of the robot's body: from one message for each tick, or from single topics."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from functools import partial

import rospy
from roomba_robot.msg import BodyState

from roomba.robot.readings import Readings
from roomba_ros.convert.readings import body_of
from roomba_ros.runtime.senders import SELDOM_SILENT_AFTER, OneSender
from roomba_ros.runtime.subscriptions import subscribe


class BodySource:
    """Hears ``body``, and while no node tells that, the single topics.

    A message wakes a process, which takes longer than what it is woken for: the body of this
    package tells all in one message. Bodies of others, and bags, have the single topics alone.

    Subscribes: ``body`` (BodyState), or what ``single`` does. This waits for the master: it is for
    nodes without whose commands the drive stops, and not for the speed node.
    """

    def __init__(
        self,
        take: Callable[[Readings], object],
        single: Callable[[], Iterable[rospy.Subscriber]],
        senders: OneSender,
        bin_capacity: float,
        queue_size: int,
    ) -> None:
        """Connect nothing yet.

        ``take`` is given the readings of each message; ``single`` subscribes to the single topics.
        ``senders`` lets one node tell of the body, and is to be that of the single ``odom`` too: no
        other node can take the place of a body that has the single topics alone. The bin holds
        ``bin_capacity``, g; of the messages that wait the newest ``queue_size`` are kept.
        """
        self._take, self._single, self._senders = take, single, senders
        self._convert = partial(body_of, bin_capacity=bin_capacity)
        self._queue_size = queue_size
        self._singles: tuple[rospy.Subscriber, ...] = ()
        self._body: rospy.Subscriber | None = None
        self._heard = -math.inf
        """s of wall time of the newest message that could be used."""
        self.is_whole = False
        """Whether ``body`` was told when :meth:`follow` was called last."""

    def start(self) -> None:
        """Connect."""
        self._body = subscribe(
            "body",
            BodyState,
            self._convert,
            self._on_body,
            queue_size=self._queue_size,
            tcp_nodelay=True,
            senders=self._senders,
        )
        self._singles = tuple(self._single())

    def follow(self) -> None:
        """Leave the single topics when the body tells all in one, or take to them again.

        The latter when no node tells ``body``, or none tells it so that it can be used.
        """
        self.is_whole = self._is_told()
        if self.is_whole and self._singles:
            for subscriber in self._singles:
                subscriber.unregister()
            self._singles = ()
        elif not self.is_whole and not self._singles:
            self._singles = tuple(self._single())

    def _is_told(self) -> bool:
        if self._body is None or self._body.get_num_connections() == 0:
            return False
        return time.monotonic() - self._heard <= SELDOM_SILENT_AFTER

    def _on_body(self, told: Readings) -> None:
        self._take(told)
        self._heard = time.monotonic()
