"""Keyframes drawn into occupancy counts where the graph of submaps has them."""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.arrays import Floats, Floats32
from roomba.configuration.mapping import MappingConfig
from roomba.grid import OccupancyMap
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.slam.drawing.occupancy_counts import OccupancyCounts
from roomba.perception.slam.mirrors.cutting import cut_at
from roomba.perception.slam.mirrors.mirrors import Mirrors
from roomba.perception.slam.submaps.pose_graph import relative_to
from roomba.perception.slam.submaps.submap import Keyframe
from roomba.perception.slam.submaps.submap_graph import SubmapGraph

_REDRAWN_TURN: Final = 0.002
"""rad; a submap that turned more is drawn anew."""


class SubmapDrawing:
    """Occupancy counts of all keyframes, map frame, each drawn where its submap was placed then.

    Beams that pass a mirror are drawn as ending on it. ``phase``, x and y, m, is where walls lie
    between the cells of the grid. Call :meth:`use` with the lidar before anything is drawn.
    """

    def __init__(self, config: MappingConfig, graph: SubmapGraph, mirrors: Mirrors) -> None:
        """Begin with nothing drawn of a graph."""
        self._config, self._graph, self._mirrors = config, graph, mirrors
        self.phase = (0.0, 0.0)
        self._counts = OccupancyCounts(config.resolution)
        self._drawn, self._drawn_mirrors = graph.poses.copy(), mirrors.ends

    def use(self, lidar: LidarBeams) -> None:
        """Draw the scans of a lidar."""
        self._mount = lidar.mount[:2]

    def begin_submap(self) -> None:
        """Draw the following keyframes in the newest submap, which has none yet."""
        self._drawn = np.vstack((self._drawn, self._graph.poses[-1]))

    def add(self, frame: Keyframe) -> None:
        """Draw a keyframe of the newest submap."""
        self._draw(frame, self._graph.placed(frame.pose))

    @property
    def has_moved(self) -> bool:
        """Whether submaps are placed elsewhere than they are drawn."""
        return bool(self._moved())

    def occupancy(self) -> OccupancyMap:
        """Return the map as the graph has it now; raises ValueError before the first keyframe."""
        if self._have_mirrors_changed():
            self.redraw()
        self._redraw_moved()
        return self._counts.occupancy(
            self._config.occupied_share, self._config.occupied_beams, self._config.least_floor
        )

    def redraw(self) -> None:
        """Draw all keyframes into new occupancy counts, where the graph places them now."""
        self._counts = OccupancyCounts(self._config.resolution, self.phase)
        self._drawn_mirrors = self._mirrors.ends
        for frame, pose in self._graph.keyframes():
            self._draw(frame, pose)
        self._drawn = self._graph.poses.copy()

    def _draw(self, frame: Keyframe, pose: Floats) -> None:
        points, ways = self._cut(frame, pose)
        self._counts.draw(points, self._mount, pose, ways)

    def _erase(self, frame: Keyframe, pose: Floats) -> None:
        points, ways = self._cut(frame, pose)
        self._counts.erase(points, self._mount, pose, ways)

    def _cut(self, frame: Keyframe, pose: Floats) -> tuple[Floats32, Floats32]:
        """Return the points of a keyframe and its open ways, with nothing behind mirrors."""
        return cut_at(self._drawn_mirrors, pose, self._mount, frame.points, frame.open)

    def _have_mirrors_changed(self) -> bool:
        """Whether the mirrors differ from those that are drawn, in number or place."""
        now, drawn = self._mirrors.ends, self._drawn_mirrors
        if now.shape != drawn.shape:
            return True
        return bool((np.abs(now - drawn) > self._config.redrawn_shift).any())

    def _moved(self) -> list[int]:
        """Return the numbers of the submaps that are placed elsewhere than they are drawn."""
        shift = np.abs(relative_to(self._drawn, self._graph.poses))
        far = shift[:, :2].max(axis=1) > self._config.redrawn_shift
        numbers: list[int] = np.flatnonzero(far | (shift[:, 2] > _REDRAWN_TURN)).tolist()
        return numbers

    def _redraw_moved(self) -> None:
        """Draw the keyframes of submaps that moved where the graph places them now.

        This is done only when the map is asked for: on a long drive most submaps move repeatedly.
        """
        for number in self._moved():
            submap, pose = self._graph.submaps[number], self._graph.poses[number]
            before, after = submap.poses(self._drawn[number]), submap.poses(pose)
            for frame, there, here in zip(submap.keyframes, before, after, strict=True):
                self._erase(frame, there)
                self._draw(frame, here)
            self._drawn[number] = pose
