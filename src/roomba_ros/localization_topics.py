"""The robot's place on ROS: what the localizer hears, and what it tells."""

from __future__ import annotations

import math
import threading
from collections import deque
from typing import Final

import rospy
from geometry_msgs.msg import PoseArray, PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import Localization, RobotPosition, WheelDrop
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse
from tf2_msgs.msg import TFMessage

from roomba.config import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.estimate import Estimate, Knowledge
from roomba.perception.localizer import Localizer
from roomba.perception.scan_view import LidarModel
from roomba_ros.convert import map_of, pose_message, pose_of_odometry, transform_message
from roomba_ros.convert_localization import (
    covariance_pose_message,
    lidar_of,
    localization_message,
    mount_of,
    poses_message,
    ranges_of,
    told_pose_of,
)
from roomba_ros.kept_pose import KeptPose
from roomba_ros.node import frame_id

_SAME_TIME: Final = 0.06
"""s; a gyro sample so near to an odometry's time is of the same motion."""
_KEPT: Final = 40
"""Messages of odometry, and of the gyro, that wait for the next tick: two seconds of them."""


class LocalizationTopics:
    """Feeds a localizer with what the sensors publish, and publishes where the robot is.

    Publishes: ``position`` (RobotPosition, 10 Hz), ``pose`` (PoseStamped, 20 Hz, map frame),
    ``amcl_pose`` (PoseWithCovarianceStamped, 10 Hz), ``localization`` (Localization, at a change
    and 1 Hz, latched), ``particlecloud`` (PoseArray, where it may be, 2 Hz while heard),
    ``/tf`` (map -> odom).
    Subscribes: ``odom``, ``imu``, ``scan``, ``map``, ``wheel_drop``, ``initialpose``,
    ``/tf_static`` (where the lidar is mounted).
    Services: ``global_localization`` (Empty: forget the place, look for it in the whole map).
    """

    def __init__(self, config: RobotConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._localizer: Localizer | None = None
        self._lock = threading.Lock()
        self._odometry: deque[tuple[float, Pose]] = deque(maxlen=_KEPT)
        self._gyro: deque[tuple[float, float]] = deque(maxlen=_KEPT)
        self._scan: LaserScan | None = None
        self._told: PoseWithCovarianceStamped | None = None
        self._is_forgotten = False
        self._is_lifted = False
        self._new_map: OccupancyMap | None = None
        self._lidar: tuple[tuple[object, ...], LidarModel] | None = None
        self._mounts: dict[str, Pose] = {}
        self._kept = KeptPose()
        self._ticks = 0
        self._said: tuple[Knowledge, str] | None = None
        self._stamp = 0.0
        self._map_frame, self._odom_frame = "map", frame_id("odom")

    def start(self) -> None:
        """Connect."""
        self._kept.start()
        self._position = rospy.Publisher("position", RobotPosition, queue_size=1)
        self._pose = rospy.Publisher("pose", PoseStamped, queue_size=1, tcp_nodelay=True)
        self._amcl_pose = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=1)
        self._state = rospy.Publisher("localization", Localization, queue_size=1, latch=True)
        self._cloud = rospy.Publisher("particlecloud", PoseArray, queue_size=1)
        self._transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        rospy.Subscriber("map", OccupancyGrid, self._on_map, queue_size=1)
        rospy.Subscriber("/tf_static", TFMessage, self._on_mounts, queue_size=10)
        rospy.Subscriber("odom", Odometry, self._on_odometry, queue_size=10, tcp_nodelay=True)
        rospy.Subscriber("imu", Imu, self._on_imu, queue_size=10, tcp_nodelay=True)
        rospy.Subscriber("scan", LaserScan, self._on_scan, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("wheel_drop", WheelDrop, self._on_wheel_drop, queue_size=1)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._on_told, queue_size=1)
        rospy.Service("global_localization", Empty, self._on_forget)

    @property
    def localizer(self) -> Localizer | None:
        """The localizer, as soon as odometry came."""
        return self._localizer

    def tick(self, now: float) -> Estimate | None:
        """Take in what came since the last tick, tell where the robot is, and return it.

        ``now`` is in s of the ROS clock. None while nothing is known yet.
        """
        self._hear_odometry()
        localizer = self._localizer
        if localizer is None:
            return None
        self._hear_people(localizer)
        localizer.lift(self._is_lifted)
        self._hear_scan(localizer)
        localizer.pass_time(now)
        estimate = localizer.estimate
        self._tell(now, localizer, estimate)
        self._keep(localizer, estimate)
        return estimate

    # ---------------------------------------------------------------- hearing

    def _hear_odometry(self) -> None:
        if self._localizer is None and self._odometry:
            start, deviation = self._kept.start_pose(self._odometry[0][1])
            config = self._config
            self._localizer = Localizer(
                self._new_map,
                config.localization,
                config.gyro,
                config.body.radius,
                start,
                deviation,
            )
            self._new_map = None
        if self._localizer is None:
            return
        if self._new_map is not None:
            self._localizer.use_map(self._new_map)
            self._new_map = None
        while self._odometry:
            self._stamp, pose = self._odometry.popleft()
            self._localizer.move(self._stamp, pose, self._turning_at(self._stamp))

    def _turning_at(self, stamp: float) -> float | None:
        """Return the gyro's sample of about that time, rad/s."""
        samples = list(self._gyro)
        if not samples:
            return None
        nearest = min(samples, key=lambda sample: abs(sample[0] - stamp))
        return nearest[1] if abs(nearest[0] - stamp) < _SAME_TIME else None

    def _hear_people(self, localizer: Localizer) -> None:
        with self._lock:
            told, self._told = self._told, None
            is_forgotten, self._is_forgotten = self._is_forgotten, False
        if told is not None:
            localizer.told(*told_pose_of(told))
        if is_forgotten:
            localizer.forget("it was asked to look for its place anew")

    def _hear_scan(self, localizer: Localizer) -> None:
        scan = self._scan
        if scan is None or scan.header.stamp.to_sec() > self._stamp + 1.0:
            # Of a time that odometry has not reached: that clock has still to follow.
            return
        self._scan = None
        try:
            lidar = self._lidar_of(scan)
        except ValueError as error:
            rospy.logwarn_throttle(10.0, "scan refused: %s", error)
            return
        localizer.see(scan.header.stamp.to_sec(), ranges_of(scan), lidar)

    def _lidar_of(self, scan: LaserScan) -> LidarModel:
        """Return the lidar of a scan, made anew only when something of it changed."""
        mount = self._mounts.get(scan.header.frame_id, Pose())
        key = (
            len(scan.ranges),
            scan.angle_min,
            scan.angle_increment,
            scan.range_min,
            scan.range_max,
            mount,
        )
        if self._lidar is None or self._lidar[0] != key:
            self._lidar = (key, lidar_of(scan, mount))
        return self._lidar[1]

    # ---------------------------------------------------------------- telling

    def _tell(self, now: float, localizer: Localizer, estimate: Estimate) -> None:
        # Of the time of the odometry that it follows from, so that others can compare.
        self._pose.publish(pose_message(self._stamp or now, estimate.pose, self._map_frame))
        self._ticks += 1
        if self._ticks % 2 == 0:
            self._position.publish(RobotPosition(estimate.pose.x, estimate.pose.y))
            self._amcl_pose.publish(
                covariance_pose_message(self._stamp or now, estimate, self._map_frame)
            )
            self._transforms.publish(
                [
                    transform_message(
                        now, localizer.map_to_odometry, self._map_frame, self._odom_frame
                    )
                ]
            )
        if self._ticks % 10 == 0 and self._cloud.get_num_connections() > 0:
            self._cloud.publish(poses_message(now, localizer.hypotheses, self._map_frame))
        self._say(now, estimate)

    def _say(self, now: float, estimate: Estimate) -> None:
        said = (estimate.knowledge, estimate.reason)
        has_changed = said != self._said
        if has_changed or self._ticks % 20 == 0:
            self._state.publish(localization_message(now, estimate, self._map_frame))
        if not has_changed:
            return
        before, self._said = self._said, said
        if estimate.knowledge is Knowledge.KNOWN:
            if before is not None:
                rospy.loginfo("the robot knows where it is: %s", _spot(estimate.pose))
        elif before is None or before[0] is not estimate.knowledge:
            rospy.logwarn("the robot's place is %s: %s", *(said[0].value, said[1]))

    def _keep(self, localizer: Localizer, estimate: Estimate) -> None:
        if estimate.knowledge is Knowledge.KNOWN:
            self._kept.keep(localizer.map_to_odometry)

    # ---------------------------------------------------------------- callbacks store

    def _on_odometry(self, message: Odometry) -> None:
        stamp = message.header.stamp.to_sec() or rospy.get_time()
        pose = pose_of_odometry(message)
        if not pose.is_finite:
            rospy.logwarn_throttle(10.0, "odom refused: expected finite numbers, got %s", pose)
            return
        self._odometry.append((stamp, pose))

    def _on_imu(self, message: Imu) -> None:
        turning = message.angular_velocity.z
        if not math.isfinite(turning):
            rospy.logwarn_throttle(10.0, "imu refused: expected finite rad/s, got %s", turning)
            return
        self._gyro.append((message.header.stamp.to_sec(), turning))

    def _on_scan(self, message: LaserScan) -> None:
        self._scan = message

    def _on_map(self, message: OccupancyGrid) -> None:
        try:
            self._new_map = map_of(message)
        except ValueError as error:
            rospy.logwarn("map refused: %s", error)

    def _on_mounts(self, message: TFMessage) -> None:
        for transform in message.transforms:
            self._mounts[transform.child_frame_id] = mount_of(transform)

    def _on_wheel_drop(self, message: WheelDrop) -> None:
        # One wheel hangs over an edge; a robot that is held has both in the air.
        self._is_lifted = message.is_left_dropped and message.is_right_dropped

    def _on_told(self, message: PoseWithCovarianceStamped) -> None:
        if message.header.frame_id not in ("", self._map_frame):
            rospy.logwarn(
                "initialpose refused: expected the frame 'map', got %r", message.header.frame_id
            )
            return
        try:
            told_pose_of(message)
        except ValueError as error:
            rospy.logwarn("initialpose refused: %s", error)
            return
        with self._lock:
            self._told = message

    def _on_forget(self, _: EmptyRequest) -> EmptyResponse:
        with self._lock:
            self._is_forgotten = True
        return EmptyResponse()


def _spot(pose: Pose) -> str:
    return f"({pose.x:.2f}, {pose.y:.2f}), {pose.theta:.2f} rad"
