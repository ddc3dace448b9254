"""Localization on ROS: a localizer fed with the sensors' topics."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Final

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from roomba.configuration.nodes import NodesConfig
from roomba.configuration.robot import RobotConfig
from roomba.geometry import Pose, Twist
from roomba.grid import OccupancyMap
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.perception.slam.mapper import Mapper
from roomba.robot.place import PlaceKeeper
from roomba.robot.readings import Readings, ScanReading
from roomba_ros.convert.common import map_of
from roomba_ros.convert.localization import told_pose_of
from roomba_ros.localization.calibration_topics import CalibrationTopics
from roomba_ros.localization.kept_pose import KeptPose
from roomba_ros.localization.place_topics import PlaceTopics
from roomba_ros.runtime.subscriptions import subscribe
from roomba_ros.senses.body_topics import BodyTopics

_HEARD: Final = ("odom", "imu", "scan", "wheel_drop", "bumper", "cliff")
_ALWAYS: Final = ("odom",)
"""Always subscribed to: the assignment asks that of ``position_pub_node``."""


class LocalizationTopics:
    """Keeps the robot's place, and lets :class:`PlaceTopics` tell it.

    Subscribes: ``map``, ``initialpose``, and of :class:`BodyTopics` ``odom`` always, and ``imu``,
    ``scan``, ``wheel_drop``, ``bumper``, ``cliff``.
    Publishes: what :class:`PlaceTopics` and :class:`CalibrationTopics` tell.
    Services: ``global_localization`` (Empty: forget the place, look for it in the whole map).
    """

    def __init__(self, config: RobotConfig, nodes: NodesConfig) -> None:
        """Connect nothing yet."""
        self._config, self._placing = config, nodes.placing
        self._body = BodyTopics(config, *_HEARD, always=_ALWAYS)
        self._localizer: Localizer | None = None
        self._keeper: PlaceKeeper | None = None
        self._newest: Readings | None = None
        self._heard: list[Readings] = []
        self._heard_from = Pose()
        self._lock = threading.Lock()
        self._tick_lock = threading.RLock()
        self._told: tuple[Pose, tuple[float, float]] | None = None
        self._new_map: OccupancyMap | None = None
        self._is_asked = False
        self._kept = KeptPose(nodes.memory.pose, nodes.placing)
        self._place = PlaceTopics(nodes.periods, config.body.radius)
        self._calibration = CalibrationTopics()
        self.mapper: Mapper | None = None
        """While a map is being made, the mapper; it estimates the pose in place of the
        localizer."""
        self.is_mapping_held = False
        """Whether the mapper must wait: its map is being finished."""
        self.seen: ScanReading | None = None
        """The newest scan that was used."""
        self.is_map_own = False
        """Whether this node makes the map itself: messages of the topic ``map`` are then
        ignored."""
        self.is_asked_to_search = False
        """Whether a service asked it to find its place, and it has not found it yet."""

    def start(self) -> None:
        """Connect."""
        self._kept.start()
        self._place.start()
        self._calibration.start()
        subscribe("map", OccupancyGrid, self._given_map_of, self._on_map)
        self._body.start()
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
        """Go on with another map, on which the robot's place is unknown and must be found."""
        with self._tick_lock:
            if self._localizer is not None:
                self._localizer.use_map(occupancy)

    def go_on(
        self,
        occupancy: OccupancyMap,
        at: Pose | None,
        deviation: tuple[float, float] | None = None,
    ) -> None:
        """Go on with another map on which the robot is ``at`` a pose, m and rad unsure.

        ``at`` None: the pose is the same as before; ``deviation`` None: the default for another
        map. The place stays known.
        """
        with self._tick_lock:
            if self._localizer is not None:
                self._localizer.go_on(
                    occupancy, None if at is None else (at, deviation or self._placing.on_map)
                )

    def map_with(self, mapper: Mapper | None) -> None:
        """Let a mapper estimate the pose from now on; None: the localizer again."""
        with self._tick_lock:
            self.mapper, self.is_mapping_held = mapper, False
            keeper, localizer = self._keeper, self._localizer
            if keeper is None or localizer is None:
                return
            before, keeper.place = keeper.place, mapper or localizer
            Calibration.of(before.belief).take_up(keeper.place.belief)
            if mapper is not None:
                self._begin_map(mapper)

    def _begin_map(self, mapper: Mapper) -> None:
        """Feed a new mapper with the readings of the last tick, and with the newest scan."""
        for readings in self._heard:
            mapper.move(readings.time, readings.odometry, readings.turning)
        if self.seen is not None:
            mapper.see(self.seen.stamp, self.seen.ranges, self.seen.lidar)

    def look_around(self, now: float) -> Twist | None:
        """Return what is to be driven to find the place; None while that does not help."""
        keeper, newest = self._keeper, self._newest
        if keeper is None or newest is None:
            return None
        return keeper.look_around(now, touches=newest.bumps or newest.cliff.any)

    def _tick(self, now: float) -> Estimate | None:
        told = self._body.take()
        self._heard = told or self._heard[-1:]
        if self._localizer is None and told:
            self._begin(told[0])
        localizer, keeper, mapper = self._localizer, self._keeper, self.mapper
        if localizer is None or keeper is None:
            return None
        self._hear_map(localizer)
        for index, readings in enumerate(told):
            self._follow(keeper, localizer, readings)
            if index == 0:
                self._heard_from = localizer.pose
        if not told:
            self._heard_from = localizer.pose
        self._hear_people(localizer)
        localizer.pass_time(now)
        knower = mapper or localizer
        estimate = knower.estimate
        self.is_asked_to_search &= estimate.knowledge is Knowledge.SEARCHING
        stamp = now if self._newest is None else self._newest.time
        self._place.tell(now, stamp, knower, estimate)
        self._calibration.tell(now, knower)
        if estimate.knowledge is Knowledge.KNOWN:
            self._kept.keep(knower.map_to_odometry)
        return estimate

    @property
    def place(self) -> Pose:
        """Where the robot is, map frame, by start pose and wheels; known before there is a map."""
        assert self._localizer is not None
        return self._localizer.pose

    @property
    def place_heard_from(self) -> Pose:
        """Where the robot was, map frame, at the first of those readings.

        They are the readings of the last tick, with which a new map begins.
        """
        return self._heard_from

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
        """Whether a restarted node would know the place."""
        return self._kept.is_kept

    def _begin(self, readings: Readings) -> None:
        """Make the localizer at the first odometry, which tells where it begins."""
        start, deviation = self._kept.start_pose(readings.odometry)
        config = self._config
        self._localizer = Localizer(
            None,
            config.localization,
            config.gyro,
            config.body.radius,
            start,
            deviation,
            config.scan_stride,
        )
        self._calibration.begin(self._localizer, config.body.wheel_separation)
        self._keeper = PlaceKeeper(self._localizer, config)

    def _hear_map(self, localizer: Localizer) -> None:
        with self._lock:
            new_map, self._new_map = self._new_map, None
        if new_map is not None:
            localizer.use_map(new_map)

    def _follow(self, keeper: PlaceKeeper, localizer: Localizer, readings: Readings) -> None:
        """Follow the robot by what its body tells."""
        self._newest = readings
        if self.mapper is not None:
            # The localizer goes on from there, by wheels and gyro, when the map is finished.
            localizer.lift(readings.is_lifted)
            localizer.move(readings.time, readings.odometry, readings.turning)
        if self.is_mapping_held:
            readings = replace(readings, scan=None, bumper_left=False, bumper_right=False)
        self.seen = keeper.follow(readings) or self.seen

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

    def _given_map_of(self, message: OccupancyGrid) -> OccupancyMap | None:
        """Return the map of a message; None if this node made it itself."""
        return None if self.is_map_own else map_of(message)

    def _on_map(self, occupancy: OccupancyMap | None) -> None:
        with self._lock:
            self._new_map = occupancy

    def _on_told(self, told: tuple[Pose, tuple[float, float]]) -> None:
        with self._lock:
            self._told = told

    def _on_forget(self, _: EmptyRequest) -> EmptyResponse:
        with self._lock:
            self._is_asked = True
        return EmptyResponse()
