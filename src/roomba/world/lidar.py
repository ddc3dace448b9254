"""The lidar alone: exact scans of a home's walls and furniture from any poses.

It sees through glass, and measures a mirror like a wall; only :class:`.simulator.Simulator`
follows a beam by way of a mirror.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry
from roomba.configuration.sensors import LidarConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.engine.layout import faces_of, joined_edges, seen_by_lidar
from roomba.world.engine.lidar.edges import LidarEdges, lidar_edges
from roomba.world.engine.lidar.projection import (
    ScanBuffers,
    begin_scan,
    buffers_for,
    end_scan,
    scan_walls,
)
from roomba.world.engine.lidar.scan_kernels import scan_faces
from roomba.world.engine.state.arrays import FACE, HOME, Edges, Rows
from roomba.world.home.home import Home
from roomba.world.home.surface import Finish


@dataclass(frozen=True, slots=True, eq=False)
class Lidar:
    """Scans a home in which nothing moves; make it with :meth:`of`. Not for two threads at once."""

    config: LidarConfig
    frame: GridFrame
    edges: LidarEdges
    _home: Rows
    _faces: Rows
    _arrays: Edges
    _buffers: ScanBuffers
    _axes: Pose | None = None
    """Where the grid lies in the frame of the poses, if it is turned there."""

    @staticmethod
    def of(home: Home, config: LidarConfig | None = None) -> Lidar:
        """Return the lidar of a home."""
        exact = home.exact
        lidar = Lidar.on_grid(seen_by_lidar(exact), exact.frame, config)
        faces = faces_of(exact)
        lidar = replace(lidar, _faces=faces[~np.isin(faces["finish"], (Finish.GLASS, Finish.LOW))])
        lidar._home["clear_at"] = len(lidar._faces)
        return lidar if home.turned is None else replace(lidar, _axes=home.axes)

    @staticmethod
    def on_grid(
        solid: NDArray[np.bool_],
        frame: GridFrame,
        config: LidarConfig | None = None,
        tile: float | None = None,
    ) -> Lidar:
        """Return the lidar of a grid, bool [rows, columns]; ``tile`` as in ``lidar_edges``."""
        config = config or LidarConfig()
        edges = lidar_edges(solid, frame.resolution, tile)
        home = np.zeros(1, HOME)
        home["resolution"] = frame.resolution
        home["rows"], home["columns"] = frame.shape
        home["tile_columns"] = edges.tile_columns
        home["tile_size"] = edges.tile_cells * frame.resolution
        arrays = joined_edges([edges])
        buffers, faces = buffers_for(arrays, config.beams), np.zeros(0, FACE)
        return Lidar(config, frame, edges, home, faces, arrays, buffers)

    def scan(
        self, poses: NDArray[np.float64], out: NDArray[np.float32] | None = None
    ) -> NDArray[np.float32]:
        """Return exact ranges, float32 [poses, beams], m: beam 0 ahead, counter-clockwise.

        ``poses`` is float64 [poses, 3]: x, y (m), theta (rad), map frame. A beam that meets
        nothing within reach is inf, one that meets something nearer than the least range -inf.
        ``out``, if given, is filled and returned. Raises ValueError for poses that are not on the
        grid, or arrays of another shape.
        """
        poses = np.ascontiguousarray(poses, np.float64)
        if poses.ndim != 2 or poses.shape[1] != 3:
            raise ValueError(f"expected poses of shape [poses, 3], got {poses.shape}")
        if self._axes is not None:
            poses = self._axes.inverse().transform(poses)
            poses[:, 2] -= self._axes.theta
        x_min, x_max, y_min, y_max = self.frame.extent
        x, y = poses[:, 0], poses[:, 1]
        inside = (x >= x_min) & (x < x_max) & (y >= y_min) & (y < y_max)
        if not np.all(inside & np.isfinite(poses[:, 2])):
            wrong = poses[int(np.argmin(inside & np.isfinite(poses[:, 2])))].tolist()
            raise ValueError(
                f"expected poses on the grid (x {x_min:g} to {x_max:g}, y {y_min:g} to "
                f"{y_max:g}), got {wrong}"
            )
        shape = (len(poses), self.config.beams)
        if out is None:
            out = np.empty(shape, np.float32)
        elif out.shape != shape or out.dtype != np.float32:
            raise ValueError(f"expected out to be float32 {shape}, got {out.dtype} {out.shape}")
        _scan_all(
            self._buffers,
            self._arrays,
            self._home,
            self._faces,
            poses,
            self.frame.origin_x,
            self.frame.origin_y,
            self.config.min_range,
            self.config.max_range,
            out,
        )
        return out


@entry
def _scan_all(
    buffers: ScanBuffers,
    edges: Edges,
    homes: Rows,
    faces: Rows,
    poses: NDArray[np.float64],
    origin_x: float,
    origin_y: float,
    min_range: float,
    max_range: float,
    ranges: NDArray[np.float32],
) -> None:
    for row in range(len(poses)):
        x = np.float32(poses[row, 0] - origin_x)
        y = np.float32(poses[row, 1] - origin_y)
        theta = begin_scan(buffers.rays, buffers.fan, poses[row, 2], max_range)
        scan_walls(buffers, edges, homes[0], x, y, theta)
        beams = ranges.shape[1]
        scan_faces(faces, homes[0], poses[row, 0], poses[row, 1], buffers.fan, beams, theta)
        end_scan(buffers.fan, ranges, row, min_range, max_range)
