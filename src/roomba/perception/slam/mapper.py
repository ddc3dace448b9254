"""Making a map: the stages put together.

Dead reckoning says how the robot moved, each scan is matched to the surfels of the last metres,
scans are kept as keyframes of submaps, submaps are linked to others that show the same walls, and
all are drawn on a sheet where the links say that they lie. Plain values in and out; times in s of
the robot's clock.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.config import GyroConfig, LocalizationConfig
from roomba.geometry import Pose, wrap_angle
from roomba.grid import OccupancyMap
from roomba.perception.dead_reckoning import DeadReckoning
from roomba.perception.estimate import Estimate, Knowledge
from roomba.perception.scan_view import LidarModel
from roomba.perception.slam.linking import Linker
from roomba.perception.slam.mapping_config import MappingConfig
from roomba.perception.slam.pose_graph import Link, composed, optimised, relative_to
from roomba.perception.slam.sheet import Sheet
from roomba.perception.slam.squaring import phase_of_walls, turn_of_walls
from roomba.perception.slam.submap import Keyframe, Submap, moved
from roomba.perception.slam.surface_kernels import POINT, surface_points
from roomba.perception.slam.surfels import SurfelGrid

Floats = NDArray[np.float64]

_SCALES: Final = np.array([0.1, 0.05, 0.03])
"""m; of the rounds of a match."""
_ROUNDS: Final = 6
_STRIDE: Final = 2
"""Each such point follows the robot; keyframes have all of them."""
_LEAST_BEAMS: Final = 30
_CLOUD: Final = 1500
"""Points of a submap that are matched to others."""
_SPARE: Final = 4.0
"""m; so far a robot gets from the beginning of a submap, at most."""
_LEAST_SPREAD: Final = np.diag([0.001**2, 0.001**2, 0.0005**2])
"""m2, rad2; no prior is surer, be the robot standing or not."""
_REDRAWN_TURN: Final = 0.002
"""rad; a submap that turned more is drawn anew."""
_SURE: Final = np.diag([0.01**2, 0.01**2, 0.005**2])
_UNSURE: Final = np.diag([0.1**2, 0.1**2, 0.05**2])
"""m2, rad2; of the pose against what was seen in the last metres."""
_NOWHERE: Final = np.diag([100.0**2, 100.0**2, math.pi**2])
_OF_PEOPLE: Final = np.diag([0.05**-2, 0.05**-2, 0.05**-2])
"""1/m2, 1/rad2; of a link to where people say that the robot is."""
_WAS_LIFTED: Final = (
    "the robot was lifted while it made its map: put it on its station, or tell where it is (in "
    "RViz: 2D Pose Estimate)"
)
_NO_MATCH: Final = "what is in sight does not fit what was seen just now; going by wheels and gyro"
_REFINEMENTS: Final = 2
"""Times that all links are looked for anew when the map is finished."""


class Mapper:
    """Keeps a map that grows, and the robot's place on it; tell it things in the order of time."""

    def __init__(
        self,
        config: MappingConfig,
        localization: LocalizationConfig,
        gyro: GyroConfig,
        start: Pose,
    ) -> None:
        """Begin at ``start``, map frame: that is where the map's frame comes from."""
        self._config, self._localization = config, localization
        self._reckoning = DeadReckoning(localization, gyro)
        self._submaps = [Submap(0.0)]
        self._poses = np.array([[start.x, start.y, start.theta]])
        self._links: list[Link] = []
        self._here = np.zeros(3)
        self._last = self._reckoning.pose
        self._at_scan = start
        self._way = 0.0
        self._lidar: LidarModel | None = None
        self._phase = (0.0, 0.0)
        self._sheet = Sheet(config.resolution)
        self._drawn = self._poses.copy()
        self.version = 0
        self.met = self.close = 0.0
        self.is_sure = self._is_lifted = self._is_lost = False

    def move(self, stamp: float, odometry: Pose, turning: float | None = None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if there is one."""
        self._reckoning.move(stamp, odometry, turning)

    def see(self, stamp: float, ranges: NDArray[np.float32], lidar: LidarModel) -> None:
        """Take a scan, float32 [beams], m; one of long ago is left out."""
        reckoned = self._reckoning.at(stamp)
        if reckoned is None or self._is_lifted or self._is_lost:
            return
        points = self._points_of(ranges, lidar)
        self._track(reckoned, points)
        if self._is_keyframe(len(points)):
            self._keep(points)
        self._at_scan = Pose(*self._placed(self._here).tolist())

    def lift(self, is_lifted: bool) -> None:
        """Tell whether the wheels hang in the air: set down elsewhere, it must be :meth:`told`."""
        self._is_lost |= self._is_lifted and not is_lifted
        self._is_lifted = is_lifted

    def told(self, pose: Pose) -> None:
        """Go on from where somebody says that the robot is, map frame, to within a few cm."""
        self._is_lost = False
        if not self.version:
            return
        self._close_submap()
        self._last = self._reckoning.pose
        here = _pose_row(pose)
        away = np.hypot(*(self._poses[:, :2] - here[:2]).T)
        parent = int(np.argmin(away))
        relative = relative_to(self._poses[parent : parent + 1], here[None])[0]
        self._links.append(Link(parent, len(self._submaps), relative, _OF_PEOPLE, False))
        self._add_submap(here, np.flatnonzero(away < self._config.link_radius).tolist())

    @property
    def pose(self) -> Pose:
        """Where the robot was at the newest scan and moved to since, map frame."""
        since = self._last.inverse().compose(self._reckoning.pose)
        return self._at_scan.compose(since)

    @property
    def estimate(self) -> Estimate:
        """What is known of where the robot is."""
        if self._is_lifted or self._is_lost:
            return Estimate(self.pose, _NOWHERE, Knowledge.LOST, 0.0, _WAS_LIFTED)
        if self.is_sure:
            return Estimate(self.pose, _SURE, Knowledge.KNOWN, self.met * self.close, "")
        return Estimate(self.pose, _UNSURE, Knowledge.ROUGH, self.met * self.close, _NO_MATCH)

    @property
    def map_to_odometry(self) -> Pose:
        """Where the frame of the wheels' odometry lies in the map."""
        return self.pose.compose(self._reckoning.odometry.inverse())

    @property
    def hypotheses(self) -> list[Pose]:
        """Where the robot may be: it knows of no other place than the one where it came along."""
        return [self.pose]

    @property
    def trajectory(self) -> Floats:
        """Where keyframes were taken, float64 [n, 3], map frame, in the order of time."""
        poses = zip(self._submaps, self._poses, strict=True)
        return np.concatenate([submap.poses(pose) for submap, pose in poses])

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now; raises ValueError before the first scan."""
        return self._sheet.occupancy(self._config.occupied_share, self._config.occupied_beams)

    def finish(self) -> OccupancyMap:
        """Link all submaps anew, turn the map to its walls, and return it."""
        self._close_submap()
        for _ in range(_REFINEMENTS):
            self._link_all()
            self._poses = optimised(self._poses, self._links)
        self._square()
        self._redraw()
        self._at_scan = Pose(*self._placed(self._here).tolist())
        return self.occupancy()

    # ---------------------------------------------------------------- following the robot

    def _track(self, reckoned: Pose, points: Floats) -> None:
        """Move on by dead reckoning, and correct that by the scan."""
        moved_by = self._last.inverse().compose(reckoned)
        self._last = reckoned
        self._way += math.hypot(moved_by.x, moved_by.y)
        prior = _pose_row(Pose(*self._here).compose(moved_by))
        spread = self._spread(float(prior[2]))
        self._here = prior
        self.is_sure = False
        match = self._surfels.match(
            points,
            prior,
            spread,
            _SCALES,
            self._config.point_deviation,
            rounds=_ROUNDS,
            stride=_STRIDE,
        )
        if match is None or match.asked < _LEAST_BEAMS:
            self.met = self.close = 0.0
            return
        self.met, self.close = match.met, match.close
        if match.met >= self._config.least_met and match.close >= self._config.least_close:
            self._here = match.pose
            self._here[2] = wrap_angle(float(self._here[2]))
            self.is_sure = True

    def _spread(self, heading: float) -> Floats:
        """Return how unsure dead reckoning is since the last scan, float64 [3, 3], submap frame."""
        cosine, sine = math.cos(heading), math.sin(heading)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        spread: Floats = turn @ self._reckoning.take_spread() @ turn.T + _LEAST_SPREAD
        return spread

    # ---------------------------------------------------------------- keeping what was seen

    def _is_keyframe(self, points: int) -> bool:
        keyframes = self._submaps[-1].keyframes
        if not keyframes:
            return points >= _LEAST_BEAMS
        if not self.is_sure:
            return False
        away = self._here - keyframes[-1].pose
        turned = abs(wrap_angle(float(away[2])))
        config = self._config
        return math.hypot(away[0], away[1]) >= config.keyframe_way or turned >= config.keyframe_turn

    def _keep(self, points: Floats) -> None:
        """Keep a scan as a keyframe: draw it, and let scans be matched to it."""
        if self._is_submap_whole():
            self._begin_submap()
        frame = Keyframe(points.astype(np.float32), self._here.copy())
        self._submaps[-1].keyframes.append(frame)
        self._surfels.add(points, frame.pose)
        self._draw(frame, self._poses[-1])
        self.version += 1

    def _is_submap_whole(self) -> bool:
        submap = self._submaps[-1]
        is_far = math.hypot(self._here[0], self._here[1]) >= self._config.submap_way
        return is_far or len(submap.keyframes) >= self._config.submap_keyframes

    def _begin_submap(self) -> None:
        """End the submap and begin one where the robot is; scans are matched to both."""
        self._close_submap()
        newest = len(self._submaps) - 1
        self._links.append(self._driven(self._here, self._way - self._submaps[newest].way))
        self._add_submap(self._placed(self._here), [newest])

    def _add_submap(self, pose: Floats, beside: list[int]) -> None:
        """Begin a submap at a pose of the map; scans are matched to those ``beside`` it, too."""
        self._surfels.clear()
        for number in beside:
            relative = relative_to(pose[None], self._poses[number : number + 1])[0]
            for frame in self._submaps[number].keyframes:
                seen_from = composed(relative[None], frame.pose[None])[0]
                self._surfels.add(np.asarray(frame.points, np.float64), seen_from)
        self._poses = np.vstack((self._poses, pose))
        self._drawn = np.vstack((self._drawn, pose))
        self._submaps.append(Submap(self._way))
        self._here = np.zeros(3)
        self._at_scan = Pose(*pose.tolist())

    def _close_submap(self) -> None:
        """Link the newest submap to all that show the same walls, and draw what moved thereby."""
        newest = len(self._submaps) - 1
        self._submaps[newest].close(_CLOUD)
        if newest == 0:
            return
        self._link(newest)
        self._poses = optimised(self._poses, self._links)
        shift = np.abs(relative_to(self._drawn, self._poses))
        if shift[:, :2].max() > self._config.redrawn_shift or shift[:, 2].max() > _REDRAWN_TURN:
            self._redraw()

    def _link(self, child: int) -> None:
        self._links += self._linker.links_to(child, child, self._submaps, self._poses, self._links)

    def _link_all(self) -> None:
        """Look for all links between submaps anew, near where they lie by the present ones."""
        known = self._links
        self._links = [link for link in known if not link.may_be_wrong]
        for child in range(1, len(self._submaps)):
            self._links += self._linker.links_to(child, child, self._submaps, self._poses, known)

    def _driven(self, relative: Floats, way: float) -> Link:
        """Return what following the robot says of the newest submap's place."""
        numbers = self._localization
        deviations = np.array(
            [numbers.way_noise, numbers.way_noise, numbers.turn_noise]
        ) * math.sqrt(max(way, 0.1))
        count = len(self._submaps)
        information = np.diag(deviations**-2.0)
        return Link(count - 1, count, relative.copy(), information, may_be_wrong=False)

    # ---------------------------------------------------------------- drawing

    def _draw(self, frame: Keyframe, submap: Floats) -> None:
        pose = composed(submap[None], frame.pose[None])[0]
        self._sheet.draw(frame.points, self._beams.mount[:2], pose, self._beams.farthest)

    def _redraw(self) -> None:
        """Draw all keyframes on a new sheet, where they are thought to be now."""
        self._sheet = Sheet(self._config.resolution, self._phase)
        for submap, pose in zip(self._submaps, self._poses, strict=True):
            for frame in submap.keyframes:
                self._draw(frame, pose)
        self._drawn = self._poses.copy()
        self.version += 1

    def _square(self) -> None:
        """Turn the map around its beginning so that walls lie along its axes, and along cells."""
        turn = turn_of_walls(self._cloud())
        around = self._poses[0, :2].copy()
        cosine, sine = math.cos(-turn), math.sin(-turn)
        rotation = np.array([[cosine, sine], [-sine, cosine]])
        self._poses[:, :2] = (self._poses[:, :2] - around) @ rotation + around
        self._poses[:, 2] -= turn
        self._phase = phase_of_walls(self._cloud(), self._config.resolution)

    def _cloud(self) -> Floats:
        """Return points of all submaps, float64 [n, 4], map frame."""
        poses = zip(self._submaps, self._poses, strict=True)
        return np.concatenate([moved(submap.cloud, pose) for submap, pose in poses])

    # ---------------------------------------------------------------- parts

    def _placed(self, relative: Floats) -> Floats:
        """Return a pose in the newest submap, [3], in the map's frame."""
        placed: Floats = composed(self._poses[-1:], relative[None])[0]
        return placed

    def _points_of(self, ranges: NDArray[np.float32], lidar: LidarModel) -> Floats:
        """Return what the beams met, float64 [n, 4]."""
        if lidar is not self._lidar:
            self._use(lidar)
        beams = self._beams
        points = np.empty((lidar.beams, POINT))
        count = surface_points(
            ranges, beams.directions, beams.mount, beams.nearest, beams.farthest, points
        )
        return points[:count]

    def _use(self, lidar: LidarModel) -> None:
        """Make what depends on the lidar."""
        self._lidar, self._beams = lidar, lidar.arrays()
        self._surfels = SurfelGrid(self._beams.farthest + _SPARE)
        self._linker = Linker(self._config, self._beams.farthest + _SPARE)


def _pose_row(pose: Pose) -> Floats:
    return np.array([pose.x, pose.y, pose.theta])
