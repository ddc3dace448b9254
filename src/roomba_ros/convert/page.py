"""What a page shows of the robot, from its messages."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Point as PointMessage
from geometry_msgs.msg import Polygon
from nav_msgs.msg import OccupancyGrid, Path
from numpy.typing import NDArray
from roomba_robot.msg import Room, RoomArray, ZoneArray
from roomba_robot.msg import Zone as ZoneMessage

from roomba.client.view import MOST_PATH, Point, RoomView, ZoneView, known_cells
from roomba.grid import OccupancyMap
from roomba_ros.convert.common import map_of, path_of
from roomba_ros.convert.errors import MessageError, require_finite
from roomba_ros.convert.mission import KINDS, zones_of


def known_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return a map whose values are 0 unknown, 1 free, 2 occupied."""
    known = map_of(message)
    return OccupancyMap(known.frame, known_cells(known).astype(np.int8))


def covered_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return what is clean as visits, 0 or 1: a cell counts from one half on."""
    share = map_of(message)
    return OccupancyMap(share.frame, (share.values >= 50).astype(np.int8))


def dirt_cells_of(message: OccupancyGrid) -> OccupancyMap:
    """Return how dirty the floor is: 0 not known, 1 clean to 101 the dirtiest."""
    dirt = map_of(message)
    return OccupancyMap(dirt.frame, np.clip(dirt.values + 1, 0, 101).astype(np.int8))


def shown_path_of(message: Path) -> NDArray[np.float32]:
    """Return the first points of a path, float32 [n, 2], m."""
    return path_of(message)[:MOST_PATH].astype(np.float32)


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


def zone_message_of(zone: ZoneView) -> ZoneMessage:
    """Return a zone to be set."""
    code = next(code for code, kind in KINDS.items() if kind.value == zone.kind)
    message = ZoneMessage(name=zone.name, kind=code)
    message.points = [PointMessage(x, y, 0.0) for x, y in zone.points]
    return message
