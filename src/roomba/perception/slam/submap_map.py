"""The map that grows: keyframes in submaps, the surfels that scans are matched to, the drawing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.slam.drawing.open_ways import open_ways
from roomba.perception.slam.drawing.submap_drawing import SubmapDrawing
from roomba.perception.slam.finishing.finish import finish
from roomba.perception.slam.mapper_state import LidarNumbers, MapperState
from roomba.perception.slam.mirrors.mirrors import Mirrors, PlacedPoints
from roomba.perception.slam.mirrors.search import Touch
from roomba.perception.slam.scan_matching.surfels import SurfelGrid
from roomba.perception.slam.submaps.parts import Carried
from roomba.perception.slam.submaps.pose_graph import composed
from roomba.perception.slam.submaps.submap import KeptSubmap, Keyframe, moved
from roomba.perception.slam.submaps.submap_graph import SubmapGraph


class SubmapMap:
    """Submaps in their ``graph``, the ``mirrors`` among them, and how all is ``drawn``.

    Scans are matched to ``surfels``, in the frame of the newest submap: those of this submap and of
    the submaps ``beside`` it, by their numbers. ``version`` changes whenever the map does. Call
    :meth:`use` with the lidar before a scan is kept.
    """

    def __init__(
        self, config: MappingConfig, localization: LocalizationConfig, start: Floats
    ) -> None:
        """Begin with an empty submap at ``start``, float64 [3], map frame."""
        self._config = config
        self.graph = SubmapGraph(config, localization, start)
        self.mirrors = Mirrors(self.graph)
        self.drawn = SubmapDrawing(config, self.graph, self.mirrors)
        self.surfels = SurfelGrid(0.0)
        self.beside: list[int] = []
        self._last_kept: tuple[int, Floats] | None = None
        """Submap and pose of the last keyframe; None if the robot's pose may have leapt since."""
        self.version = 0

    def take_over(self, state: MapperState, here: Floats) -> None:
        """Go on with what another mapper knew; the robot is about ``here`` [3], map frame.

        It is complete after :meth:`use`, with the lidar, and :meth:`redraw`.
        """
        self.graph.take_over(state.submaps, state.poses, state.links)
        self.mirrors.take_over(state.mirrors)
        self.drawn.phase, self.version = state.phase, state.version
        self.beside = self.graph.near(here)

    def state(self, lidar: LidarNumbers, way: float, *, is_lost: bool) -> MapperState:
        """Return the whole map as a state, with what the mapper knows besides."""
        graph = self.graph
        submaps = tuple(KeptSubmap(each.way, tuple(each.keyframes)) for each in graph.submaps)
        return MapperState(
            submaps,
            graph.poses.copy(),
            tuple(graph.links),
            way,
            self.drawn.phase,
            lidar,
            self.version,
            is_lost,
            self.mirrors.kept,
        )

    def use(self, lidar: LidarBeams) -> None:
        """Take the scans of a lidar from now on: makes ``surfels`` anew."""
        reach = min(lidar.farthest, self._config.farthest) + self._config.spare
        self.graph.use_reach(reach)
        self.drawn.use(lidar)
        self._lidar = lidar
        self.surfels = SurfelGrid(reach)
        self._fill_surfels(sorted({*self.beside, self._newest}))

    def keep(self, points: Floats, ranges: NDArray[np.float32], here: Floats) -> None:
        """Keep a scan, taken at ``here`` [3], newest submap's frame.

        ``points`` [n, 4], robot's frame, are those of the scan; ``ranges`` float32 [beams], m, are
        as if all were measured at once.
        """
        config = self._config.open_ways
        ways = open_ways(ranges, self._lidar, config.farthest, config.margin)
        frame = Keyframe(points.astype(np.float32), here, ways)
        self._leave_mirrors_behind(frame)
        self.graph.newest.keyframes.append(frame)
        self.surfels.add(points, frame.pose)
        self.drawn.add(frame)
        self.version += 1

    def feel(self, touch: Touch, newest: PlacedPoints) -> None:
        """Take a touch of the robot's body, map frame, which may be of a mirror.

        ``newest`` is the scan before the touch.
        """
        if self.mirrors.feel(touch, newest, self._lidar.mount, self.drawn.occupancy()):
            self.version += 1

    def is_newest_whole(self, here: Floats) -> bool:
        """Whether a keyframe at ``here`` [3], newest submap's frame, is to begin another submap."""
        is_far = math.hypot(here[0], here[1]) >= self._config.submap_way
        return is_far or len(self.graph.newest.keyframes) >= self._config.submap_keyframes

    def begin(self, here: Floats, way: float, range_noise: float) -> None:
        """Begin a submap at ``here`` [3], newest one's frame, after ``way``, m, in all."""
        self.close(range_noise)
        self.graph.begin(here, way)
        self._enter_newest([self._newest - 1])

    def begin_piece(
        self,
        here: Floats,
        way: float,
        unsure: tuple[float, float],
        range_noise: float,
        *,
        carried: Carried | None,
    ) -> None:
        """Begin a submap of which no scan tells where it lies; scans are matched to it alone.

        The arguments are as of :meth:`begin`; ``unsure`` is what was driven, m, and turned, rad,
        unconfirmed. The submap may lie anywhere if the robot was ``carried``.
        """
        self.close(range_noise)
        self.graph.begin_piece(here, way, *unsure, carried=carried)
        self._last_kept = None
        self._enter_newest([])

    def begin_at(self, pose: Floats, way: float, range_noise: float) -> None:
        """Begin a submap at a reported pose [3], map frame; match scans to submaps near by, too."""
        self.close(range_noise)
        beside = self.graph.near(pose)
        self.graph.begin_at(pose, way)
        self._last_kept = None
        self._enter_newest(beside)

    def close(self, range_noise: float) -> None:
        """Link the newest submap, by which others may move, and look at mirrors.

        ``range_noise`` is the standard deviation of a range, m.
        """
        self.graph.use_noise(range_noise)
        self.graph.close()
        self.version += self.drawn.has_moved
        self._look_at_mirrors()

    def finish(self, range_noise: float) -> None:
        """Make all keyframes agree, and draw the map anew with walls along the axes."""
        self.close(range_noise)
        self.drawn.phase = finish(self.graph, self._config)
        self.redraw()
        self.version += self.mirrors.see_all(self._lidar.mount, self.drawn.occupancy)

    def redraw(self) -> None:
        """Draw the whole map anew."""
        self.drawn.redraw()
        self.version += 1

    def clouds(self) -> list[Floats]:
        """Return the points, [n, 4], of each keyframe that scans are matched to.

        They are in the newest submap's frame.
        """
        frames = self.graph.keyframes_beside([*self.beside, self._newest])
        return [moved(frame.points, pose) for frame, pose in frames]

    def _look_at_mirrors(self) -> None:
        """Update the mirrors by the newest submap, which is closed."""
        if self.graph.newest.keyframes:
            mount = self._lidar.mount
            self.version += self.mirrors.see(self._newest, mount, self.drawn.occupancy)

    def _leave_mirrors_behind(self, frame: Keyframe) -> None:
        """Forget mirrors that the robot drove through since the last keyframe, if it drove."""
        here = self.graph.placed(frame.pose)
        if self._last_kept is not None and len(self.mirrors):
            number, pose = self._last_kept
            last = composed(self.graph.poses[number : number + 1], pose[None])[0]
            self.version += self.mirrors.pass_through(last[:2], here[:2])
        self._last_kept = self._newest, frame.pose

    @property
    def _newest(self) -> int:
        return len(self.graph.submaps) - 1

    def _enter_newest(self, beside: list[int]) -> None:
        """Begin to draw the newest submap, and match scans to it and the submaps ``beside`` it."""
        self.drawn.begin_submap()
        self.beside = beside
        self._fill_surfels(beside)

    def _fill_surfels(self, numbers: list[int]) -> None:
        self.surfels.clear()
        for frame, pose in self.graph.keyframes_beside(numbers):
            self.surfels.add(np.asarray(frame.points, np.float64), pose)
