"""The node that publishes the dirt under the robot."""

from __future__ import annotations

import rospy
from std_msgs.msg import Float32

from roomba_ros.convert.values import number_of
from roomba_ros.runtime.node import run_node
from roomba_ros.runtime.subscriptions import subscribe


class DirtPubNode:
    """Publishes what the dirt sensor feels, 5 times a second.

    Publishes: ``dirt`` (Float32, g of dirt on the floor under the robot's body).
    Subscribes: ``dirt_raw`` (Float32, g, as the sensor measures it).
    """

    period = 0.2

    def start(self) -> None:
        """Connect."""
        self._dirt: float | None = None
        self._publisher = rospy.Publisher("dirt", Float32, queue_size=1)
        subscribe("dirt_raw", Float32, number_of, self._on_dirt)

    def tick(self, now: float) -> None:
        """Publish the newest measurement, once there is one."""
        if self._dirt is not None:
            self._publisher.publish(self._dirt)

    def stop(self) -> None:
        """Nothing of this node moves the robot."""

    def _on_dirt(self, dirt: float) -> None:
        self._dirt = dirt


def main() -> None:
    """Run the node."""
    run_node("dirt_pub_node", DirtPubNode)
