"""The signed distance field of a map's surfaces, to which scans are matched."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.matching.field_kernels import fill_near_surfaces
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import large_regions

_LARGEST_SPOT: Final = 0.25
"""m2; a larger area that is unknown may hold something."""


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceField:
    """Signed distances to the surfaces of a map, at the middles of its cells.

    ``values`` is float32 [rows, columns], m: positive on free floor, negative inside what is solid.
    Between middles the field is bilinear, so that a wall's surface lies where the wall's cells end
    and not in their middles, to a fraction of a cell (a likelihood field, Thrun, Burgard and Fox,
    "Probabilistic Robotics", 6.4, but for its sign). Slanted walls make cells solid in part: there
    the surface lies where the solid share of the cell puts it.
    """

    frame: GridFrame
    values: NDArray[np.float32]

    @staticmethod
    def of(occupancy: OccupancyMap) -> SurfaceField:
        """Return the field of a map; in a map without any surface all distances are far."""
        solid = _solid(occupancy)
        outside = distance_to_nearest(solid)
        inside = distance_to_nearest(~solid)
        cells = np.where(solid, 0.5 - inside, outside - 0.5)
        far = float(max(solid.shape))
        metres = np.clip(cells, -far, far) * occupancy.frame.resolution
        values = np.ascontiguousarray(metres, np.float32)
        _use_shares(values, occupancy)
        return SurfaceField(occupancy.frame, values)

    def raise_by(self, distance: float) -> None:
        """Move all surfaces so far, m, into what is solid."""
        self.values[:] += np.float32(distance)

    @staticmethod
    def near(occupancy: OccupancyMap, farthest: float) -> SurfaceField:
        """Return the field of a map as :meth:`of` does, but nowhere more than ``farthest``, m.

        It takes a tenth of the time. All that is unknown counts as solid.
        """
        resolution = occupancy.frame.resolution
        most = math.ceil(farthest / resolution + 0.5)
        cells = np.sqrt(np.arange(most**2 + 1)).astype(np.float32)
        metres = np.minimum((cells - 0.5) * resolution, farthest, dtype=np.float32)
        values = np.empty(occupancy.frame.shape, np.float32)
        fill_near_surfaces(occupancy.likely_solid, metres, values)
        _use_shares(values, occupancy)
        return SurfaceField(occupancy.frame, values)

    @staticmethod
    def unknown() -> SurfaceField:
        """Return the field of no map: nowhere is a surface."""
        return SurfaceField(GridFrame(1.0, 0.0, 0.0, 0, 0), np.empty((0, 0), np.float32))

    @property
    def place(self) -> NDArray[np.float64]:
        """x and y of the middle of the first cell, and the resolution, m: as kernels read it."""
        frame = self.frame
        half = 0.5 * frame.resolution
        return np.array([frame.origin_x + half, frame.origin_y + half, frame.resolution])


def _solid(occupancy: OccupancyMap) -> NDArray[np.bool_]:
    """Return which cells count as solid, bool [rows, columns].

    Unknown cells are solid, but for small spots that no beam happened to pass: cells of these are
    as the known cell nearest to them.
    """
    likely, is_known = occupancy.likely_solid, occupancy.values >= FREE
    resolution = occupancy.frame.resolution
    spots = ~is_known & ~large_regions(~is_known, resolution, _LARGEST_SPOT, by_corners=True)
    if not spots.any():
        return likely
    is_nearer = distance_to_nearest(~likely) < distance_to_nearest(likely & is_known)
    solid: NDArray[np.bool_] = likely & ~(spots & is_nearer)
    return solid


def _use_shares(values: NDArray[np.float32], occupancy: OccupancyMap) -> None:
    """Put surfaces inside of partly solid cells, as far off the middle as the solid share says.

    Only cells beside a surface are changed: elsewhere such a value means that the map is not sure.
    """
    resolution = occupancy.frame.resolution
    partly = (occupancy.values > FREE) & (occupancy.values < OCCUPIED)
    partly &= np.abs(values) <= resolution
    values[partly] = (0.5 - occupancy.values[partly] / OCCUPIED) * resolution
