"""The topics of the body of a robot that people own: message, rate, and when at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from roomba_robot.msg import BodyState, Bumper, Cliff, DockStatus, HazardDetectionVector, WheelDrop
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import UInt16
from tf2_msgs.msg import TFMessage

from roomba.configuration.robot import RobotConfig
from roomba.mission.docking.beams import NO_BEAMS
from roomba.robot.readings import Readings
from roomba_ros.convert.common import odometry_message, transform_message
from roomba_ros.convert.diagnostics import line_message
from roomba_ros.convert.readings import Sides, code_of_beams
from roomba_ros.convert.sensors import (
    body_message,
    bumper_message,
    cliff_message,
    dock_message,
    hazards_message,
    scan_message,
    told_battery_message,
    told_hazards_of,
    wheel_drop_message,
)
from roomba_ros.runtime.node import frame_id

_OFTEN: Final = 4
_SELDOM: Final = 20
"""Ticks between two messages of what did not change."""


@dataclass(slots=True)
class _ToldTopic:
    """``message(now, told)`` every ``period`` ticks, and at once when ``changes(told)`` does."""

    publisher: rospy.Publisher
    period: int
    message: Callable[[float, Readings], Any]
    changes: Callable[[Readings], object]
    last: object = field(default=None)

    def tell(self, now: float, tick: int, told: Readings) -> None:
        """Publish if it is time to."""
        if self.publisher.get_num_connections() == 0:
            return
        state = self.changes(told)
        if tick % self.period == 0 or state != self.last:
            self.last = state
            self.publisher.publish(self.message(now, told))


class ToldTopics:
    """Tells what the body of a robot that people own tells.

    Publishes: ``body`` (all that is told but the scan), ``odom`` and ``/tf`` (odom -> base_link),
    20 Hz while heard; ``scan``, as it comes; and at each change, but also 5 times a second,
    ``bumper``, ``cliff``, ``wheel_drop`` and ``ir_omni`` (UInt16, the station's beams as Create 2
    codes them), or once a second ``hazard_detection``, ``battery_state`` and ``dock_status``.
    ``/diagnostics`` (how its line is), 1 Hz.
    """

    def __init__(self, config: RobotConfig, robot: str) -> None:
        """Connect all of them; ``robot`` is its name."""
        self._config, self._robot = config, robot
        self._odom, self._base = frame_id("odom"), frame_id("base_link")
        self._laser = frame_id("laser")
        self._ticks = 0
        self._whole = rospy.Publisher("body", BodyState, queue_size=1, tcp_nodelay=True)
        self._odometry = rospy.Publisher("odom", Odometry, queue_size=1, tcp_nodelay=True)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._scan = rospy.Publisher("scan", LaserScan, queue_size=1, tcp_nodelay=True)
        self._line = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
        base = self._base
        self._topics = [
            _topic(
                "bumper",
                Bumper,
                _OFTEN,
                lambda now, told: bumper_message(now, _pressed(told), base),
                _pressed,
            ),
            _topic(
                "cliff",
                Cliff,
                _OFTEN,
                lambda now, told: cliff_message(now, told.cliff, base),
                lambda told: told.cliff,
            ),
            _topic(
                "wheel_drop",
                WheelDrop,
                _OFTEN,
                lambda now, told: wheel_drop_message(now, told, base),
                lambda told: (told.dropped_left, told.dropped_right),
            ),
            _topic(
                "ir_omni",
                UInt16,
                _OFTEN,
                lambda _, told: UInt16(code_of_beams(told.beams)),
                lambda told: told.beams,
            ),
            _topic(
                "hazard_detection",
                HazardDetectionVector,
                _SELDOM,
                lambda now, told: hazards_message(now, told_hazards_of(told), base),
                told_hazards_of,
            ),
            _topic(
                "battery_state",
                BatteryState,
                _SELDOM,
                lambda now, told: told_battery_message(now, told.battery, config.battery),
                lambda told: told.battery.is_docked,
            ),
            _topic(
                "dock_status",
                DockStatus,
                _SELDOM,
                lambda now, told: dock_message(now, base, **_docked(told)),
                _docked,
            ),
        ]

    def tell(self, now: float, told: Readings) -> None:
        """Publish what is due; ``told`` was so at ``now``, s of the ROS clock."""
        pose, twist = told.odometry, told.twist
        if self._whole.get_num_connections() > 0:
            capacity = self._config.brush.bin_capacity
            self._whole.publish(body_message(now, told, capacity, self._odom))
        if self._odometry.get_num_connections() > 0:
            self._odometry.publish(odometry_message(now, pose, twist, self._odom, self._base))
        if self._transforms.get_num_connections() > 0:
            self._transforms.publish([transform_message(now, pose, self._odom, self._base)])
        for topic in self._topics:
            topic.tell(now, self._ticks, told)
        self._ticks += 1
        scan = told.scan
        if scan is not None and self._scan.get_num_connections() > 0:
            began = now - (told.time - scan.stamp)
            message = scan_message(began, scan.ranges, self._config.lidar, self._laser)
            # As it turned, which may be a little slower than its data sheet says.
            message.time_increment = scan.lidar.time_increment
            self._scan.publish(message)

    def tell_line(self, now: float, trouble: str) -> None:
        """Publish how the line is."""
        self._line.publish(line_message(now, trouble, self._robot))


def _topic(
    name: str,
    kind: type,
    period: int,
    message: Callable[[float, Readings], Any],
    changes: Callable[[Readings], object],
) -> _ToldTopic:
    publisher = rospy.Publisher(name, kind, queue_size=1, tcp_nodelay=True)
    return _ToldTopic(publisher, period, message, changes)


def _pressed(told: Readings) -> Sides:
    return Sides(told.bumper_left, told.bumper_right)


def _docked(told: Readings) -> dict[str, bool]:
    return {"is_seen": told.beams != NO_BEAMS, "is_docked": told.battery.is_docked}
