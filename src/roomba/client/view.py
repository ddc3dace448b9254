"""What a page may show of a robot and its home: immutable snapshots, in the map frame, SI units."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.client.protocol import (
    CleanReport,
    ExploreReport,
    RequestRefusedError,
    VacuumSnapshot,
)
from roomba.geometry import Point, Twist
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.vocabulary import (
    LONGEST_NAME,
    MOST_CORNERS,
    MOST_PASSES,
    MOST_ZONES,
    CarpetWay,
    CleanMode,
    EdgeOrder,
    FanLevel,
)

MOST_PATH: Final = 400
"""Points of the path that are shown."""
NO_POINTS: Final[NDArray[np.float32]] = np.empty((0, 2), np.float32)
"""In place of a scan, or of a path, where there is none."""


class LayerName(Enum):
    """A grid that can be drawn over the floor."""

    MAP = "map"
    """What the robot knows: 0 unknown, 1 free, 2 occupied, 3 occupied by furniture."""
    COVERAGE = "coverage"
    """How often the present errand, or the last one, swept a cell: 0, 1, 2, 3 or more."""
    DIRT = "dirt"
    """How dirty the robot found the floor: 0 not known, 1 clean, up to 255 the dirtiest."""
    TRUE_DIRT = "true dirt"
    """How dirty the floor of a simulated home really is: 0 clean, up to 255 the dirtiest."""


@dataclass(frozen=True, slots=True, eq=False)
class GridLayer:
    """Cells of a layer, uint8 [rows, columns]; row 0 is the lowest y, column 0 the lowest x.

    ``resolution`` is the side of a cell, m, and the origin the lower left corner, m. ``shape``
    grows by one whenever the grid lies elsewhere than before, so that tiles of before are void.
    """

    shape: int
    resolution: float
    origin_x: float
    origin_y: float
    cells: NDArray[np.uint8]

    @staticmethod
    def over(frame: GridFrame, cells: NDArray[np.uint8], shape: int) -> GridLayer:
        """Return a layer of cells that lie as ``frame`` says."""
        return GridLayer(shape, frame.resolution, frame.origin_x, frame.origin_y, cells)


@dataclass(frozen=True, slots=True)
class RoomView:
    """A room: its free floor in m2, a point well inside, and its outline as closed rings.

    ``floor`` is wood, tile, stone or fabric; empty if that is not known.
    """

    name: str
    area: float
    anchor: Point
    rings: tuple[tuple[Point, ...], ...]
    floor: str = ""


@dataclass(frozen=True, slots=True)
class ZoneView:
    """A zone that the robot must not enter: the corners of a ``no-go`` area, or of a ``wall``."""

    name: str
    kind: str
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class ChangeView:
    """A thing that ``appeared`` in the home, or is gone: its middle, length along x and width, m,
    and area, m2."""

    appeared: bool
    x: float
    y: float
    length: float
    width: float
    area: float


@dataclass(frozen=True, slots=True)
class LowThingView:
    """What was felt ``times`` times where neither map nor lidar shows anything.

    ``corners`` are those of the no-go zone that is offered, m.
    """

    times: int
    corners: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class HomeView:
    """What seldom changes; ``version`` grows by one when it does.

    ``station`` is x, y and heading of the docked robot. ``furniture`` are outlines of what stands
    on the floor, the lowest first, ``overhead`` of what the robot passes below, ``carpets`` of what
    lies; all three are empty where they are not known. ``felt_carpets`` are those that the robot
    felt by itself. ``radius`` is the robot's and ``tool`` the width of its brush, m. ``changes``
    are what the robot offers to change of its map, ``low_things`` where it offers a no-go zone.
    """

    version: int
    name: str
    station: tuple[float, float, float]
    rooms: tuple[RoomView, ...]
    zones: tuple[ZoneView, ...]
    furniture: tuple[tuple[Point, ...], ...]
    radius: float
    tool: float
    changes: tuple[ChangeView, ...] = ()
    overhead: tuple[tuple[Point, ...], ...] = ()
    carpets: tuple[tuple[Point, ...], ...] = ()
    low_things: tuple[LowThingView, ...] = ()
    felt_carpets: tuple[tuple[Point, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class DoorView:
    """A door that can be shut: lowest x and y, highest x and y of its opening, m."""

    name: str
    opening: tuple[float, float, float, float]
    is_shut: bool


@dataclass(frozen=True, slots=True)
class TruthView:
    """What is really so in a simulated home, and the robot does not know.

    ``pose`` is where the robot is; ``things`` are outlines of what stands about besides the map.
    """

    pose: tuple[float, float, float]
    things: tuple[tuple[Point, ...], ...]
    doors: tuple[DoorView, ...]
    is_lifted: bool


class PlayAct(Enum):
    """What can be done to a simulated home and robot, for teaching."""

    SPILL = "spill"
    """Spill a heap of dirt."""
    CHAIR = "chair"
    """Put a chair where it stands in the way."""
    CLEAR = "clear"
    """Take away what was put down."""
    DOOR = "door"
    """Shut or open a door."""
    LIFT = "lift"
    """Lift the robot, and put it down elsewhere."""
    BLOCK = "block"
    """Put a box before the station."""


@dataclass(frozen=True, slots=True, eq=False)
class RobotView:
    """The robot now; ``time`` is in s of its clock and ``pose`` is x, y and heading.

    ``doubt`` says which part of it fails, or why its place is not known well; ``speed`` is in m/s,
    ``dirt`` what it picked up since its bin was emptied, g, NaN if not known; ``held`` is why the
    emergency stop holds the drive, empty if it does not. ``scan`` is float32 [n, 2], where the
    lidar's beams met something; ``path`` float32 [n, 2], what is left of its way. ``last`` is how
    the last errand ended. ``battery_seconds`` is when the battery is empty at the present current,
    or full while it charges, s, and ``top_speed`` how fast it may drive, m/s; NaN if not known.
    ``charges`` says that its battery fills. ``truth`` is there for a simulated robot. ``bag`` is
    how full the bag of its station is, 0..1; NaN of one that does not empty the bin.
    """

    time: float
    pose: tuple[float, float, float]
    doubt: str
    speed: float
    dirt: float
    held: str
    vacuum: VacuumSnapshot
    scan: NDArray[np.float32]
    path: NDArray[np.float32]
    last: CleanReport | None
    battery_seconds: float = math.nan
    top_speed: float = math.nan
    truth: TruthView | None = None
    charges: bool = False
    bag: float = math.nan


@dataclass(frozen=True, slots=True)
class PageLimits:
    """What may be asked for, so that no interface hard-codes it: m, m/s, rad/s, numbers.

    ``hand_speed`` and ``hand_turning`` are those at which a hand drives; ``camera_angles`` are in
    degrees to the left, and ``play`` has the values of :class:`PlayAct` that the robot offers.
    ``each_room`` says that each room of a clean can have passes and a fan level of its own,
    ``explores`` that it makes its map itself, and ``drives`` that it can be driven by hand.
    """

    max_speed: float
    max_angular_speed: float
    most_passes: int = MOST_PASSES
    most_zones: int = MOST_ZONES
    most_corners: int = MOST_CORNERS
    longest_name: int = LONGEST_NAME
    min_speed: float = 0.1
    hand_speed: float = 0.25
    hand_turning: float = 1.0
    each_room: bool = True
    explores: bool = True
    drives: bool = True
    modes: tuple[str, ...] = tuple(mode.value for mode in CleanMode)
    fans: tuple[str, ...] = tuple(level.value for level in FanLevel)
    carpets: tuple[str, ...] = tuple(way.value for way in CarpetWay)
    edges: tuple[str, ...] = tuple(order.value for order in EdgeOrder)
    camera_angles: tuple[float, ...] = ()
    play: tuple[str, ...] = ()

    def clamped(self, linear: float, angular: float) -> Twist:
        """Return the twist of a drive by hand, m/s and rad/s, within what the robot can drive."""
        return Twist(
            min(max(linear, -self.max_speed), self.max_speed),
            min(max(angular, -self.max_angular_speed), self.max_angular_speed),
        )

    def require_speed(self, speed: float) -> None:
        """Raise RequestRefusedError for a top speed, m/s, that cannot be set."""
        if not self.min_speed <= speed <= self.max_speed:
            raise RequestRefusedError(
                f"expected a speed from {self.min_speed:g} to {self.max_speed:g} m/s, got {speed:g}"
            )


def known_cells(occupancy: OccupancyMap) -> NDArray[np.uint8]:
    """Return the cells of :attr:`LayerName.MAP`."""
    cells = np.zeros(occupancy.frame.shape, np.uint8)
    cells[occupancy.values == FREE] = 1
    cells[occupancy.values >= OCCUPIED] = 2
    return cells


def battery_seconds(level: float, rate: float) -> float:
    """Return when a battery is empty, or full while it charges, s; NaN while neither comes.

    ``level`` is 0..1, ``rate`` how it changes, 1/s.
    """
    if rate < 0.0:
        return level / -rate
    return (1.0 - level) / rate if rate > 0.0 and level < 1.0 else math.nan


def battery_fills(level: float, *, is_docked: bool) -> bool:
    """Return whether current comes into a battery of a level, 0..1: on the station, until full."""
    return is_docked and level < 1.0


def camera_angles(max_pan: float) -> tuple[float, ...]:
    """Return the five angles at which a camera looks, degrees, from the left to the right."""
    return max_pan, 0.5 * max_pan, 0.0, -0.5 * max_pan, -max_pan


def exploration_as_clean(report: ExploreReport) -> CleanReport:
    """Return the end of an exploration in the words of a clean: nothing was wanted or covered."""
    return CleanReport(
        report.outcome,
        report.message,
        covered=0.0,
        wanted=0.0,
        dirt=0.0,
        distance=report.distance,
        duration=report.duration,
        energy=math.nan,
        open_edges=report.open_edges,
        mapped=report.known,
    )


def require_another_zone(name: str, names: Collection[str]) -> None:
    """Raise RequestRefusedError when a zone of this name would be one too many."""
    if len(names) >= MOST_ZONES and name not in names:
        raise RequestRefusedError(f"expected at most {MOST_ZONES} zones; remove one first")
