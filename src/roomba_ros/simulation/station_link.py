"""The link to the station that empties the robot's bin: its order, and its state."""

from __future__ import annotations

import threading
from typing import Final

import rospy
from roomba_robot.msg import EmptyingStation as EmptyingStationMessage
from std_msgs.msg import Bool

from roomba.world.emptying import EmptyingStation
from roomba_ros.convert.values import data_of
from roomba_ros.runtime.subscriptions import subscribe

_EVERY: Final = 20
"""Ticks between two messages of a station of which nothing changes."""


class StationLink:
    """Lets the station work while it is ordered to, and publishes its state."""

    def __init__(
        self, station: EmptyingStation | None, longest_silence: float, lock: threading.Lock
    ) -> None:
        """Connect nothing yet; ``station`` None: there is no station that empties bins.

        The station stops when no order came for ``longest_silence`` s of the robot's clock;
        ``lock`` is held by the caller of :meth:`step`.
        """
        self._station, self._longest_silence, self._lock = station, longest_silence, lock
        self._left = 0.0
        self._told: tuple[bool, float] | None = None

    def start(self) -> None:
        """Connect."""
        self._publisher = rospy.Publisher("emptying_station", EmptyingStationMessage, queue_size=5)
        subscribe("emptying_wanted", Bool, data_of, self._on_wanted, tcp_nodelay=True)

    def step(self, seconds: float) -> None:
        """Set whether the station empties during the next ``seconds``, by the newest message."""
        if self._station is not None:
            self._station.is_wanted = self._left > 0.0
            self._left = max(self._left - seconds, 0.0)

    def tell(self, tick: int) -> None:
        """Publish what is due at a tick."""
        if self._station is None:
            return
        state = (self._station.is_at_work, self._station.bag)
        if tick % _EVERY and state == self._told:
            return
        self._told = state
        self._publisher.publish(EmptyingStationMessage(*state))

    def _on_wanted(self, is_wanted: bool) -> None:
        with self._lock:
            self._left = self._longest_silence if is_wanted else 0.0
