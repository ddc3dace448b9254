"""A robot that people own on ROS: its body and sensors by a driver, in place of the simulation."""

from __future__ import annotations

import threading
from functools import partial

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from roomba_robot.msg import LineTrouble
from std_msgs.msg import Float32
from tf2_msgs.msg import TFMessage

from roomba.drivers.robots.table import ROBOTS, OwnedRobot
from roomba.errors import ConfigError
from roomba.robot.command import Command
from roomba.robot.readings import Readings
from roomba.vocabulary import NO_REASON, Reason
from roomba_ros.body.drive_link import DriveLink
from roomba_ros.body.frames import BodyFrames
from roomba_ros.body.told_topics import ToldTopics
from roomba_ros.convert.clean_action import line_trouble_message
from roomba_ros.convert.common import transform_message
from roomba_ros.convert.diagnostics import line_message
from roomba_ros.convert.values import duty_of
from roomba_ros.runtime.node import frame_id, run_node
from roomba_ros.runtime.parameters import read_robot_config, read_seed_parameters
from roomba_ros.runtime.subscriptions import subscribe

_LINE_TICKS = 20
"""Ticks between two words of how the line is, if it is as before."""


class RoombaDriverNode:
    """Lets a robot on a line drive as it is told, and tells what its sensors say.

    Publishes: what :class:`ToldTopics` tells, ``/tf`` (odom -> base_link, 20 Hz while heard),
    ``/tf_static`` (where the sensors are on the body), ``/diagnostics`` (how its line is), 1 Hz,
    and ``line_trouble`` (LineTrouble, latched: why the robot cannot be reached, and what helps;
    empty again when it can). While it cannot, nothing else but ``/diagnostics`` is told.
    Subscribes: what :class:`DriveLink` hears (``cmd_vel_out``, ``emergency_stop``);
    ``main_brush_motor``, ``vacuum_motor`` (Float32, duty 0..1, of brush and fan: they are off until
    something is told).
    Parameters: ``~robot`` (a name of the table of robots), ``~port`` (the device of its line),
    ``~lidar_port`` (that of a lidar which has a line of its own), ``~drive_owner`` (the node that
    may drive, or any), ``~frames`` (false: robot_state_publisher tells those below base_link),
    ``robot_config``.
    """

    period: float
    """s of the ROS clock between two ticks."""

    def start(self) -> None:
        """Take the robot over, and connect; raises RoombaError with what to do."""
        parameters = read_seed_parameters()
        config = read_robot_config()
        if parameters.robot_max_speed > config.body.max_speed:
            key = rospy.search_param("robot_max_speed") or "robot_max_speed"
            rospy.set_param(key, config.body.max_speed)
        self.period = config.timing.tick
        kind, port = _kind(), _port()
        self._lock = threading.Lock()
        self._drive = DriveLink(config.body.command_timeout, self._lock)
        self._fan: float | None = None
        self._brush: float | None = None
        self._trouble, self._silent_ticks = NO_REASON, _LINE_TICKS
        self._body = kind.body_on(port, config, _lidar_port())
        self._body.start()
        rospy.loginfo("%s on %s is taken over", kind.title, port)
        self._name, self._ticks = parameters.robot_name, 0
        self._odom_frame, self._base_frame = frame_id("odom"), frame_id("base_link")
        self._topics = ToldTopics(config)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._line = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
        if rospy.get_param("~frames", True):
            self._mounts = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
            self._mounts.publish(BodyFrames(config).mounted())
        self._reached = rospy.Publisher("line_trouble", LineTrouble, queue_size=1, latch=True)
        self._drive.start()
        subscribe("vacuum_motor", Float32, duty_of, partial(self._on_power, "_fan"))
        subscribe("main_brush_motor", Float32, duty_of, partial(self._on_power, "_brush"))

    def tick(self, now: float) -> None:
        """Tell the robot what is wanted, and others what it says."""
        with self._lock:
            command = Command(self._drive.step(self.period), self._fan, self._brush)
        self._body.tell(command)
        trouble = self._body.trouble
        self._tell_line(now, trouble)
        if not trouble:
            self._tell_body(now, self._body.read())

    def stop(self) -> None:
        """Give the robot back."""
        self._body.stop()

    def _tell_body(self, now: float, told: Readings) -> None:
        if self._transforms.get_num_connections() > 0:
            place = told.odometry
            self._transforms.publish(
                [transform_message(now, place, self._odom_frame, self._base_frame)]
            )
        self._topics.tell(now, self._ticks, told)
        self._ticks += 1

    def _tell_line(self, now: float, trouble: Reason) -> None:
        if trouble != self._trouble:
            rospy.logwarn(trouble.text or "the robot answers again")
            self._trouble, self._silent_ticks = trouble, _LINE_TICKS
            self._reached.publish(line_trouble_message(trouble))
        self._silent_ticks += 1
        if self._silent_ticks >= _LINE_TICKS:
            self._silent_ticks = 0
            self._line.publish(line_message(now, trouble.text, self._name))

    def _on_power(self, motor: str, duty: float) -> None:
        with self._lock:
            setattr(self, motor, duty)


def _kind() -> OwnedRobot:
    name = rospy.get_param("~robot", "")
    if name not in ROBOTS:
        known = ", ".join(sorted(ROBOTS))
        raise ConfigError(f"parameter ~robot: expected one of {known}, got {name!r}")
    return ROBOTS[name]


def _port() -> str:
    port = rospy.get_param("~port", "")
    if not isinstance(port, str) or not port:
        raise ConfigError(
            f"parameter ~port: expected a device such as /dev/ttyACM0, got {port!r}; say port:=…"
        )
    return port


def _lidar_port() -> str:
    port = rospy.get_param("~lidar_port", "")
    if not isinstance(port, str):
        raise ConfigError(
            f"parameter ~lidar_port: expected a device such as /dev/ttyUSB1, got {port!r}"
        )
    return port


def main() -> None:
    """Run the node."""
    run_node("roomba_driver_node", RoombaDriverNode)
