"""What the mission senses on ROS: the newest of each sensor, and the pose as it is right now."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, Final

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper, Cliff, DockStatus, Localization, WheelDrop
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Float32, UInt16
from tf2_msgs.msg import TFMessage

from roomba.clock import ClockJumps, is_recent
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.docking.beams import StationBeams
from roomba.mission.inputs.senses import Battery, Senses
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.things.layer import ThingLayer
from roomba_ros.convert.localization import knowledge_of
from roomba_ros.convert.mission import battery_of, beams_of
from roomba_ros.convert.mounts import Mounts, transforms_of
from roomba_ros.convert.readings import (
    OdometryReading,
    Sides,
    StampedPose,
    bumper_of,
    cliff_of,
    is_docked_of,
    odometry_of,
    stamped_pose_of,
    wheel_drop_of,
)
from roomba_ros.convert.scan import ScanDecoder
from roomba_ros.convert.values import data_of, number_of
from roomba_ros.localization.waiting_scans import WaitingScans
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.subscriptions import subscribe

OLDEST_POSE: Final = 0.5
_SILENCE: Final = 0.4
"""s of the robot's clock, and of wall time, after which a pose counts no more: its sender is
silent. Both, because a fast clock runs on while all nodes work."""
_SILENT: Final = "no message tells its place; is position_pub_node running?"
_KEPT: Final = 40
"""Odometry messages that are remembered: two seconds of them."""


class MissionSenses:
    """Keeps what sensors tell; :meth:`at` puts it together.

    Subscribes: ``pose``, ``localization``, ``odom``, ``bumper``, ``cliff``, ``wheel_drop``,
    ``battery_state``, ``dock_status``, ``ir_omni``, ``scan``, ``dirt_detect``, ``bin_level``,
    ``/tf_static`` (where the lidar is mounted).
    """

    def __init__(self, config: RobotConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._lock = threading.Lock()
        self._odometry: deque[OdometryReading] = deque(maxlen=_KEPT)
        self._jumps = ClockJumps()
        self._pose: StampedPose | None = None
        self._heard = 0.0
        self._correction = Pose()
        self._corrected: StampedPose | None = None
        self._knowledge, self._trouble = Knowledge.KNOWN, ""
        self._bumper = self._cliff = Sides(False, False)
        self._is_lifted = False
        self._battery: Battery | None = None
        self._is_docked: bool | None = None
        self._beams = StationBeams()
        self._grains = self._in_bin = 0.0
        self._scans = WaitingScans()
        self._mounts = Mounts()
        self._decoder = ScanDecoder.on_robot(self._mounts, frame_id("base_link"))
        self._lidar: tuple[LidarModel, LidarBeams] | None = None

    def start(self) -> None:
        """Connect."""
        voltage = self._config.battery.nominal_voltage
        topics: tuple[tuple[str, type, Callable[[Any], Any], Callable[[Any], object]], ...] = (
            ("pose", PoseStamped, stamped_pose_of, self._on_pose),
            ("localization", Localization, knowledge_of, self._on_localization),
            ("odom", Odometry, odometry_of, self._on_odometry),
            ("bumper", Bumper, bumper_of, self._on_bumper),
            ("cliff", Cliff, cliff_of, self._on_cliff),
            ("wheel_drop", WheelDrop, wheel_drop_of, self._on_wheel_drop),
            ("battery_state", BatteryState, partial(battery_of, voltage=voltage), self._on_battery),
            ("dock_status", DockStatus, is_docked_of, self._on_dock),
            ("ir_omni", UInt16, data_of, self._on_beams),
            ("scan", LaserScan, self._decoder.decode, self._scans.put),
            ("dirt_detect", UInt16, data_of, self._on_dirt),
            ("bin_level", Float32, number_of, self._on_bin),
            ("/tf_static", TFMessage, transforms_of, self._mounts.add),
        )
        for topic, kind, convert, take in topics:
            subscribe(topic, kind, convert, take, queue_size=5, tcp_nodelay=True)

    def is_late(self, now: float, longest: float) -> bool:
        """Whether the newest pose is ``longest`` s old, or older: the robot must not drive by it.

        It may be another while until it is told that the place is unknown: a busy machine catches
        up.
        """
        stamp = -math.inf if self._corrected is None else self._corrected.stamp
        return now > stamp and not is_recent(now, stamp, longest)

    @property
    def missing(self) -> tuple[str, ...]:
        """The topics without which nothing can be begun and that were not heard yet."""
        heard = {
            "pose": self._pose,
            "odom": self._odometry or None,
            "battery_state": self._battery,
            "dock_status": self._is_docked,
        }
        return tuple(topic for topic, value in heard.items() if value is None)

    def at(self, now: float) -> Senses | None:
        """Return all that is sensed at a time, s; None until enough was heard.

        The pose is that of half a tick later: what is wanted now is driven from now to then.
        """
        with self._lock:
            if self.missing:
                return None
            self._correct()
            stamp, _ = self._corrected or (-math.inf, None)
            newest, odometry, twist = self._odometry[-1]
            correction, battery, is_docked = self._correction, self._battery, self._is_docked
        assert battery is not None
        ahead = min(max(now - newest, 0.0), OLDEST_POSE) + 0.5 * self._config.timing.tick
        knowledge, trouble = self._knowledge, self._trouble
        is_silent = time.monotonic() > self._heard + _SILENCE
        if is_silent and not now - OLDEST_POSE <= stamp:
            knowledge, trouble = Knowledge.SEARCHING, _SILENT
        return Senses(
            now,
            moved(correction.compose(odometry), twist, ahead),
            twist,
            knowledge,
            trouble,
            *self._bumper,
            *self._cliff,
            self._is_lifted,
            self._beams,
            Battery(battery.level, battery.capacity, bool(is_docked)),
            self._grains,
            self._in_bin,
        )

    def show(self, things: ThingLayer) -> None:
        """Add the newest scan to the layer of things, if the robot knows its place."""
        with self._lock:
            if self._corrected is None:
                return
            scan = self._scans.take(self._odometry[-1][0])
            if scan is None:
                return
            pose = self._correction.compose(self._odometry_at(scan.stamp))
        if self._knowledge is not Knowledge.KNOWN:
            return
        if self._lidar is None or self._lidar[0] is not scan.lidar:
            self._lidar = scan.lidar, scan.lidar.arrays()
        things.see(scan.ranges, self._lidar[1], pose)

    def _correct(self) -> None:
        """Find out where the odometry's frame is in the map: by pose and odometry of one time.

        So a pose that comes late is as good: the wheels tell the way since.
        """
        if self._pose is None or self._pose == self._corrected:
            return
        stamp, pose = self._pose
        if self._corrected is not None and stamp > self._odometry[-1][0]:
            # It came before the odometry that it follows from.
            return
        self._correction = pose.compose(self._odometry_at(stamp).inverse())
        self._corrected = self._pose

    def _odometry_at(self, stamp: float) -> Pose:
        """Return where odometry was at a time, or at the nearest to it that is remembered, s."""
        at, pose, twist = min(self._odometry, key=lambda entry: abs(entry[0] - stamp))
        tick = self._config.timing.tick
        return moved(pose, twist, min(max(stamp - at, -tick), tick))

    def _on_pose(self, told: StampedPose) -> None:
        self._heard = time.monotonic()
        with self._lock:
            self._pose = told._replace(stamp=told.stamp or rospy.get_time())

    def _on_localization(self, told: tuple[Knowledge, str]) -> None:
        self._knowledge, self._trouble = told

    def _on_odometry(self, told: OdometryReading) -> None:
        stamp = told.stamp or rospy.get_time()
        with self._lock:
            if self._jumps.at(stamp):
                self._odometry.clear()
            self._odometry.append(told._replace(stamp=stamp))

    def _on_bumper(self, pressed: Sides) -> None:
        self._bumper = pressed

    def _on_cliff(self, seen: Sides) -> None:
        self._cliff = seen

    def _on_wheel_drop(self, dropped: Sides) -> None:
        self._is_lifted = dropped.any

    def _on_battery(self, battery: Battery) -> None:
        self._battery = battery

    def _on_dock(self, is_docked: bool) -> None:
        self._is_docked = is_docked

    def _on_beams(self, code: int) -> None:
        self._beams = beams_of(code)

    def _on_dirt(self, grains: int) -> None:
        self._grains = float(grains)

    def _on_bin(self, level: float) -> None:
        self._in_bin = level * self._config.brush.bin_capacity


def moved(pose: Pose, twist: Twist, time: float) -> Pose:
    """Return where a pose is after a time, s, in which it moves along the arc of a twist."""
    turn = twist.angular * time
    # The chord of the arc, in the direction of its middle; sin(x)/x for small turns is 1.
    half = 0.5 * turn
    chord = twist.linear * time * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
    return pose.compose(Pose(chord * math.cos(half), chord * math.sin(half), turn))
