"""The position loop on ROS: where the robot is, and driving to where it should be."""

from __future__ import annotations

import threading

import rospy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from roomba_robot.msg import RobotPosition
from tf2_msgs.msg import TFMessage

from roomba.control.position_loop import PositionLoop
from roomba.control.setpoint import Setpoint
from roomba.geometry import Pose
from roomba_ros.convert import (
    pose_message,
    pose_of_odometry,
    transform_message,
    twist_message,
)
from roomba_ros.node import frame_id, run_node
from roomba_ros.parameters import LiveSeedParameters, read_robot_config, read_seed_parameters

_STOP_REPEATS = 3
"""Ticks for which a stop is repeated before the drive is left to others."""


class PositionPubNode:
    """Knows the robot's pose and drives it to the wished position, however far that is.

    Publishes: ``position`` (RobotPosition, 10 Hz), ``pose`` (PoseStamped, 20 Hz, map frame),
    ``cmd_vel`` (Twist, 20 Hz while it drives), ``/tf`` (map -> odom).
    Subscribes: ``change_position`` (RobotPosition, the wish), ``odom`` (Odometry).
    Parameters: ``initial_post_x``, ``initial_post_y``, ``initial_post_theta`` (where odometry
    began), ``robot_max_speed``, ``min_cordinate``, ``max_cordinate``.
    """

    period = 0.05

    def start(self) -> None:
        """Read parameters and connect."""
        self._parameters = LiveSeedParameters()
        config = read_robot_config()
        self._loop = PositionLoop(config.control, config.body)
        self._setpoint = Setpoint(config.control.stream_timeout)
        self._lock = threading.Lock()
        self._odometry: Pose | None = None
        self._map_to_odom: Pose | None = None
        self._stops_left = 0
        self._ticks = 0
        self._map_frame, self._odom_frame = "map", frame_id("odom")
        self._position = rospy.Publisher("position", RobotPosition, queue_size=1)
        self._pose = rospy.Publisher("pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self._command = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=1, tcp_nodelay=True)
        self._wishes = rospy.Subscriber(
            "change_position", RobotPosition, self._on_wish, queue_size=1, tcp_nodelay=True
        )

    def tick(self, now: float) -> None:
        """Publish the pose and drive towards the wish."""
        self._parameters.refresh()
        if self._odometry is None:
            return
        pose = self._locate(self._odometry)
        self._tell_pose(now, pose)
        self._drive(now, pose)

    def stop(self) -> None:
        """Stop what it drives."""
        if self._setpoint.target is not None:
            self._command.publish(Twist())

    def _locate(self, odometry: Pose) -> Pose:
        if self._map_to_odom is None:
            # Read now, not at the start: the simulator puts the robot where its home wants it.
            start = read_seed_parameters()
            self._map_to_odom = Pose(
                start.initial_post_x, start.initial_post_y, start.initial_post_theta
            )
        return self._map_to_odom.compose(odometry)

    def _tell_pose(self, now: float, pose: Pose) -> None:
        self._pose.publish(pose_message(now, pose, self._map_frame))
        self._ticks += 1
        if self._ticks % 2 == 0:
            self._position.publish(RobotPosition(pose.x, pose.y))
            assert self._map_to_odom is not None
            self._transforms.publish(
                [transform_message(now, self._map_to_odom, self._map_frame, self._odom_frame)]
            )

    def _drive(self, now: float, pose: Pose) -> None:
        with self._lock:
            if self._setpoint.check(now, self._wishes.get_num_connections()):
                rospy.logwarn("the sender of change_position vanished while it drove; stopping")
                self._stops_left = _STOP_REPEATS
            target = self._setpoint.target
        if target is not None:
            twist = self._loop.tick(pose, target, self._parameters.values.robot_max_speed)
            if self._loop.arrived and self._stops_left == 0:
                # Others may steer now; nothing drives it back here.
                with self._lock:
                    self._setpoint.fulfilled(now)
                return
            self._stops_left = self._stops_left - 1 if self._loop.arrived else _STOP_REPEATS
            self._command.publish(twist_message(twist))
        elif self._stops_left > 0:
            self._stops_left -= 1
            self._command.publish(Twist())

    def _on_odometry(self, message: Odometry) -> None:
        self._odometry = pose_of_odometry(message)

    def _on_wish(self, message: RobotPosition) -> None:
        if not self._parameters.values.allows(message.pos_x, message.pos_y):
            values = self._parameters.values
            rospy.logwarn(
                "change_position refused: expected finite coordinates from %g to %g, got (%g, %g)",
                values.min_cordinate,
                values.max_cordinate,
                message.pos_x,
                message.pos_y,
            )
            return
        with self._lock:
            target = (message.pos_x, message.pos_y)
            self._setpoint.wish(rospy.get_time(), target, self._wishes.get_num_connections())


def main() -> None:
    """Run the node."""
    run_node("position_pub_node", PositionPubNode)
