"""Zones that the robot must not enter: no-go areas and virtual walls."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.grid import OCCUPIED, GridFrame, OccupancyMap

WALL_WIDTH: Final = 0.05
"""m; of a virtual wall: as thick as a cell, so that nothing slips through."""
_LEAST_SHARE: Final = 1e-6
"""Of a cell; less is rounding."""
_LEAST_AREA: Final = 0.01
"""m2; a smaller area is a slip of the finger."""

Corners = tuple[tuple[float, float], ...]


class ZonesError(RoombaError):
    """An invalid zone, or a file of zones that cannot be read."""


class ZoneKind(Enum):
    """What a zone means."""

    NO_GO = "no-go"
    """An area, given by its corners."""
    WALL = "wall"
    """A virtual wall along a line of points."""


@dataclass(frozen=True, slots=True)
class Zone:
    """``points`` are the corners of an area, or those of a wall, m, map frame."""

    name: str
    kind: ZoneKind
    points: Corners

    def __post_init__(self) -> None:
        """Check the number of points, and that an area encloses floor. Raises ZonesError."""
        least = 3 if self.kind is ZoneKind.NO_GO else 2
        if not self.name.strip():
            raise ZonesError(f"expected a zone's name, got {self.name!r}; name every zone")
        if not all(math.isfinite(value) for point in self.points for value in point):
            raise ZonesError(f"zone {self.name!r}: expected finite numbers, m, got {self.points}")
        if len(self.points) < least:
            raise ZonesError(
                f"zone {self.name!r}: expected {least} points or more, got {len(self.points)}"
            )
        shape = self._outline
        if not shape.is_valid:
            reason = shapely.is_valid_reason(shape)
            raise ZonesError(f"zone {self.name!r}: expected a simple outline, got {reason}")
        if self.kind is ZoneKind.NO_GO and shape.area < _LEAST_AREA:
            raise ZonesError(
                f"zone {self.name!r}: expected {_LEAST_AREA} m2 or more, got {shape.area:.4f} m2"
            )

    @property
    def _outline(self) -> shapely.Geometry:
        if self.kind is ZoneKind.NO_GO:
            return shapely.Polygon(self.points)
        return shapely.LineString(self.points)

    def cells(self, frame: GridFrame) -> NDArray[np.bool_]:
        """Return the cells that it touches, bool [rows, columns]."""
        shape = self._outline
        if self.kind is ZoneKind.WALL:
            shape = shape.buffer(0.5 * WALL_WIDTH, cap_style="square")
        touched = np.zeros(frame.shape, np.bool_)
        x_min, y_min, x_max, y_max = shape.bounds
        low_row, low_column = frame.cell_of(x_min, y_min)
        high_row, high_column = frame.cell_of(x_max, y_max)
        rows = np.arange(max(low_row, 0), min(high_row + 1, frame.rows))
        columns = np.arange(max(low_column, 0), min(high_column + 1, frame.columns))
        if rows.size == 0 or columns.size == 0:
            return touched
        left = frame.origin_x + columns[None, :] * frame.resolution
        bottom = frame.origin_y + rows[:, None] * frame.resolution
        squares = shapely.box(left, bottom, left + frame.resolution, bottom + frame.resolution)
        shapely.prepare(shape)
        # What shares a border with a zone and nothing else is not touched.
        common = shapely.area(shapely.intersection(squares, shape))
        touched[np.ix_(rows, columns)] = common > _LEAST_SHARE * frame.resolution**2
        return touched


@dataclass(frozen=True, slots=True)
class Zones:
    """All zones of a map; an edit returns new ones."""

    all: tuple[Zone, ...] = ()

    def with_zone(self, zone: Zone) -> Zones:
        """Return these with a zone more, in place of one of the same name."""
        return Zones((*(other for other in self.all if other.name != zone.name), zone))

    def without(self, name: str) -> Zones:
        """Return these without a zone; raises ZonesError for a name that is none."""
        if name not in self.names:
            known = ", ".join(self.names) or "none"
            raise ZonesError(f"expected the name of a zone, got {name!r}; there are: {known}")
        return replace(self, all=tuple(zone for zone in self.all if zone.name != name))

    @property
    def names(self) -> tuple[str, ...]:
        """Of all zones."""
        return tuple(zone.name for zone in self.all)

    def kept_out(self, occupancy: OccupancyMap) -> OccupancyMap:
        """Return a map to plan on: what zones cover is occupied. The map itself stays as it is."""
        if not self.all:
            return occupancy
        values = occupancy.values.copy()
        for zone in self.all:
            values[zone.cells(occupancy.frame)] = OCCUPIED
        return OccupancyMap(occupancy.frame, values)
