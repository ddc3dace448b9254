"""Whether the emergency stop holds the drive, as the speed node tells it."""

from __future__ import annotations

from collections.abc import Callable

from std_msgs.msg import String

from roomba_ros.convert.values import data_of
from roomba_ros.runtime.senders import SPEED_NODE, OnlyFrom
from roomba_ros.runtime.subscriptions import subscribe


class HeldDrive:
    """Why the drive is held: ``reason``, empty while it is free.

    Subscribes: ``emergency_stop`` (String).
    """

    def __init__(self, take: Callable[[str], object] | None = None) -> None:
        """Connect nothing yet; ``take`` is called with each reason that is told."""
        self.reason = ""
        self._take = take

    def start(self) -> None:
        """Connect."""
        drive = OnlyFrom(SPEED_NODE)
        subscribe("emergency_stop", String, data_of, self._on_told, queue_size=10, senders=drive)

    def _on_told(self, reason: str) -> None:
        self.reason = reason
        if self._take is not None:
            self._take(reason)
