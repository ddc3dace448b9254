"""A walk's messages to other nodes: where to drive, how fast, which heading, and the path."""

from __future__ import annotations

import rospy
from nav_msgs.msg import Path
from roomba_robot.msg import RobotPosition
from std_msgs.msg import Float32

from roomba.mission.walking.walk import Walk
from roomba_ros.convert.common import path_message


class WalkTopics:
    """Publishes ``change_position`` (RobotPosition: the setpoint, m), ``change_speed`` (Float32,
    m/s), ``change_heading`` (Float32, rad), ``plan`` (Path, latched)."""

    def start(self) -> None:
        """Connect."""
        self._position = rospy.Publisher(
            "change_position", RobotPosition, queue_size=1, tcp_nodelay=True
        )
        self._speed = rospy.Publisher("change_speed", Float32, queue_size=1, tcp_nodelay=True)
        self._heading = rospy.Publisher("change_heading", Float32, queue_size=1, tcp_nodelay=True)
        self._plan = rospy.Publisher("plan", Path, queue_size=1, latch=True)

    def drive_to(self, x: float, y: float) -> None:
        """Tell the setpoint, m, map frame."""
        self._position.publish(RobotPosition(x, y))

    def drive_at(self, speed: float) -> None:
        """Tell the cruise speed, m/s."""
        self._speed.publish(speed)

    def turn_to(self, heading: float) -> None:
        """Tell where to look to on the spot, rad, map frame."""
        self._heading.publish(heading)

    def show_path(self, now: float, walk: Walk) -> None:
        """Tell the path of a walk as it is planned now; ``now`` in s."""
        self._plan.publish(path_message(now, walk.path.points, "map"))
