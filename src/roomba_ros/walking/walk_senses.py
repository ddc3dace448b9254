"""The senses of a walk on ROS: the newest of each sensor, and what the lidar sees."""

from __future__ import annotations

import threading

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from roomba_robot.msg import Bumper, Cliff, Localization
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from roomba.geometry import Pose, Twist
from roomba.mission.inputs.senses import Senses
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.things.layer import ThingLayer
from roomba_ros.convert.localization import knowledge_of
from roomba_ros.convert.mounts import Mounts, transforms_of
from roomba_ros.convert.readings import (
    OdometryReading,
    Sides,
    StampedPose,
    bumper_of,
    cliff_of,
    odometry_of,
    stamped_pose_of,
)
from roomba_ros.convert.scan import ScanDecoder
from roomba_ros.localization.pose_history import PoseHistory
from roomba_ros.localization.waiting_scans import WaitingScans
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.subscriptions import subscribe


class WalkSenses:
    """Keeps what sensors tell; :meth:`at` puts it together.

    Subscribes: ``pose``, ``localization``, ``odom``, ``bumper``, ``cliff``, ``scan``,
    ``/tf_static`` (where the lidar is mounted).
    """

    def __init__(self) -> None:
        """Connect nothing yet."""
        self._lock = threading.Lock()
        self._poses = PoseHistory()
        self._scans = WaitingScans()
        self._mounts = Mounts()
        self._decoder = ScanDecoder.on_robot(self._mounts, frame_id("base_link"))
        self._lidar: tuple[LidarModel, LidarBeams] | None = None
        self._knowledge, self._trouble = Knowledge.KNOWN, ""
        self._twist = Twist()
        self._bumper = self._cliff = Sides(False, False)

    def start(self) -> None:
        """Connect."""
        subscribe("localization", Localization, knowledge_of, self._on_localization)
        subscribe("pose", PoseStamped, stamped_pose_of, self._on_pose, tcp_nodelay=True)
        subscribe("odom", Odometry, odometry_of, self._on_odometry)
        subscribe("bumper", Bumper, bumper_of, self._on_bumper, tcp_nodelay=True)
        subscribe("cliff", Cliff, cliff_of, self._on_cliff, tcp_nodelay=True)
        decode = self._decoder.decode
        subscribe("scan", LaserScan, decode, self._scans.put, queue_size=5, tcp_nodelay=True)
        subscribe("/tf_static", TFMessage, transforms_of, self._mounts.add, queue_size=10)

    @property
    def pose(self) -> Pose | None:
        """Where the robot was told to be last, map frame; None before that."""
        with self._lock:
            newest = self._poses.newest
        return None if newest is None else newest[1]

    def at(self, now: float) -> Senses | None:
        """Return all that is sensed at a time, s; None before the first pose."""
        pose = self.pose
        if pose is None:
            return None
        return Senses(
            now, pose, self._twist, self._knowledge, self._trouble, *self._bumper, *self._cliff
        )

    def show(self, things: ThingLayer) -> None:
        """Show a layer of things the newest scan whose place is told, if the robot knows it."""
        with self._lock:
            newest = self._poses.newest
            scan = None if newest is None else self._scans.take(newest[0])
            pose = None if scan is None else self._poses.at(scan.stamp)
        if scan is None or pose is None or self._knowledge is not Knowledge.KNOWN:
            return
        if self._lidar is None or self._lidar[0] is not scan.lidar:
            self._lidar = scan.lidar, scan.lidar.arrays()
        things.see(scan.ranges, self._lidar[1], pose)

    def _on_pose(self, told: StampedPose) -> None:
        with self._lock:
            self._poses.add(told.stamp or rospy.get_time(), told.pose)

    def _on_localization(self, told: tuple[Knowledge, str]) -> None:
        self._knowledge, self._trouble = told

    def _on_odometry(self, told: OdometryReading) -> None:
        self._twist = told.twist

    def _on_bumper(self, pressed: Sides) -> None:
        self._bumper = pressed

    def _on_cliff(self, seen: Sides) -> None:
        self._cliff = seen
