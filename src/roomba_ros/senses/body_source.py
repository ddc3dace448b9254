"""Where a node hears the body: by one message for each tick, or by single topics."""

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
    """Subscribes to ``body``, or to the single topics while no node publishes ``body``.

    Each message wakes the process, which takes longer than the work on the message. So this
    package's bodies put all readings into one message. Other bodies, and bags, have only the single
    topics.

    Subscribes: ``body`` (BodyState), or what ``single`` does. A change of subscriptions waits for
    the master. That is safe in nodes whose silence stops the drive, but not in the speed node.
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
        ``senders`` accepts one node as the body. Pass the one of the single topic ``odom``: then no
        other node can take the place of a body that has only the single topics. The bin holds
        ``bin_capacity``, g; of the messages that wait the newest ``queue_size`` are kept.
        """
        self._take, self._single, self._senders = take, single, senders
        self._convert = partial(body_of, bin_capacity=bin_capacity)
        self._queue_size = queue_size
        self._singles: tuple[rospy.Subscriber, ...] = ()
        self._body: rospy.Subscriber | None = None
        self._heard = -math.inf
        """When the newest valid ``body`` came, s of wall time."""
        self.is_whole = False
        """Whether ``body`` was published when :meth:`follow` was last called."""

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
        """Drop the single topics while ``body`` is published; subscribe to them otherwise.

        A ``body`` counts as published only while a node publishes valid messages.
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
