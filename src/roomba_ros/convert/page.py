"""What a page shows of the robot, from its messages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Point as PointMessage
from geometry_msgs.msg import Polygon
from nav_msgs.msg import OccupancyGrid, Path
from numpy.typing import NDArray
from roomba_robot.msg import (
    CarpetArray,
    CleanActionResult,
    Door,
    ExploreActionResult,
    LowThingArray,
    MapUpdate,
    Room,
    RoomArray,
    SimHome,
    ZoneArray,
)
from roomba_robot.msg import Zone as ZoneMessage
from sensor_msgs.msg import BatteryState

from roomba.client.protocol import CleanReport
from roomba.client.view import (
    MOST_PATH,
    ChangeView,
    DoorView,
    LowThingView,
    RoomView,
    ZoneView,
    battery_seconds,
    exploration_as_clean,
    known_cells,
)
from roomba.geometry import Point
from roomba.grid import GridFrame, OccupancyMap
from roomba_ros.convert.client import clean_end_of, exploration_end_of, outcome_of
from roomba_ros.convert.common import map_of, path_of
from roomba_ros.convert.errors import MessageError, require_finite
from roomba_ros.convert.rooms import KINDS, zones_of

_LEAST_CORNERS = 3
"""Of an outline that encloses something."""


def known_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return a map whose values are 0 unknown, 1 free, 2 occupied."""
    known = map_of(message)
    return OccupancyMap(known.frame, known_cells(known).astype(np.int8))


def covered_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return the cleaned cells as visits, 0 or 1: a cell counts from half of it on."""
    share = map_of(message)
    return OccupancyMap(share.frame, (share.values >= 50).astype(np.int8))


def dirt_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return how dirty the floor is: 0 not known, 1 clean to 101 the dirtiest."""
    dirt = map_of(message)
    return OccupancyMap(dirt.frame, np.clip(dirt.values + 1, 0, 101).astype(np.int8))


def battery_seconds_of(message: BatteryState) -> float:
    """Return when the battery is empty, or full while it charges, s; NaN if that is not known."""
    level, current, capacity = message.percentage, message.current, message.capacity
    if not (0.0 <= level <= 1.0 and math.isfinite(current) and 0.0 < capacity < math.inf):
        return math.nan
    return battery_seconds(level, current / (3600.0 * capacity))


def charges_of(message: BatteryState) -> bool:
    """Return whether the battery charges; some drivers tell the status and no current."""
    is_charging = message.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    return bool(is_charging or message.current > 0.0)


def shown_path_of(message: Path) -> NDArray[np.float32]:
    """Return the first points of a path, float32 [n, 2], m."""
    path = path_of(message)[:MOST_PATH]
    with np.errstate(over="ignore"):
        shown = path.astype(np.float32)
    if not np.isfinite(shown).all():
        raise MessageError(f"expected a path in a home, got a point {np.abs(path).max():g} m off")
    return shown


def room_views_of(message: RoomArray) -> tuple[RoomView, ...]:
    """Return the rooms of a map."""
    return tuple(_room_view(room) for room in message.rooms)


def _room_view(room: Room) -> RoomView:
    require_finite("a room's area and anchor", room.area, room.anchor.x, room.anchor.y)
    rings = tuple(_ring(ring) for ring in (room.outline, *room.holes))
    return RoomView(room.name, room.area, (room.anchor.x, room.anchor.y), rings)


def _ring(polygon: Polygon) -> tuple[Point, ...]:
    points = [(float(point.x), float(point.y)) for point in polygon.points]
    if len(points) < 3:
        raise MessageError(f"expected an outline of 3 corners or more, got {len(points)}")
    require_finite("an outline's corners", *(value for point in points for value in point))
    return (*points, points[0])


def zone_views_of(message: ZoneArray) -> tuple[ZoneView, ...]:
    """Return the zones where the robot must not go."""
    zones = zones_of(message).all
    return tuple(ZoneView(zone.name, zone.kind.value, zone.points) for zone in zones)


def clean_report_of(message: CleanActionResult) -> CleanReport | None:
    """Return how a clean ended; None for a goal that was refused."""
    result = message.result
    if message.status.status == GoalStatus.REJECTED:
        return None
    # Only the goal's status says which program ended a clean.
    return clean_end_of(result, outcome_of(result.outcome), _reason_of(message))


def exploration_report_of(message: ExploreActionResult) -> CleanReport | None:
    """Return how an exploration ended; None for a goal that was refused."""
    result = message.result
    if message.status.status == GoalStatus.REJECTED:
        return None
    report = exploration_end_of(result, outcome_of(result.outcome), _reason_of(message))
    return exploration_as_clean(report)


def _reason_of(message: CleanActionResult | ExploreActionResult) -> str:
    """Return what the goal's status says of an errand that did not succeed."""
    status = message.status
    return "" if status.status == GoalStatus.SUCCEEDED else str(status.text)


def changes_of(message: MapUpdate) -> tuple[ChangeView, ...]:
    """Return what the robot offers to change of its map."""
    for change in message.changes:
        middle, size = change.middle, (change.length, change.width, change.area)
        require_finite("a change of the map", middle.x, middle.y, *size)
    return tuple(
        ChangeView(
            change.appeared,
            change.middle.x,
            change.middle.y,
            change.length,
            change.width,
            change.area,
        )
        for change in message.changes
    )


def low_things_of(message: LowThingArray) -> tuple[LowThingView, ...]:
    """Return the no-go zones that the robot offers."""
    return tuple(
        LowThingView(thing.times, _enclosed(thing.corners, "a zone that is offered"))
        for thing in message.things
    )


def carpets_of(message: CarpetArray) -> tuple[tuple[Point, ...], ...]:
    """Return the outlines of the carpets that the robot felt."""
    return tuple(_enclosed(carpet.corners, "a carpet") for carpet in message.carpets)


def _enclosed(corners: Sequence[PointMessage], what: str) -> tuple[Point, ...]:
    if len(corners) < _LEAST_CORNERS:
        raise MessageError(
            f"expected {_LEAST_CORNERS} corners or more of {what}, got {len(corners)}"
        )
    require_finite(what, *(value for corner in corners for value in (corner.x, corner.y)))
    return tuple((corner.x, corner.y) for corner in corners)


def zone_message_of(zone: ZoneView) -> ZoneMessage:
    """Return a zone to be set."""
    code = next(code for code, kind in KINDS.items() if kind.value == zone.kind)
    message = ZoneMessage(name=zone.name, kind=code)
    message.points = [PointMessage(x, y, 0.0) for x, y in zone.points]
    return message


class ToldHome(NamedTuple):
    """Outlines of what stands about besides the map, the doors, and whether the robot is lifted."""

    things: tuple[tuple[Point, ...], ...]
    doors: tuple[DoorView, ...]
    is_lifted: bool


def sim_home_of(message: SimHome) -> ToldHome:
    """Return how a home really is; raises MessageError."""
    return ToldHome(
        tuple(_outline(thing) for thing in message.things),
        tuple(_door(door) for door in message.doors),
        bool(message.lifted),
    )


def _outline(polygon: Polygon) -> tuple[Point, ...]:
    points = tuple((float(point.x), float(point.y)) for point in polygon.points)
    if len(points) < 3:
        raise MessageError(f"expected an outline of 3 corners or more, got {len(points)}")
    require_finite("an outline's corners", *(value for point in points for value in point))
    return points


def _door(message: Door) -> DoorView:
    place = message.opening
    opening = (place.min_x, place.min_y, place.max_x, place.max_y)
    require_finite("a door's opening", *opening)
    return DoorView(message.name, opening, bool(message.shut))


def sim_dirt_of(message: OccupancyGrid) -> tuple[GridFrame, NDArray[np.uint8]]:
    """Return where dirt lies, and uint8 [rows, columns]: 0 clean to 255 the dirtiest."""
    dirt = map_of(message)
    share = np.clip(dirt.values, 0, 100).astype(np.float64) / 100.0
    return dirt.frame, np.rint(255.0 * share).astype(np.uint8)
