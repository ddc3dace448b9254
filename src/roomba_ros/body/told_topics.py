"""The topics of any body, simulated or real: messages, rates, and which are sent at a change."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from operator import attrgetter
from typing import Final

import rospy
from nav_msgs.msg import Odometry
from roomba_robot.msg import BodyState, Bumper, Cliff, DockStatus, HazardDetectionVector, WheelDrop
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import UInt16

from roomba.configuration.robot import RobotConfig
from roomba.mission.docking.beams import NO_BEAMS
from roomba.robot.readings import Readings, ScanReading
from roomba_ros.body.told_topic import ToldTopic
from roomba_ros.convert.common import odometry_message
from roomba_ros.convert.readings import code_of_beams
from roomba_ros.convert.sensors import (
    battery_message,
    body_message,
    bumper_message,
    cliff_message,
    dock_message,
    hazards_message,
    hazards_of,
    scan_message,
    wheel_drop_message,
)
from roomba_ros.runtime.node import frame_id

_EACH: Final = 1
_OFTEN: Final = 4
_SELDOM: Final = 20
"""Ticks between two messages of what did not change."""


class ToldTopics:
    """Tells what a body tells its brain.

    Publishes: ``odom`` and ``body`` (all that is told but the scan), 20 Hz while heard; ``scan``,
    as it comes; and at each change, but also 5 times a second, ``bumper``, ``cliff``,
    ``wheel_drop`` and ``ir_omni`` (UInt16, the station's beams as Create 2 codes them), or once a
    second ``hazard_detection``, ``battery_state`` and ``dock_status``.
    """

    def __init__(
        self,
        config: RobotConfig,
        hazards: Callable[[Readings], tuple[int, ...]] = hazards_of,
        battery: Callable[[float, Readings], BatteryState] | None = None,
    ) -> None:
        """Connect all of them.

        A body that measures more than the readings hold passes functions for it: ``hazards``
        returns the types of HazardDetection that hold, ``battery`` the battery's message at a time,
        s.
        """
        self._lidar, self._laser = config.lidar, frame_id("laser")
        base, odom = frame_id("base_link"), frame_id("odom")
        capacity = config.brush.bin_capacity
        self._scan = rospy.Publisher("scan", LaserScan, queue_size=1, tcp_nodelay=True)
        self._topics: list[ToldTopic[Readings]] = [
            ToldTopic(
                "odom",
                Odometry,
                _EACH,
                lambda now, told: odometry_message(now, told.odometry, told.twist, odom, base),
            ),
            ToldTopic(
                "body",
                BodyState,
                _EACH,
                lambda now, told: body_message(now, told, capacity, odom),
            ),
            ToldTopic(
                "bumper",
                Bumper,
                _OFTEN,
                lambda now, told: bumper_message(now, told, base),
                attrgetter("bumper_left", "bumper_right"),
            ),
            ToldTopic(
                "cliff",
                Cliff,
                _OFTEN,
                lambda now, told: cliff_message(now, told, base),
                attrgetter("cliff"),
            ),
            ToldTopic(
                "wheel_drop",
                WheelDrop,
                _OFTEN,
                lambda now, told: wheel_drop_message(now, told, base),
                attrgetter("dropped_left", "dropped_right"),
            ),
            ToldTopic(
                "ir_omni",
                UInt16,
                _OFTEN,
                lambda _, told: UInt16(code_of_beams(told.beams)),
                attrgetter("beams"),
            ),
            ToldTopic(
                "hazard_detection",
                HazardDetectionVector,
                _SELDOM,
                lambda now, told: hazards_message(now, hazards(told), base),
                hazards,
            ),
            ToldTopic(
                "battery_state",
                BatteryState,
                _SELDOM,
                battery or partial(battery_message, config=config.battery),
                attrgetter("battery.is_docked"),
            ),
            ToldTopic(
                "dock_status",
                DockStatus,
                _SELDOM,
                lambda now, told: dock_message(now, told, base),
                lambda told: (told.beams != NO_BEAMS, told.battery.is_docked),
            ),
        ]

    def tell(self, now: float, tick: int, told: Readings) -> None:
        """Publish what is due at a tick; ``told`` are the readings at ``now``, s, ROS clock."""
        for topic in self._topics:
            topic.tell(now, tick, told)
        if told.scan is not None and self._scan.get_num_connections() > 0:
            self._tell_scan(now - (told.time - told.scan.stamp), told.scan)

    def _tell_scan(self, began: float, scan: ScanReading) -> None:
        message = scan_message(began, scan.ranges, self._lidar, self._laser)
        # The lidar's real speed of rotation, which may be a little slower than its data sheet says.
        message.time_increment = scan.lidar.time_increment
        self._scan.publish(message)
