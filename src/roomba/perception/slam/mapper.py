"""The mapper: the stages of SLAM put together.

Dead reckoning says how the robot moved, each scan is matched to the surfels of the last metres,
scans are kept as keyframes of submaps, submaps are linked to others that show the same walls, and
all are drawn into occupancy counts where the links say that they lie. Plain values in and out;
times in s of the robot's clock.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.sensors import GyroConfig
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.perception.localization.dead_reckoning import DeadReckoning
from roomba.perception.localization.estimate import Estimate, Knowledge
from roomba.perception.matching.scan_view import LidarModel
from roomba.perception.slam.finding_back import FindingBack
from roomba.perception.slam.follow_kernels import LEAST_POINTS, beyond, is_apart
from roomba.perception.slam.mapper_state import KeptSubmap, LidarNumbers, MapperState
from roomba.perception.slam.occupancy_counts import OccupancyCounts
from roomba.perception.slam.pose_graph import relative_to
from roomba.perception.slam.relocation import MapRelocation
from roomba.perception.slam.scan_follower import ScanFollower
from roomba.perception.slam.scan_kernels import Following
from roomba.perception.slam.submap import Keyframe, moved
from roomba.perception.slam.submap_graph import CLOUD, SubmapGraph
from roomba.perception.slam.surfels import SurfelGrid

Floats = NDArray[np.float64]

_SPARE: Final = 4.0
"""m; the farthest that a robot gets from the beginning of a submap."""
_REDRAWN_TURN: Final = 0.002
"""rad; a submap that turned more is drawn anew."""
_GIVEN_UP_AFTER: Final = 7
"""Scans that show enough and confirm nothing, searched for twice."""
_PIECE_WAY: Final = 0.6
_PIECE_TURN: Final = 2.0
"""m, rad; driven and turned without a scan that confirms the pose: then the map goes on in a piece
of its own, which is joined when it is known how."""
_FARTHEST: Final = 30.0
"""m; what is farther is drawn, but nothing is matched to it."""
_SURE: Final = np.diag([0.01**2, 0.01**2, 0.005**2])
_UNSURE: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; of the pose against what was seen in the last metres."""
_NOWHERE: Final = np.diag([100.0**2, 100.0**2, math.pi**2])
_WAS_LIFTED: Final = (
    "the robot was lifted while it made its map: put it on its station, tell where it is (in RViz: "
    "2D Pose Estimate), or drive it a little where the map shows enough"
)
_NO_MATCH: Final = "what is in sight does not fit what was seen just now; going by wheels and gyro"


class Mapper:
    """Keeps a growing map, and the robot's place on it; call it in the order of time.

    ``version`` changes whenever the map does.
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
        self._finding_back = FindingBack()
        self._follower = ScanFollower(config, self._reckoning, self._finding_back.state)
        self._graph = SubmapGraph(config, localization, _row_of(start))
        self.at_scan = start
        self._finished = -1
        self._lidar: LidarModel | None = None
        self._phase = (0.0, 0.0)
        self._sheet = OccupancyCounts(config.resolution)
        self._drawn = self._graph.poses.copy()
        self._is_lifted = self._is_lost = False
        self._relocation = MapRelocation()
        self._beside: list[int] = []
        self.version = 0

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

        To within some 0.2 m and 0.1 rad: the next scan tells exactly.
        """
        mapper = cls(config, localization, gyro, Pose(*state.poses[0].tolist()))
        mapper._take_over(state, here)
        return mapper

    def state(self) -> MapperState | None:
        """Return all that another one needs to go on; None before the first scan.

        What it consists of is not changed any more, so that another thread may save it.
        """
        if self._lidar is None or not self.version:
            return None
        graph = self._graph
        return MapperState(
            tuple(KeptSubmap(each.way, tuple(each.keyframes)) for each in graph.submaps),
            graph.poses.copy(),
            tuple(graph.links),
            self._follower.way,
            self._phase,
            LidarNumbers.of(self._lidar),
            self.version,
            self._is_lost or self._is_lifted,
        )

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one."""
        self._reckoning.move(stamp, odometry, turning)

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m; one of long ago is left out.

        Raises ValueError for another number of beams than the lidar has.
        """
        follower = self._follower
        if self._is_lifted or not follower.find_reckoned(stamp):
            return
        if ranges.shape != (lidar.beams,):
            raise ValueError(f"expected a scan of {lidar.beams} ranges, got shape {ranges.shape}")
        if lidar is not self._lidar:
            self._use(lidar)
        points = follower.see(stamp, ranges)
        self._graph.use_noise(follower.range_noise)
        if self._is_lost:
            self._relocate(stamp, points)
            return
        if self._is_without_hold(len(points)):
            self._begin_piece()
        follower.follow(stamp)
        self.finish_scan(stamp)

    def finish_scan(self, stamp: float) -> None:
        """Do what comes after the newest scan was followed: kernels left that, or :meth:`see`."""
        self._find_back()
        self._follower.compare_turns(stamp)
        points = self._follower.points
        if self._is_keyframe(len(points)):
            self._keep(points)
        self.at_scan = self._place()

    @property
    def is_calm(self) -> bool:
        """Whether scans follow each other: kernels may take them, until it has :meth:`resumed`."""
        is_held = self._is_lifted or self._is_lost
        keyframes = self._graph.newest.keyframes
        return self.version > 0 and self._follower.is_sure and not is_held and bool(keyframes)

    @property
    def following(self) -> Following:
        """What kernels follow scans with, while it :attr:`is_calm`."""
        self._follower.state["keyframe"] = self._graph.newest.keyframes[-1].pose
        return self._follower.following

    @property
    def submap_pose(self) -> Floats:
        """Where the submap lies in which the robot is followed, [3], map frame."""
        pose: Floats = self._graph.poses[-1].copy()
        return pose

    def resumed(self) -> None:
        """Go on after kernels that followed scans."""
        self._graph.use_noise(self._follower.range_noise)
        self.at_scan = self._place()

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air.

        Set down again, it is lost until it was :meth:`told`, or two scans from different places
        show where on the map it is.
        """
        if self._is_lifted and not is_lifted:
            self._is_lost = True
            self._relocation.forget()
        self._is_lifted = is_lifted

    def told(self, pose: Pose) -> None:
        """Go on from a reported pose of the robot, map frame, right to within a few cm."""
        self._is_lost = False
        if not self.version:
            return
        self._close_submap()
        here = _row_of(pose)
        beside = self._graph.near(here)
        self._graph.begin_at(here, self._follower.way)
        self._enter_newest(beside)
        self._follower.jump()
        self.at_scan = pose

    @property
    def pose(self) -> Pose:
        """Where the robot was at the newest scan and moved to since, map frame."""
        return self._follower.since(self.at_scan)

    @property
    def start(self) -> Pose:
        """Where it began, map frame; turned a little when the map is finished."""
        return Pose(*self._graph.poses[0].tolist())

    @property
    def estimate(self) -> Estimate:
        """The estimate of the robot's pose."""
        if self._is_lifted or self._is_lost:
            return Estimate(self.pose, _NOWHERE, Knowledge.LOST, 0.0, _WAS_LIFTED)
        agreement = self._follower.met * self._follower.close
        if self._follower.is_sure:
            return Estimate(self.pose, _SURE, Knowledge.KNOWN, agreement, "")
        return Estimate(self.pose, _UNSURE, Knowledge.ROUGH, agreement, _NO_MATCH)

    @property
    def covariance_of_map(self) -> Floats:
        """How sure the map is where the robot is: of that place against the start, [3, 3].

        m2 and rad2, map frame, from the links between submaps: it grows along the way, and shrinks
        where a loop closes.
        """
        return self._graph.covariance()

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
        """Where the robot may be: it knows of no other place than the one where it came along."""
        return [self.pose]

    @property
    def newest_keyframe(self) -> tuple[int, Pose]:
        """The number in :attr:`trajectory` of the newest keyframe, and its pose, map frame.

        Raises ValueError before the first scan.
        """
        submaps = self._graph.submaps
        count = sum(len(submap.keyframes) for submap in submaps)
        if not count:
            raise ValueError("expected a map with a keyframe or more, got an empty one")
        last = max(index for index, submap in enumerate(submaps) if submap.keyframes)
        pose = submaps[last].poses(self._graph.poses[last])[-1]
        return count - 1, Pose(*pose.tolist())

    @property
    def trajectory(self) -> Floats:
        """Where keyframes were taken, float64 [n, 3], map frame, in the order of time."""
        return np.array([pose for _, pose in self._graph.keyframes()]).reshape(-1, 3)

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now; raises ValueError before the first scan."""
        self._redraw_moved()
        return self._sheet.occupancy(self._config.occupied_share, self._config.occupied_beams)

    def occupancy_around(self, x: float, y: float, reach: float) -> OccupancyMap:
        """Return what lies up to ``reach`` m off a place of the map as it is now."""
        self._redraw_moved()
        config = self._config
        return self._sheet.around(x, y, reach, config.occupied_share, config.occupied_beams)

    def finish(self) -> OccupancyMap:
        """Link all submaps anew, turn the map to its walls, and return it.

        Raises ValueError before the first scan.
        """
        if self.version in (0, self._finished):
            return self.occupancy()
        self._close_submap()
        self._graph.refine()
        self._graph.refine_keyframes()
        self._phase = self._graph.square(self._config.resolution)
        self._redraw()
        self.at_scan = self._place()
        self._finished = self.version
        return self.occupancy()

    def _relocate(self, stamp: float, points: Floats) -> None:
        """Go on where a scan of a robot that was carried is found on the map, if it is sure."""
        reckoned = self._reckoning.at(stamp - self._follower.latency)
        if reckoned is None or not self.version:
            return
        self._graph.newest.close(CLOUD)
        graph = self._graph
        found = self._relocation.find(points, _row_of(reckoned), graph.submaps, graph.poses)
        if found is not None:
            self.told(Pose(*found.tolist()))

    def _find_back(self) -> None:
        """Look farther around where scans do not fit."""
        if not self._finding_back.is_due or not self.version:
            return
        frames = self._graph.keyframes_beside([*self._beside, len(self._graph.submaps) - 1])
        clouds = [moved(frame.points, pose) for frame, pose in frames]
        self._finding_back.search(self._follower, clouds)

    # ---------------------------------------------------------------- keeping what was seen

    def _is_without_hold(self, points: int) -> bool:
        """Whether it has gone on for so long unconfirmed that the map must come to where it is."""
        follower = self._follower
        if self._finding_back.misses < _GIVEN_UP_AFTER or points < LEAST_POINTS:
            return False
        return follower.unsure_way > _PIECE_WAY or follower.unsure_turn > _PIECE_TURN

    def _begin_piece(self) -> None:
        """Begin a submap that scans are matched to, though none tells where it lies."""
        self._close_submap()
        follower = self._follower
        self._graph.begin_piece(
            follower.here, follower.way, follower.unsure_way, follower.unsure_turn
        )
        self._enter_newest([])
        self._follower.jump()
        self._finding_back.begin_again()

    def _is_keyframe(self, points: int) -> bool:
        keyframes = self._graph.newest.keyframes
        if not keyframes:
            return points >= LEAST_POINTS
        if not self._follower.is_sure:
            return False
        way, turn = self._config.keyframe_way, self._config.keyframe_turn
        return bool(is_apart(self._follower.here, keyframes[-1].pose, way, turn))

    def _keep(self, points: Floats) -> None:
        """Keep a scan as a keyframe: draw it, and let scans be matched to it."""
        if self._is_submap_whole():
            self._close_submap()
            self._graph.begin(self._follower.here, self._follower.way)
            self._enter_newest([len(self._graph.submaps) - 2])
            self._follower.restart()
        frame = Keyframe(points.astype(np.float32), self._follower.here.copy())
        self._graph.newest.keyframes.append(frame)
        self._surfels.add(points, frame.pose)
        self._draw(frame, self._graph.placed(frame.pose))
        self.version += 1

    def _is_submap_whole(self) -> bool:
        here = self._follower.here
        is_far = math.hypot(here[0], here[1]) >= self._config.submap_way
        return is_far or len(self._graph.newest.keyframes) >= self._config.submap_keyframes

    def _enter_newest(self, beside: list[int]) -> None:
        """Let scans be matched to the submaps of these numbers, as seen from the newest one."""
        self._drawn = np.vstack((self._drawn, self._graph.poses[-1]))
        self._beside = beside
        self._fill_surfels(beside)

    def _fill_surfels(self, numbers: list[int]) -> None:
        self._surfels.clear()
        for frame, pose in self._graph.keyframes_beside(numbers):
            self._surfels.add(np.asarray(frame.points, np.float64), pose)

    def _close_submap(self) -> None:
        """Link the newest submap: others may move thereby, and the map with them."""
        self._graph.close()
        self.version += bool(self._moved())

    # ---------------------------------------------------------------- drawing

    def _draw(self, frame: Keyframe, pose: Floats) -> None:
        self._sheet.draw(frame.points, self._beams.mount[:2], pose, self._beams.farthest)

    def _moved(self) -> list[int]:
        """Return the numbers of the submaps that lie elsewhere than they are drawn."""
        shift = np.abs(relative_to(self._drawn, self._graph.poses))
        far = shift[:, :2].max(axis=1) > self._config.redrawn_shift
        numbers: list[int] = np.flatnonzero(far | (shift[:, 2] > _REDRAWN_TURN)).tolist()
        return numbers

    def _redraw_moved(self) -> None:
        """Draw the keyframes of submaps that moved where they are thought to be now.

        Only when the map is asked for: on a long drive most of them move again and again.
        """
        for number in self._moved():
            submap, pose = self._graph.submaps[number], self._graph.poses[number]
            before, after = submap.poses(self._drawn[number]), submap.poses(pose)
            for frame, there, here in zip(submap.keyframes, before, after, strict=True):
                self._sheet.erase(frame.points, self._beams.mount[:2], there)
                self._draw(frame, here)
            self._drawn[number] = pose

    def _redraw(self) -> None:
        """Draw all keyframes into new occupancy counts, where they are thought to be now."""
        self._sheet = OccupancyCounts(self._config.resolution, self._phase)
        for frame, pose in self._graph.keyframes():
            self._draw(frame, pose)
        self._drawn = self._graph.poses.copy()
        self.version += 1

    # ---------------------------------------------------------------- parts

    def _take_over(self, state: MapperState, here: Pose) -> None:
        graph = self._graph
        graph.take_over(state.submaps, state.poses, state.links)
        self._phase, self.version, self._is_lost = state.phase, state.version, state.is_lost
        relative = relative_to(graph.poses[-1:], _row_of(here)[None])[0]
        self._follower.take_up(relative, state.way)
        self._beside = graph.near(_row_of(here))
        self._use(state.lidar.model)
        self._redraw()
        self.at_scan = here

    def _place(self) -> Pose:
        """Return where the robot was at the newest scan."""
        return Pose(*beyond(*self._graph.poses[-1].tolist(), *self._follower.here.tolist()))

    def _use(self, lidar: LidarModel) -> None:
        """Make what depends on the lidar."""
        self._lidar, self._beams = lidar, lidar.arrays()
        reach = min(self._beams.farthest, _FARTHEST) + _SPARE
        self._graph.use_reach(reach)
        self._graph.use_noise(self._follower.range_noise)
        self._surfels = SurfelGrid(reach)
        self._follower.use(self._beams, self._surfels)
        newest = len(self._graph.submaps) - 1
        self._fill_surfels(sorted({*self._beside, newest}))


def _row_of(pose: Pose) -> Floats:
    return np.array([pose.x, pose.y, pose.theta])
