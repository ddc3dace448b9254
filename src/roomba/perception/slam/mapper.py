"""The mapper: the stages of SLAM put together.

Dead reckoning predicts the pose. Scan matching corrects it against the surfels of the last metres.
Some scans become keyframes of submaps. Loop closures link submaps that show the same walls. The
pose graph places the submaps, and occupancy counts are drawn where it places them. Values are
plain; times are s of the robot's clock.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import FollowingConfig, MappingConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.estimate import Estimate
from roomba.perception.matching.pose_kernels import beyond
from roomba.perception.matching.scan_view import LidarModel, PlacedScan, plain_ranges
from roomba.perception.slam.following.finding_back import FindingBack
from roomba.perception.slam.following.scan_follower import ScanFollower
from roomba.perception.slam.following.scan_kernels import Following
from roomba.perception.slam.mapper_estimate import estimate_at, lost_estimate
from roomba.perception.slam.mapper_state import LidarNumbers, MapperState
from roomba.perception.slam.mirrors.mirrors import PlacedPoints
from roomba.perception.slam.mirrors.search import Touch
from roomba.perception.slam.submap_map import SubmapMap
from roomba.perception.slam.submaps.heading_drift import HeadingDrift
from roomba.perception.slam.submaps.parts import Carried
from roomba.perception.slam.submaps.pose_graph import relative_to
from roomba.perception.slam.submaps.relocation import MapRelocation
from roomba.perception.slam.submaps.submap_graph import CLOUD


class Mapper:
    """Keeps a growing map, and the robot's place on it; call it in the order of time.

    ``at_scan`` is where the robot was at the newest scan that was followed, map frame; ``placed``
    is the newest scan where it was taken, None if it could not be followed.
    """

    def __init__(
        self,
        config: MappingConfig,
        localization: LocalizationConfig,
        gyro: GyroConfig,
        start: Pose,
    ) -> None:
        """Begin at ``start``, which defines the map frame."""
        self._config = config
        self._reckoning = DeadReckoning(localization, gyro)
        self.belief, self.numbers = self._reckoning.belief, self._reckoning.numbers
        self.path = self._reckoning.path
        self._finding_back = FindingBack(config)
        self._follower = ScanFollower(config, self._reckoning, self._finding_back.state)
        self._map = SubmapMap(config, localization, start.as_array())
        self.at_scan = start
        self.placed: PlacedScan | None = None
        self._finished = -1
        self._lidar: LidarModel | None = None
        self._relocation = MapRelocation(config)
        self._is_elsewhere = False
        self._missed_since = math.inf

    @classmethod
    def taken_up(
        cls,
        config: MappingConfig,
        localization: LocalizationConfig,
        gyro: GyroConfig,
        state: MapperState,
        here: Pose,
    ) -> Mapper:
        """Go on with what another mapper knew; the robot is about ``here``, map frame.

        ``here`` may be off by some 0.2 m and 0.1 rad: the next scan tells the exact pose.
        """
        mapper = cls(config, localization, gyro, Pose(*state.poses[0].tolist()))
        mapper._take_over(state, here)
        return mapper

    def state(self) -> MapperState | None:
        """Return all that another mapper needs to go on; None before the first scan.

        The objects in it are never changed later, so that another thread may save them.
        """
        if self._lidar is None or not self.version:
            return None
        lidar, way = LidarNumbers.of(self._lidar), self._follower.way
        return self._map.state(lidar, way, is_lost=not self._relocation.is_placed)

    def begin_guessing(self, localization: LocalizationConfig, following: FollowingConfig) -> None:
        """Go on with guessed odometry, and with the noise of that."""
        self._reckoning.begin_guessing(localization)
        self._map.graph.use_odometry(localization)
        self._follower.begin_guessing(following)

    def end_guessing(self, localization: LocalizationConfig, following: FollowingConfig) -> None:
        """Go on with the wheels, as they were known before."""
        self._reckoning.end_guessing(localization)
        self._map.graph.use_odometry(localization)
        self._follower.end_guessing(following)

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one."""
        self._reckoning.move(stamp, odometry, turning)

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m; one of long ago is left out.

        Raises ValueError for another number of beams than the lidar has.
        """
        follower, self.placed = self._follower, None
        if self._relocation.is_lifted or not follower.find_reckoned(stamp):
            return
        if ranges.shape != (lidar.beams,):
            raise ValueError(f"expected a scan of {lidar.beams} ranges, got shape {ranges.shape}")
        if lidar is not self._lidar:
            self._use(lidar)
        ranges = plain_ranges(ranges)
        points = follower.see(stamp, ranges)
        if self._relocation.is_lost:
            self._relocate(stamp, points)
            return
        if self._is_elsewhere or self._finding_back.is_without_hold(follower):
            seen = self._seen_carried(stamp, Carried.SEEN)
            self._begin_piece(Carried.TOLD if self._is_elsewhere else seen)
        follower.follow(stamp)
        self.finish_scan(stamp, ranges)

    def finish_scan(self, stamp: float, ranges: NDArray[np.float32]) -> None:
        """Do what is left after :meth:`see`, or a kernel, followed the newest scan."""
        follower = self._follower
        if self.version and self._finding_back.is_due:
            seen = self._seen_carried(stamp, Carried.MISSED)
            has_leapt = self._finding_back.search(follower, self._map.clouds())
            if has_leapt:
                self._begin_piece(seen)
        if follower.is_sure and stamp > self._missed_since:
            self._missed_since = math.inf
        follower.compare_turns(stamp)
        is_swept = self._lidar is not None and self._lidar.time_increment
        still = follower.following.still if is_swept else ranges
        if self._is_keyframe():
            self._keep(follower.points, still)
        self.at_scan = self._place()
        if self._lidar is not None:
            self.placed = PlacedScan(self.at_scan, still, ranges, self._lidar)

    @property
    def version(self) -> int:
        """A number that changes whenever the map does; 0 before the first scan."""
        return self._map.version

    @property
    def is_calm(self) -> bool:
        """Whether scans only have to be followed: kernels may do that until :meth:`resumed`."""
        has_keyframe = self.version > 0 and bool(self._map.graph.newest.keyframes)
        is_placed = self._relocation.is_placed and not self._is_elsewhere
        return has_keyframe and self._follower.is_sure and is_placed

    @property
    def following(self) -> Following:
        """The arrays by which kernels follow scans, while the mapper :attr:`is_calm`."""
        return self._follower.following

    @property
    def submap_pose(self) -> Floats:
        """Pose of the newest submap, in which the robot is followed, [3], map frame."""
        pose: Floats = self._map.graph.poses[-1].copy()
        return pose

    def resumed(self) -> None:
        """Go on after kernels that followed scans."""
        self.at_scan = self._place()

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air.

        After it is set down again, the robot is lost until :meth:`told` is called, or two scans
        from different places show where on the map it is.
        """
        self._relocation.lift(is_lifted)

    def feel(self, radius: float, first: float, last: float) -> None:
        """Take a touch of the robot's round body, of ``radius``, m.

        ``first`` and ``last``, rad, robot's frame, are the bearings between which its rim was
        pressed. If scans show that it touched a mirror, the map ends there.
        """
        if self.version and self._relocation.is_placed and not self._is_elsewhere:
            here = self.pose
            turned = here.theta + first, here.theta + last
            newest = PlacedPoints(self._follower.points, self.at_scan.as_array())
            self._map.feel(Touch(here.x, here.y, radius, *turned), newest)

    def go_by_lidar(self) -> None:
        """Do nothing: the map is what the lidar saw, so that its mount must not change."""

    def set_down(self) -> None:
        """Go on where the robot was set down, which is unknown: the map goes on in a new piece.

        The piece begins with the next scan, and is laid where it fits when the map is finished.
        """
        self._relocation.set_down()
        self._is_elsewhere = self.version > 0

    def miss(self, since: float) -> None:
        """Tell that neither scans nor odometry came for long after ``since``, s.

        Scans that do not fit from then on, until the first one that does, count as carried.
        """
        self._missed_since = since

    def told(self, pose: Pose) -> None:
        """Go on from a reported pose of the robot, map frame, right to within a few cm."""
        self._relocation.is_lost = self._is_elsewhere = False
        if not self.version:
            return
        self._map.begin_at(pose.as_array(), self._follower.way, self.range_noise)
        self._follower.jump()
        self.at_scan = pose

    @property
    def pose(self) -> Pose:
        """Where the robot is: at the newest scan, moved by the wheels since, map frame."""
        return self._follower.since(self.at_scan)

    @property
    def start(self) -> Pose:
        """Where the robot began, map frame; it is turned a little when the map is finished."""
        return Pose(*self._map.graph.poses[0].tolist())

    @property
    def estimate(self) -> Estimate:
        """The estimate of the robot's pose."""
        if self._relocation.is_placed:
            return estimate_at(self.pose, self._follower, self._config.following)
        return lost_estimate(self.pose)

    @property
    def pace(self) -> Floats:
        """The robot's pace between the newest two scans that tell it, float64 [3].

        It is ahead and aside, m/s, and turning, rad/s.
        """
        return self._follower.pace

    @property
    def range_noise(self) -> float:
        """Standard deviation of the lidar's ranges, m, as measured so far."""
        return self._follower.range_noise

    @property
    def latency(self) -> float:
        """How late scans are against odometry, s, as learned so far."""
        return self._follower.latency

    @property
    def map_to_odometry(self) -> Pose:
        """Where the frame of the wheels' odometry lies in the map."""
        return self.pose.compose(self._reckoning.odometry.inverse())

    @property
    def hypotheses(self) -> list[Pose]:
        """Where the robot may be: a mapper knows only the place to which it followed the robot."""
        return [self.pose]

    @property
    def sight_to_look_around(self) -> None:
        """None: a mapper looks for no other place."""

    def look_anew(self) -> None:
        """Do nothing, as a mapper looks for no other place."""

    @property
    def newest_keyframe(self) -> tuple[int, Pose]:
        """The number in :attr:`trajectory` of the newest keyframe, and its pose, map frame.

        Raises ValueError before the first scan.
        """
        count, pose = self._map.graph.newest_keyframe()
        return count - 1, Pose(*pose.tolist())

    @property
    def parts_laid(self) -> int:
        """How many parts, seen after the robot was carried, were found on the rest of the map."""
        return self._map.graph.laid

    @property
    def ways_apart(self) -> list[float]:
        """Lengths, m, of the parts of the map of which no scan was found on the rest.

        They lie where dead reckoning puts them.
        """
        return self._map.graph.ways_apart(self._follower.way)

    @property
    def heading_drift(self) -> HeadingDrift:
        """How unsure the least sure heading of the map is, against that of its beginning."""
        return self._map.graph.heading_drift()

    @property
    def trajectory(self) -> Floats:
        """Where keyframes were taken, float64 [n, 3], map frame, in the order of time."""
        return np.array([pose for _, pose in self._map.graph.keyframes()]).reshape(-1, 3)

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now; raises ValueError before the first scan."""
        return self._map.drawn.occupancy()

    def finish(self) -> OccupancyMap:
        """Link all submaps anew, turn the map to its walls, and return it.

        Raises ValueError before the first scan.
        """
        if self.version in (0, self._finished):
            return self.occupancy()
        self._map.finish(self.range_noise)
        self.at_scan = self._place()
        self._finished = self.version
        return self.occupancy()

    def _relocate(self, stamp: float, points: Floats) -> None:
        """Go on where the scan of a carried robot is found on the map, if that is sure."""
        reckoned = self._reckoning.at(stamp - self._follower.latency)
        if reckoned is None or not self.version:
            return
        graph = self._map.graph
        graph.newest.close(CLOUD)
        found = self._relocation.find(points, reckoned.as_array(), graph.submaps, graph.poses)
        if found is not None:
            self.told(Pose(*found.tolist()))

    def _seen_carried(self, stamp: float, missed: Carried) -> Carried | None:
        """Return how a scan shows that the robot was carried; ``missed`` after a long silence."""
        if stamp > self._missed_since:
            return missed
        return Carried.SEEN if self._finding_back.shows_carried else None

    def _begin_piece(self, carried: Carried | None) -> None:
        """Begin a submap of which no scan tells where it lies; scans are matched to it alone.

        It may lie anywhere if the robot was ``carried``.
        """
        follower, self._is_elsewhere = self._follower, False
        unsure = follower.unsure_way, follower.unsure_turn
        self._map.begin_piece(
            follower.here, follower.way, unsure, self.range_noise, carried=carried
        )
        follower.begin_piece()
        self._finding_back.begin_again()

    def _is_keyframe(self) -> bool:
        if not self._map.graph.newest.keyframes:
            return self._follower.shows_enough
        return self._follower.is_sure and self._follower.is_apart

    def _keep(self, points: Floats, ranges: NDArray[np.float32]) -> None:
        """Keep a scan as a keyframe; begin another submap for it if the newest is complete."""
        follower = self._follower
        if self._map.is_newest_whole(follower.here):
            self._map.begin(follower.here, follower.way, self.range_noise)
            follower.restart()
        self._map.keep(points, ranges, follower.here)
        follower.keep()

    def _take_over(self, state: MapperState, here: Pose) -> None:
        row, follower = here.as_array(), self._follower
        self._map.take_over(state, row)
        graph, self._relocation.is_lost = self._map.graph, state.is_lost
        follower.take_up(relative_to(graph.poses[-1:], row[None])[0], state.way)
        if graph.newest.keyframes:
            follower.keep_at(graph.newest.keyframes[-1].pose)
        self._use(state.lidar.model)
        self._map.redraw()
        self.at_scan = here

    def _place(self) -> Pose:
        """Return where the robot was at the newest scan."""
        return Pose(*beyond(*self._map.graph.poses[-1].tolist(), *self._follower.here.tolist()))

    def _use(self, lidar: LidarModel) -> None:
        """Go on with the scans of a lidar."""
        self._lidar, beams = lidar, lidar.arrays()
        self._map.use(beams)
        self._follower.use(beams, self._map.surfels)
