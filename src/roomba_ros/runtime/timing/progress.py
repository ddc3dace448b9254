"""How far a node's work is, published for a simulation that waits for nodes that fall behind."""

from __future__ import annotations

from typing import Final

import rospy
from std_msgs.msg import Time

from roomba_ros.convert.common import stamp_of

NODES: Final = ("speed_pub_node", "walk_to_point_action_server_node", "mission_node")
"""Nodes that drive, for which the simulation waits; ``/pose`` does the same for
position_pub_node."""
_PERIOD: Final = 0.05
"""s of the ROS clock between two messages: one tick, so that a late node is noticed."""


class Progress:
    """Publishes ``~progress`` (Time: up to when this node did its work), if the node drives.

    Only while the clock is a simulated one.
    """

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._told = 0.0
        self._publisher: rospy.Publisher | None = None

    def start(self, name: str) -> None:
        """Connect, for the node of this name."""
        if name in NODES and not rospy.rostime.is_wallclock():
            self._publisher = rospy.Publisher("~progress", Time, queue_size=1, tcp_nodelay=True)

    def tell(self, now: float) -> None:
        """Tell that all is done up to a time of the ROS clock, s."""
        if self._publisher is not None and not 0.0 <= now - self._told < 0.99 * _PERIOD:
            self._told = now
            self._publisher.publish(stamp_of(now))
