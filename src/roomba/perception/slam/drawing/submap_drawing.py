"""Keyframes drawn into occupancy counts where the graph of submaps has them."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.mapping import MappingConfig
from roomba.grid import OccupancyMap
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.slam.drawing.occupancy_counts import OccupancyCounts
from roomba.perception.slam.submaps.pose_graph import relative_to
from roomba.perception.slam.submaps.submap import Keyframe
from roomba.perception.slam.submaps.submap_graph import SubmapGraph

_REDRAWN_TURN: Final = 0.002
"""rad; a submap that turned more is drawn anew."""


class SubmapDrawing:
    """Occupancy counts of all keyframes, each drawn where its submap lay then, map frame.

    ``phase``, x and y, m, is where walls lie between the cells of the grid. The lidar must be told
    before anything is drawn: see :meth:`use`.
    """

    def __init__(self, config: MappingConfig, graph: SubmapGraph) -> None:
        """Begin with nothing drawn of a graph."""
        self._config, self._graph = config, graph
        self.phase = (0.0, 0.0)
        self._counts = OccupancyCounts(config.resolution)
        self._drawn = graph.poses.copy()

    def use(self, lidar: LidarBeams) -> None:
        """Draw the scans of a lidar."""
        self._mount = lidar.mount[:2]

    def begin_submap(self) -> None:
        """Draw what comes in the newest submap, which has no keyframe yet."""
        self._drawn = np.vstack((self._drawn, self._graph.poses[-1]))

    def add(self, frame: Keyframe) -> None:
        """Draw a keyframe of the newest submap."""
        self._draw(frame, self._graph.placed(frame.pose))

    @property
    def has_moved(self) -> bool:
        """Whether submaps lie elsewhere than they are drawn."""
        return bool(self._moved())

    def occupancy(self) -> OccupancyMap:
        """Return the map as the graph has it now; raises ValueError before the first keyframe."""
        self._redraw_moved()
        return self._counts.occupancy(
            self._config.occupied_share, self._config.occupied_beams, self._config.least_floor
        )

    def redraw(self) -> None:
        """Draw all keyframes into new occupancy counts, where they are thought to be now."""
        self._counts = OccupancyCounts(self._config.resolution, self.phase)
        for frame, pose in self._graph.keyframes():
            self._draw(frame, pose)
        self._drawn = self._graph.poses.copy()

    def _draw(self, frame: Keyframe, pose: Floats) -> None:
        self._counts.draw(frame.points, self._mount, pose, frame.open)

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
                self._counts.erase(frame.points, self._mount, there, frame.open)
                self._draw(frame, here)
            self._drawn[number] = pose
