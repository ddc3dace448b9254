"""What the mission senses on ROS: the newest of each sensor, and the pose as it is right now."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from typing import Final

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper, Cliff, DockStatus, Localization, WheelDrop
from sensor_msgs.msg import BatteryState, LaserScan
from std_msgs.msg import Float32, UInt16
from tf2_msgs.msg import TFMessage

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.mission.inputs.senses import Battery, Senses
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.things.layer import ThingLayer
from roomba_ros.convert.common import cliff_of, pose_of, pose_of_odometry, twist_of
from roomba_ros.convert.localization import knowledge_of, lidar_of, mount_of, ranges_of
from roomba_ros.convert.mission import battery_of, beams_of
from roomba_ros.localization.waiting_scans import WaitingScans

OLDEST_POSE: Final = 0.5
_SILENCE: Final = 0.4
"""s of the robot's clock, and of wall time, after which a pose counts no more: who told it is
silent. Both, for a fast clock runs on while everybody works."""
_SILENT: Final = "nobody tells its place; is position_pub_node running?"
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
        self._odometry: deque[tuple[float, Pose, Twist]] = deque(maxlen=_KEPT)
        self._pose: tuple[float, Pose] | None = None
        self._heard = 0.0
        self._correction = Pose()
        self._corrected: tuple[float, Pose] | None = None
        self._knowledge, self._trouble = Knowledge.KNOWN, ""
        self._bumper = self._cliff = (False, False)
        self._is_lifted = False
        self._battery: Battery | None = None
        self._is_docked: bool | None = None
        self._beams = beams_of(0)
        self._grains = self._in_bin = 0.0
        self._scans = WaitingScans()
        self._mounts: dict[str, Pose] = {}
        self._lidar: tuple[tuple[object, ...], object] | None = None

    def start(self) -> None:
        """Connect."""
        for topic, kind, callback in (
            ("pose", PoseStamped, self._on_pose),
            ("localization", Localization, self._on_localization),
            ("odom", Odometry, self._on_odometry),
            ("bumper", Bumper, self._on_bumper),
            ("cliff", Cliff, self._on_cliff),
            ("wheel_drop", WheelDrop, self._on_wheel_drop),
            ("battery_state", BatteryState, self._on_battery),
            ("dock_status", DockStatus, self._on_dock),
            ("ir_omni", UInt16, self._on_beams),
            ("scan", LaserScan, self._scans.put),
            ("dirt_detect", UInt16, self._on_dirt),
            ("bin_level", Float32, self._on_bin),
        ):
            rospy.Subscriber(topic, kind, callback, queue_size=5, tcp_nodelay=True)
        rospy.Subscriber("/tf_static", TFMessage, self._on_mounts, queue_size=10)

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
        """Show the newest scan to those who look for things, if the robot knows its place."""
        with self._lock:
            if self._corrected is None:
                return
            scan = self._scans.take(self._odometry[-1][0])
            if scan is None:
                return
            pose = self._correction.compose(self._odometry_at(scan.header.stamp.to_sec()))
        if self._knowledge is not Knowledge.KNOWN:
            return
        try:
            things.see(ranges_of(scan), self._lidar_of(scan), pose)  # type: ignore[arg-type]
        except ValueError as error:
            rospy.logwarn_throttle(10.0, "scan refused: %s", error)

    def _correct(self) -> None:
        """Find out where the odometry's frame is in the map: by pose and odometry of one time.

        So a pose that comes late is none the worse: the wheels tell the way since.
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

    def _lidar_of(self, scan: LaserScan) -> object:
        """Return the lidar of a scan, made anew only when something of it changed."""
        mount = self._mounts.get(scan.header.frame_id, Pose())
        key = (len(scan.ranges), scan.angle_min, scan.angle_increment, scan.range_max, mount)
        if self._lidar is None or self._lidar[0] != key:
            model: LidarModel = lidar_of(scan, mount)
            self._lidar = (key, model.arrays())
        return self._lidar[1]

    def _on_pose(self, message: PoseStamped) -> None:
        pose = pose_of(message)
        if not pose.is_finite:
            rospy.logwarn_throttle(10.0, "pose refused: expected finite numbers, got %s", pose)
            return
        self._heard = time.monotonic()
        with self._lock:
            self._pose = (message.header.stamp.to_sec() or rospy.get_time(), pose)

    def _on_localization(self, message: Localization) -> None:
        try:
            self._knowledge, self._trouble = knowledge_of(message), message.message
        except ValueError as error:
            rospy.logwarn_throttle(10.0, "localization refused: %s", error)

    def _on_odometry(self, message: Odometry) -> None:
        stamp = message.header.stamp.to_sec() or rospy.get_time()
        pose, twist = pose_of_odometry(message), twist_of(message.twist.twist)
        if not (pose.is_finite and twist.is_finite):
            rospy.logwarn_throttle(10.0, "odom refused: expected finite numbers, got %s", pose)
            return
        with self._lock:
            if self._odometry and stamp < self._odometry[-1][0]:
                # The clock was set back.
                self._odometry.clear()
            self._odometry.append((stamp, pose, twist))

    def _on_bumper(self, message: Bumper) -> None:
        self._bumper = (message.is_left_pressed, message.is_right_pressed)

    def _on_cliff(self, message: Cliff) -> None:
        self._cliff = cliff_of(message)

    def _on_wheel_drop(self, message: WheelDrop) -> None:
        self._is_lifted = message.is_left_dropped or message.is_right_dropped

    def _on_battery(self, message: BatteryState) -> None:
        try:
            self._battery = battery_of(message, self._config.battery.nominal_voltage, False)
        except ValueError as error:
            rospy.logwarn_throttle(10.0, "battery_state refused: %s", error)

    def _on_dock(self, message: DockStatus) -> None:
        self._is_docked = message.is_docked

    def _on_beams(self, message: UInt16) -> None:
        self._beams = beams_of(message.data)

    def _on_dirt(self, message: UInt16) -> None:
        self._grains = float(message.data)

    def _on_bin(self, message: Float32) -> None:
        if math.isfinite(message.data):
            self._in_bin = message.data * self._config.brush.bin_capacity

    def _on_mounts(self, message: TFMessage) -> None:
        for transform in message.transforms:
            self._mounts[transform.child_frame_id] = mount_of(transform)


def moved(pose: Pose, twist: Twist, time: float) -> Pose:
    """Return where a pose is after a time, s, in which it moves along the arc of a twist."""
    turn = twist.angular * time
    # The chord of the arc, in the direction of its middle; sin(x)/x for small turns is 1.
    half = 0.5 * turn
    chord = twist.linear * time * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
    return pose.compose(Pose(chord * math.cos(half), chord * math.sin(half), turn))
