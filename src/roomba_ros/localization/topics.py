"""Localization on ROS: a localizer fed with the sensors' topics."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import replace
from typing import Final

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from roomba_robot.msg import WheelDrop
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse
from tf2_msgs.msg import TFMessage

from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.slam.mapper import Mapper
from roomba_ros.convert.common import map_of
from roomba_ros.convert.localization import SAME_TIME, told_pose_of
from roomba_ros.convert.mounts import Mounts, transforms_of
from roomba_ros.convert.readings import (
    GyroReading,
    OdometryReading,
    Sides,
    odometry_of,
    turning_of,
    wheel_drop_of,
)
from roomba_ros.convert.scan import Scan, ScanDecoder
from roomba_ros.localization.kept_pose import KeptPose
from roomba_ros.localization.place_topics import PlaceTopics
from roomba_ros.localization.waiting_scans import WaitingScans
from roomba_ros.runtime.node import frame_id
from roomba_ros.runtime.subscriptions import subscribe

_KEPT: Final = 40
"""Messages of odometry, and of the gyro, that wait for the next tick: two seconds of them."""
_PLACED: Final = (0.05, 0.05)
"""m, rad; how unsure a place on another map is before a scan confirms it."""


class LocalizationTopics:
    """Feeds a localizer, and lets :class:`PlaceTopics` tell what it knows.

    Subscribes: ``odom``, ``imu``, ``scan``, ``map``, ``wheel_drop``, ``initialpose``,
    ``/tf_static`` (where the lidar is mounted).
    Services: ``global_localization`` (Empty: forget the place, look for it in the whole map).
    """

    def __init__(self, config: RobotConfig) -> None:
        """Connect nothing yet."""
        self._config = config
        self._localizer: Localizer | None = None
        self._lock = threading.Lock()
        self._tick_lock = threading.RLock()
        self._odometry: deque[tuple[float, Pose]] = deque(maxlen=_KEPT)
        self._gyro: deque[GyroReading] = deque(maxlen=_KEPT)
        self._scans = WaitingScans()
        self._told: tuple[Pose, tuple[float, float]] | None = None
        self._new_map: OccupancyMap | None = None
        self._is_asked = False
        self._is_lifted = False
        self._mounts = Mounts()
        self._decoder = ScanDecoder.on_robot(self._mounts, frame_id("base_link"))
        self._stamp = 0.0
        self._newest: tuple[float, Pose] | None = None
        self._kept = KeptPose()
        self._place = PlaceTopics()
        self.mapper: Mapper | None = None
        """Knows the place instead of the localizer, while a map is being made."""
        self.is_mapping_held = False
        """Whether the mapper must wait: its map is being finished."""
        self.seen: Scan | None = None
        """The newest scan that was used."""
        self.is_map_own = False
        """Whether this node makes the map itself: what comes by the topic is left out then."""
        self.is_asked_to_search = False
        """Whether it was asked to find its place, and has not yet."""

    def start(self) -> None:
        """Connect."""
        self._kept.start()
        self._place.start()
        subscribe("map", OccupancyGrid, self._given_map_of, self._on_map)
        subscribe("/tf_static", TFMessage, transforms_of, self._mounts.add, queue_size=10)
        subscribe("odom", Odometry, odometry_of, self._on_odometry, queue_size=10, tcp_nodelay=True)
        subscribe("imu", Imu, turning_of, self._gyro.append, queue_size=10, tcp_nodelay=True)
        subscribe(
            "scan", LaserScan, self._decoder.decode, self._scans.put, queue_size=5, tcp_nodelay=True
        )
        subscribe("wheel_drop", WheelDrop, wheel_drop_of, self._on_wheel_drop)
        subscribe("initialpose", PoseWithCovarianceStamped, told_pose_of, self._on_told)
        rospy.Service("global_localization", Empty, self._on_forget)

    @property
    def localizer(self) -> Localizer | None:
        """The localizer, as soon as odometry came."""
        return self._localizer

    def tick(self, now: float) -> Estimate | None:
        """Take in what came since the last tick, tell where the robot is, and return it.

        ``now`` is in s of the ROS clock. None while nothing is known yet.
        """
        with self._tick_lock:
            return self._tick(now)

    def use_map(self, occupancy: OccupancyMap) -> None:
        """Go on with another map; where the robot is on it must be found out."""
        with self._tick_lock:
            if self._localizer is not None:
                self._localizer.use_map(occupancy)

    def go_on(
        self,
        occupancy: OccupancyMap,
        at: Pose | None,
        deviation: tuple[float, float] = _PLACED,
    ) -> None:
        """Go on with another map on which the robot is ``at`` a pose, m and rad unsure.

        None: at the same as before. The place stays known.
        """
        with self._tick_lock:
            if self._localizer is not None:
                self._localizer.go_on(occupancy, None if at is None else (at, deviation))

    def map_with(self, mapper: Mapper | None) -> None:
        """Let a mapper know the place from now on; None: the localizer again."""
        with self._tick_lock:
            self.mapper, self.is_mapping_held = mapper, False
            if mapper is not None and self._newest is not None:
                mapper.move(*self._newest)

    def _tick(self, now: float) -> Estimate | None:
        localizer = self._localizer = self._localizer or self._first_localizer()
        if localizer is None:
            return None
        self._hear_map(localizer)
        self._hear_odometry(localizer)
        localizer.lift(self._is_lifted)
        if self.mapper is not None:
            self.mapper.lift(self._is_lifted)
        self._hear_people(localizer)
        self._hear_scan(localizer)
        localizer.pass_time(now)
        knower = self.mapper or localizer
        estimate = knower.estimate
        self.is_asked_to_search &= estimate.knowledge is Knowledge.SEARCHING
        self._place.tell(now, self._stamp, knower, estimate)
        if estimate.knowledge is Knowledge.KNOWN:
            self._kept.keep(knower.map_to_odometry)
        return estimate

    @property
    def place(self) -> Pose:
        """Where the robot is by what was told and its wheels, map frame: before there is a map."""
        assert self._localizer is not None
        return self._localizer.estimate.pose

    @property
    def known_place(self) -> Pose | None:
        """Where the robot is, map frame, if that is known."""
        with self._tick_lock:
            estimate = None if self._localizer is None else self._localizer.estimate
        if estimate is None or not estimate.knowledge.is_usable:
            return None
        return estimate.pose

    @property
    def was_here_before(self) -> bool:
        """Whether another process of this node knew the place, and odometry went on since."""
        return self._kept.was_found

    @property
    def is_place_kept(self) -> bool:
        """Whether another process of this node would know the place, and that it was here."""
        return self._kept.is_kept

    def _first_localizer(self) -> Localizer | None:
        """Return a localizer at the place where the first odometry was told; None before that."""
        if not self._odometry:
            return None
        start, deviation = self._kept.start_pose(self._odometry[0][1])
        config = self._config
        return Localizer(
            None, config.localization, config.gyro, config.body.radius, start, deviation
        )

    def _hear_map(self, localizer: Localizer) -> None:
        with self._lock:
            new_map, self._new_map = self._new_map, None
        if new_map is not None:
            localizer.use_map(new_map)

    def _hear_odometry(self, localizer: Localizer) -> None:
        for _ in range(len(self._odometry)):
            self._stamp, pose = self._odometry.popleft()
            self._newest = self._stamp, pose
            turning = self._turning_at(self._stamp)
            localizer.move(self._stamp, pose, turning)
            if self.mapper is not None:
                self.mapper.move(self._stamp, pose, turning)

    def _turning_at(self, stamp: float) -> float | None:
        """Return the gyro's sample of about that time, rad/s."""
        samples = list(self._gyro)
        if not samples:
            return None
        nearest = min(samples, key=lambda sample: abs(sample.stamp - stamp))
        return nearest.turning if abs(nearest.stamp - stamp) < SAME_TIME else None

    def _hear_people(self, localizer: Localizer) -> None:
        with self._lock:
            told, self._told = self._told, None
            is_asked, self._is_asked = self._is_asked, False
        if told is not None:
            localizer.told(*told)
            if self.mapper is not None and not self.is_mapping_held:
                self.mapper.told(told[0])
        if is_asked:
            localizer.forget("it was asked to look for its place anew")
            self.is_asked_to_search = True

    def _hear_scan(self, localizer: Localizer) -> None:
        scan = self._scans.take(self._stamp)
        if scan is None:
            oldest = self._scans.oldest
            if oldest is not None and oldest > self._stamp + self._config.localization.scan_timeout:
                rospy.logwarn_throttle(
                    10.0,
                    "no scan is used: they are of %.2f s, odometry only of %.2f s",
                    oldest,
                    self._stamp,
                )
            return
        self.seen = scan = replace(scan, stamp=scan.stamp or self._stamp)
        if self.mapper is None:
            localizer.see(scan.stamp, scan.ranges, scan.lidar)
        elif not self.is_mapping_held:
            self.mapper.see(scan.stamp, scan.ranges, scan.lidar)

    def _on_odometry(self, told: OdometryReading) -> None:
        self._odometry.append((told.stamp or rospy.get_time(), told.pose))

    def _given_map_of(self, message: OccupancyGrid) -> OccupancyMap | None:
        """Return the map of a message; None if this node made it itself."""
        return None if self.is_map_own else map_of(message)

    def _on_map(self, occupancy: OccupancyMap | None) -> None:
        with self._lock:
            self._new_map = occupancy

    def _on_wheel_drop(self, dropped: Sides) -> None:
        # One wheel hangs over an edge; a robot that is held has both in the air.
        self._is_lifted = dropped.left and dropped.right

    def _on_told(self, told: tuple[Pose, tuple[float, float]]) -> None:
        with self._lock:
            self._told = told

    def _on_forget(self, _: EmptyRequest) -> EmptyResponse:
        with self._lock:
            self._is_asked = True
        return EmptyResponse()
