"""Zones of a map: no-go areas and virtual walls, which the robot must not enter, and carpets."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.geometry import FARTHEST
from roomba.grid import OCCUPIED, GridFrame, OccupancyMap
from roomba.vocabulary import LONGEST_NAME, MOST_CORNERS, MOST_ZONES, fault_of_name, listed

WALL_WIDTH: Final = 0.05
"""m; width of a virtual wall: as thick as a cell, so that the robot finds no gap in it."""
_LEAST_SHARE: Final = 1e-6
"""Share of a cell that a zone must cover to touch it; less is rounding."""
LEAST_AREA: Final = 0.01
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
    CARPET = "carpet"
    """A carpet, given by its corners: it may be entered."""

    @property
    def is_area(self) -> bool:
        """Whether its points are the corners of an area."""
        return self is not ZoneKind.WALL


@dataclass(frozen=True, slots=True)
class Zone:
    """A zone; ``points`` are the corners of an area, or of a wall's line, m, map frame."""

    name: str
    kind: ZoneKind
    points: Corners

    def __post_init__(self) -> None:
        """Check the number of points, and that an area encloses floor. Raises ZonesError."""
        least = 3 if self.kind.is_area else 2
        if fault := fault_of_name(self.name):
            raise ZonesError(f"a zone: {fault}; name every zone")
        if not least <= len(self.points) <= MOST_CORNERS:
            raise ZonesError(
                f"zone {self.name!r}: expected {least} to {MOST_CORNERS} points, got "
                f"{len(self.points)}"
            )
        if not all(abs(value) <= FARTHEST for point in self.points for value in point):
            raise ZonesError(
                f"zone {self.name!r}: expected numbers of at most {FARTHEST:g} m, got {self.points}"
            )
        shape = self._outline
        if not shape.is_valid:
            reason = shapely.is_valid_reason(shape)
            raise ZonesError(f"zone {self.name!r}: expected a simple outline, got {reason}")
        if self.kind.is_area and shape.area < LEAST_AREA:
            raise ZonesError(
                f"zone {self.name!r}: expected {LEAST_AREA} m2 or more, got {shape.area:.4f} m2"
            )

    @property
    def shape(self) -> shapely.Geometry:
        """The floor that the zone covers, m: an area, or a wall with its width."""
        if self.kind.is_area:
            return self._outline
        return self._outline.buffer(0.5 * WALL_WIDTH, cap_style="square")

    @property
    def _outline(self) -> shapely.Geometry:
        if self.kind.is_area:
            return shapely.Polygon(self.points)
        return shapely.LineString(self.points)

    def cells(self, frame: GridFrame) -> NDArray[np.bool_]:
        """Return the cells that the zone touches, bool [rows, columns]."""
        touched = np.zeros(frame.shape, np.bool_)
        rows, columns, cells = _touched(self, frame)
        touched[rows, columns] = cells
        return touched


@functools.lru_cache(maxsize=MOST_ZONES)
def _touched(zone: Zone, frame: GridFrame) -> tuple[slice, slice, NDArray[np.bool_]]:
    """Return the rows and columns around a zone, and which of these cells it touches.

    Results are cached, as after an edit of one zone the cells of all are asked for.
    """
    shape = zone.shape
    x_min, y_min, x_max, y_max = shape.bounds
    low_row, low_column = frame.cell_of(x_min, y_min)
    high_row, high_column = frame.cell_of(x_max, y_max)
    rows = slice(max(low_row, 0), max(min(high_row + 1, frame.rows), 0))
    columns = slice(max(low_column, 0), max(min(high_column + 1, frame.columns), 0))
    left = frame.origin_x + np.arange(columns.start, columns.stop)[None, :] * frame.resolution
    bottom = frame.origin_y + np.arange(rows.start, rows.stop)[:, None] * frame.resolution
    squares = shapely.box(left, bottom, left + frame.resolution, bottom + frame.resolution)
    shapely.prepare(shape)
    cells = shapely.contains_properly(shape, squares)
    on_border = ~cells & shapely.intersects(shape, squares)
    # A cell that only shares a border with the zone is not touched.
    common = shapely.area(shapely.intersection(squares[on_border], shape))
    cells[on_border] = common > _LEAST_SHARE * frame.resolution**2
    cells.setflags(write=False)
    return rows, columns, cells


@dataclass(frozen=True, slots=True)
class Zones:
    """All zones of a map; an edit returns new ones."""

    all: tuple[Zone, ...] = ()

    def __post_init__(self) -> None:
        """Check how many there are. Raises ZonesError."""
        if len(self.all) > MOST_ZONES:
            raise ZonesError(
                f"expected at most {MOST_ZONES} zones, got {len(self.all)}; remove one first"
            )

    def with_zone(self, zone: Zone) -> Zones:
        """Return these zones and ``zone``, which replaces one of the same name."""
        return Zones((*(other for other in self.all if other.name != zone.name), zone))

    def without(self, name: str) -> Zones:
        """Return these without a zone; raises ZonesError if none has this name."""
        if name not in self.names:
            raise ZonesError(
                f"expected the name of a zone, got {name[:LONGEST_NAME]!r}; there are: "
                f"{listed(self.names)}"
            )
        return replace(self, all=tuple(zone for zone in self.all if zone.name != name))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all zones."""
        return tuple(zone.name for zone in self.all)

    @property
    def barred(self) -> tuple[Zone, ...]:
        """The zones that the robot must not enter."""
        return tuple(zone for zone in self.all if zone.kind is not ZoneKind.CARPET)

    def kept_out(self, occupancy: OccupancyMap) -> OccupancyMap:
        """Return a map to plan on, with barred zones occupied; the map itself is not changed."""
        if not self.barred:
            return occupancy
        values = occupancy.values.copy()
        for zone in self.barred:
            rows, columns, cells = _touched(zone, occupancy.frame)
            values[rows, columns][cells] = OCCUPIED
        return OccupancyMap(occupancy.frame, values)

    def carpets(self, frame: GridFrame) -> NDArray[np.bool_]:
        """Return the cells that carpets touch, bool [rows, columns]."""
        touched = np.zeros(frame.shape, np.bool_)
        for carpet in self._carpets:
            touched |= carpet.cells(frame)
        return touched

    def is_carpet_at(self, x: float, y: float) -> bool:
        """Whether a carpet lies at a point, m."""
        return any(shapely.intersects_xy(carpet.shape, x, y) for carpet in self._carpets)

    @property
    def has_carpets(self) -> bool:
        """Whether there are carpets among them."""
        return bool(self._carpets)

    @property
    def _carpets(self) -> tuple[Zone, ...]:
        return tuple(zone for zone in self.all if zone.kind is ZoneKind.CARPET)
