"""The position node: localization, rooms, and the position loop."""

from __future__ import annotations

import math
import threading

import rospy
from geometry_msgs.msg import Twist as TwistMessage
from roomba_robot.msg import RobotPosition
from std_msgs.msg import Bool, Float32

from roomba.clock import is_recent
from roomba.control.position_loop import PositionLoop
from roomba.control.setpoint import Setpoint
from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba_ros.convert.common import twist_message
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.readings import point_of
from roomba_ros.convert.values import data_of, number_of
from roomba_ros.localization.topics import LocalizationTopics
from roomba_ros.maps.map_topics import MapTopics
from roomba_ros.rooms.topics import RoomTopics
from roomba_ros.runtime.held_drive import HeldDrive
from roomba_ros.runtime.node import run_node
from roomba_ros.runtime.parameters import (
    LiveSeedParameters,
    bool_parameter,
    read_nodes_config,
    read_robot_config,
)
from roomba_ros.runtime.subscriptions import subscribe

_AHEAD = 10.0
"""m; how far ahead the point lies towards which the robot turns for a wanted heading."""
_STOP_REPEATS = 3
"""Ticks for which a stop is repeated before the drive is left to others."""


class PositionPubNode:
    """Knows the robot's pose and drives the robot to its setpoint, however far that is.

    When the pose is unknown, the node forgets the setpoint. The robot then looks around while a
    walk or a mission is under way, or, if a service asked to find the place, until that is found.
    The node also finds the map's rooms: a process of their own would need 80 MB more (ADR 7).

    Publishes: ``cmd_vel`` (Twist, 20 Hz while it drives), and what :class:`LocalizationTopics` and
    :class:`RoomTopics` tell.
    Subscribes: ``change_position`` (RobotPosition, setpoint), ``change_heading`` (Float32, rad, map
    frame, streamed: turn to it on the spot instead), ``look_around`` (Bool, streamed while
    the mission could go on if the place were known), ``emergency_stop`` (String: while it says a
    reason no setpoint is taken, and the one under way is forgotten), and what
    :class:`LocalizationTopics` and :class:`RoomTopics` hear.
    Services: those of :class:`LocalizationTopics` and :class:`RoomTopics`.
    Parameters: ``initial_post_x``, ``initial_post_y``, ``initial_post_theta`` (where odometry
    began), ``robot_max_speed``, ``min_cordinate``, ``max_cordinate``; ``~look_around`` (true: it
    may drive a little to find its place).
    """

    period: float

    def start(self) -> None:
        """Read parameters and connect."""
        self._parameters = LiveSeedParameters()
        self._config, nodes = read_robot_config(), read_nodes_config()
        self.period = self._config.timing.tick
        self._loop = PositionLoop(self._config.control, self._config.body)
        control = self._config.control
        self._setpoint = Setpoint(
            control.stream_timeout, control.given_up_after, control.arrival_tolerance
        )
        self._may_look_around = bool_parameter("~look_around", True)
        self._lock = threading.Lock()
        self._stops_left = 0
        self._look_asked = -math.inf
        self._heading = (-math.inf, 0.0)
        self._held = HeldDrive()
        self._place = LocalizationTopics(self._config, nodes)
        self._place.start()
        self._rooms = RoomTopics()
        self._rooms.start()
        self._maps = MapTopics(self._config, nodes, self._place, self._rooms)
        self._maps.start()
        self._command = rospy.Publisher("cmd_vel", TwistMessage, queue_size=1, tcp_nodelay=True)
        self._wishes = subscribe(
            "change_position", RobotPosition, point_of, self._on_wish, tcp_nodelay=True
        )
        subscribe("change_heading", Float32, number_of, self._on_heading, tcp_nodelay=True)
        subscribe("look_around", Bool, data_of, self._on_look_around)
        self._held.start()

    def tick(self, now: float) -> None:
        """Publish the pose, and drive towards the setpoint."""
        self._parameters.refresh()
        estimate = self._place.tick(now)
        if estimate is None:
            return
        self._maps.tick(now, estimate)
        self._drop_vanished_wish(now)
        if self._held.reason:
            # To release the stop is no order to drive on.
            self._forget_wish()
            twist = None
        elif not estimate.knowledge.is_usable:
            self._forget_wish()
            twist = self._twist_to_look_around(now)
        elif self._is_fresh(now, self._heading[0]):
            self._forget_wish()
            twist = self._twist_to_heading(estimate.pose, self._heading[1])
        else:
            twist = self._twist_to_wish(now, estimate)
        self._command_drive(twist)

    def stop(self) -> None:
        """Stop what it drives."""
        if self._setpoint.target is not None or self._stops_left:
            self._command.publish(TwistMessage())

    def _drop_vanished_wish(self, now: float) -> None:
        with self._lock:
            has_vanished = self._setpoint.drop_if_lost(now, self._wishes.get_num_connections())
        # A walk that has arrived sends no more setpoints.
        if has_vanished and not self._loop.arrived:
            rospy.logwarn(
                "the sender of change_position vanished or froze while it drove; stopping"
            )
            self._stops_left = _STOP_REPEATS

    def _is_fresh(self, now: float, heard: float) -> bool:
        """Whether the newest message of a stream, heard at ``heard``, s, is new enough to count."""
        return is_recent(now, heard, self._config.control.stream_timeout)

    def _forget_wish(self) -> None:
        with self._lock:
            self._setpoint.forget()

    def _twist_to_wish(self, now: float, estimate: Estimate) -> Twist | None:
        """Return the twist towards the setpoint; None without one."""
        with self._lock:
            target = self._setpoint.target
        if target is None:
            return None
        max_speed = self._parameters.values.robot_max_speed
        if estimate.knowledge is Knowledge.ROUGH:
            max_speed = min(max_speed, self._config.walk.careful_speed)
        twist = self._loop.tick(estimate.pose, target, max_speed)
        if not self._loop.arrived:
            return None if self._gives_up(now, estimate.pose.distance_to(*target)) else twist
        if self._stops_left == 0:
            # Other programs may steer now: this node does not drive the robot back to the setpoint.
            with self._lock:
                self._setpoint.fulfilled(now)
        return None

    def _gives_up(self, now: float, distance: float) -> bool:
        """Whether to give up the setpoint, so many m off, as out of reach; it is forgotten then."""
        with self._lock:
            is_given_up = self._setpoint.drop_if_out_of_reach(now, distance)
        if is_given_up:
            rospy.logwarn(
                "change_position is given up %.2f m from its point: the robot came no nearer for "
                "%g s",
                distance,
                self._config.control.given_up_after,
            )
        return is_given_up

    def _twist_to_heading(self, pose: Pose, heading: float) -> Twist:
        """Return the twist that turns the robot on the spot to a heading, rad."""
        x, y = pose.x + _AHEAD * math.cos(heading), pose.y + _AHEAD * math.sin(heading)
        return Twist(0.0, self._loop.tick(pose, (x, y), 0.0).angular)

    def _twist_to_look_around(self, now: float) -> Twist | None:
        with self._lock:
            is_wanted = self._setpoint.is_wished(now) or self._place.is_asked_to_search
        is_wanted |= self._is_fresh(now, self._look_asked)
        is_allowed = self._may_look_around and is_wanted
        return self._place.look_around(now) if is_allowed else None

    def _command_drive(self, twist: Twist | None) -> None:
        """Publish a twist; after the last one, stop a few times and then leave the drive."""
        if twist is not None:
            self._stops_left = _STOP_REPEATS
            self._command.publish(twist_message(twist))
        elif self._stops_left > 0:
            self._stops_left -= 1
            self._command.publish(TwistMessage())

    def _on_wish(self, target: tuple[float, float]) -> None:
        if held := self._held.reason:
            raise MessageError(
                f"the emergency stop holds the drive ({held}); release it, and tell it again"
            )
        values = self._parameters.values
        if not values.allows(*target):
            raise MessageError(
                f"expected coordinates from {values.min_cordinate:g} to {values.max_cordinate:g}, "
                f"got ({target[0]:g}, {target[1]:g})"
            )
        with self._lock:
            self._setpoint.wish(rospy.get_time(), target, self._wishes.get_num_connections())

    def _on_heading(self, heading: float) -> None:
        self._heading = (rospy.get_time(), heading)

    def _on_look_around(self, is_wanted: bool) -> None:
        self._look_asked = rospy.get_time() if is_wanted else -math.inf


def main() -> None:
    """Run the node."""
    run_node("position_pub_node", PositionPubNode)
