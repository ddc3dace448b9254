"""The last link before the wheels: which twist reaches them, and from which node."""

from __future__ import annotations

import threading

import rospy
from geometry_msgs.msg import Twist as TwistMessage
from std_msgs.msg import String

from roomba.control.drive_gate import DriveGate
from roomba.errors import ConfigError
from roomba.geometry import Twist
from roomba_ros.convert.common import twist_of
from roomba_ros.convert.values import data_of
from roomba_ros.runtime.senders import SPEED_NODE, OnlyFrom
from roomba_ros.runtime.subscriptions import subscribe


class DriveLink:
    """Gives the wheels the fresh command of the drive's owner, while no emergency stop holds them.

    Subscribes: ``cmd_vel_out`` (Twist) and ``emergency_stop`` (String; while it says a reason the
    wheels stand), of ``~drive_owner`` alone.
    Parameters: ``~drive_owner`` (the node that may drive, or any).
    """

    def __init__(self, command_timeout: float, lock: threading.Lock) -> None:
        """Connect nothing yet; ``lock`` is held by the caller of :meth:`step`.

        Raises ConfigError for a parameter that is no node's name.
        """
        self._gate, self._lock = DriveGate(command_timeout), lock
        self._owner = _owner()

    def start(self) -> None:
        """Connect."""
        subscribe(
            "cmd_vel_out",
            TwistMessage,
            twist_of,
            self._on_command,
            tcp_nodelay=True,
            senders=self._owner,
        )
        subscribe(
            "emergency_stop",
            String,
            data_of,
            self._on_emergency_stop,
            tcp_nodelay=True,
            senders=self._owner,
        )

    def step(self, seconds: float) -> Twist:
        """Return the twist of the wheels for the next ``seconds``."""
        return self._gate.step(seconds)

    def _on_command(self, twist: Twist) -> None:
        with self._lock:
            self._gate.command(twist)

    def _on_emergency_stop(self, reason: str) -> None:
        with self._lock:
            self._gate.hold(bool(reason))


def _owner() -> OnlyFrom | None:
    """Return which nodes may drive; None: any."""
    name = rospy.get_param("~drive_owner", SPEED_NODE)
    if not isinstance(name, str) or not name:
        raise ConfigError(f"parameter ~drive_owner: expected a node's name, or any, got {name!r}")
    return None if name == "any" else OnlyFrom(name)
