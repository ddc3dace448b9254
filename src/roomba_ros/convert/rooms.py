"""Rooms, zones, and what was felt on the floor, as messages, and zones and rooms as values."""

from __future__ import annotations

import colorsys
import itertools
from collections.abc import Sequence

import shapely
from geometry_msgs.msg import Point, Point32, Polygon, Vector3
from roomba_robot.msg import (
    Carpet,
    CarpetArray,
    LowThing,
    LowThingArray,
    Room,
    RoomArray,
    ZoneArray,
)
from roomba_robot.msg import Zone as ZoneMessage
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import OfferedZone
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import WALL_WIDTH, Zone, ZoneKind, Zones, ZonesError
from roomba_ros.convert.common import header, quaternion_of
from roomba_ros.convert.errors import MessageError, require_finite
from roomba_ros.convert.values import code_of

KINDS = {getattr(ZoneMessage, kind.name): kind for kind in ZoneKind}

_GOLDEN = 0.618034
"""Of the circle of colours: neighbours in number are far apart on it."""
_LINE = 0.04
_LETTERS = 0.35
"""m; width of outlines and height of names in RViz."""

_LEAST_CORNERS = 3
"""Of an outline that encloses something."""
_BARRED, _CARPET = (0.9, 0.1, 0.1, 0.9), (0.5, 0.45, 0.4, 0.9)
"""Red, green, blue and opacity of zones."""
_OUTLINE = 0.03
"""m; width of lines around zones."""

RoomOutlines = tuple[tuple[str, shapely.Polygon], ...]
"""Names and outlines, m, of rooms."""


def rooms_message(now: float, rooms: Rooms, frame_id: str) -> RoomArray:
    """Return the rooms with their outlines."""
    return RoomArray(
        header(now, frame_id),
        [_room_message(rooms, label) for label in range(1, len(rooms.names) + 1)],
    )


def rooms_markers(now: float, rooms: Rooms, frame_id: str) -> MarkerArray:
    """Return outlines and names to be drawn by RViz; what was drawn before is taken away."""
    markers = [Marker(header=header(now, frame_id), action=Marker.DELETEALL)]
    for label, name in enumerate(rooms.names, 1):
        red, green, blue = colorsys.hsv_to_rgb(_GOLDEN * label % 1.0, 0.65, 0.9)
        colour = ColorRGBA(red, green, blue, 1.0)
        lines = _marker(now, frame_id, "outlines", label, Marker.LINE_LIST, colour)
        lines.scale = Vector3(_LINE, 0.0, 0.0)
        lines.points = _lines(rooms.outline(label))
        text = _marker(now, frame_id, "names", label, Marker.TEXT_VIEW_FACING, colour)
        text.scale = Vector3(0.0, 0.0, _LETTERS)
        text.pose.position.x, text.pose.position.y = rooms.anchor(label)
        text.pose.position.z = _LETTERS
        text.text = f"{name}\n{rooms.area(label):.1f} m²"
        markers += [lines, text]
    return MarkerArray(markers)


def outlines_of(message: RoomArray) -> RoomOutlines:
    """Return the names and outlines of rooms, m; raises MessageError for a broken outline."""
    return tuple((room.name, _outline_of(room)) for room in message.rooms)


def zone_of(message: ZoneMessage) -> Zone:
    """Return a zone; raises ZonesError for an invalid one."""
    if message.kind not in KINDS:
        raise ZonesError(
            f"zone {message.name!r}: expected a kind from 0 to {len(KINDS) - 1}, got {message.kind}"
        )
    points = tuple((point.x, point.y) for point in message.points)
    return Zone(message.name, KINDS[message.kind], points)


def zones_of(message: ZoneArray) -> Zones:
    """Return all zones; raises MessageError when one of them is invalid."""
    try:
        return Zones(tuple(zone_of(zone) for zone in message.zones))
    except ZonesError as error:
        raise MessageError(str(error)) from error


def zones_message(now: float, zones: Zones, frame_id: str) -> ZoneArray:
    """Return all zones as a message."""
    return ZoneArray(
        header(now, frame_id),
        [
            ZoneMessage(
                zone.name,
                code_of(KINDS, zone.kind),
                [Point(x, y, 0.0) for x, y in zone.points],
            )
            for zone in zones.all
        ],
    )


def zones_markers(now: float, zones: Zones, frame_id: str) -> MarkerArray:
    """Return zones to be drawn by RViz; what was drawn before is taken away."""
    markers = [Marker(header=header(now, frame_id), action=Marker.DELETEALL)]
    for number, zone in enumerate(zones.all):
        is_area = zone.kind.is_area
        marker = Marker(header=header(now, frame_id), ns="zones", id=number, type=Marker.LINE_STRIP)
        marker.pose.orientation = quaternion_of(0.0)
        is_carpet = zone.kind is ZoneKind.CARPET
        marker.color = ColorRGBA(*(_CARPET if is_carpet else _BARRED))
        marker.scale = Vector3(_OUTLINE if is_area else WALL_WIDTH, 0.0, 0.0)
        closed = (*zone.points, zone.points[0]) if is_area else zone.points
        marker.points = [Point(x, y, 0.02) for x, y in closed]
        markers.append(marker)
    return MarkerArray(markers)


def low_things_message(now: float, offers: Sequence[OfferedZone], frame_id: str) -> LowThingArray:
    """Return the no-go zones that are offered as a message."""
    return LowThingArray(
        header(now, frame_id),
        [LowThing(offer.times, [Point(x, y, 0.0) for x, y in offer.corners]) for offer in offers],
    )


def carpets_message(now: float, carpets: FeltCarpets, frame_id: str) -> CarpetArray:
    """Return the carpets that were felt as a message."""
    return CarpetArray(
        header(now, frame_id),
        [Carpet([Point(x, y, 0.0) for x, y in corners]) for corners in carpets.all],
    )


def _room_message(rooms: Rooms, label: int) -> Room:
    x, y = rooms.anchor(label)
    outer, holes = _rings(rooms.outline(label))[0]
    return Room(
        name=rooms.names[label - 1],
        area=rooms.area(label),
        anchor=Point(x, y, 0.0),
        outline=_polygon(outer),
        holes=[_polygon(hole) for hole in holes],
    )


def _marker(
    now: float, frame_id: str, kind: str, number: int, shape: int, colour: ColorRGBA
) -> Marker:
    marker = Marker(header=header(now, frame_id), ns=kind, id=number, type=shape, color=colour)
    marker.pose.orientation = quaternion_of(0.0)
    return marker


def _rings(
    outline: shapely.Polygon | shapely.MultiPolygon,
) -> list[tuple[shapely.LinearRing, list[shapely.LinearRing]]]:
    """Return outer ring and holes of each piece, the largest first; rings counter-clockwise."""
    pieces = sorted(getattr(outline, "geoms", [outline]), key=lambda piece: -piece.area)
    turned = [shapely.geometry.polygon.orient(piece) for piece in pieces]
    return [(piece.exterior, list(piece.interiors)) for piece in turned]


def _polygon(ring: shapely.LinearRing) -> Polygon:
    return Polygon([Point32(x, y, 0.0) for x, y in list(ring.coords)[:-1]])


def _lines(outline: shapely.Polygon | shapely.MultiPolygon) -> list[Point]:
    """Return both ends of each side, as a marker of lines wants them."""
    points = []
    for outer, holes in _rings(outline):
        for ring in (outer, *holes):
            corners = [Point(x, y, 0.02) for x, y in ring.coords]
            for start, end in itertools.pairwise(corners):
                points += [start, end]
    return points


def _outline_of(room: Room) -> shapely.Polygon:
    polygons = (room.outline, *room.holes)
    rings = [[(point.x, point.y) for point in polygon.points] for polygon in polygons]
    for ring in rings:
        numbers = (number for point in ring for number in point)
        require_finite(f"an outline of the room {room.name!r}", *numbers)
        if len(ring) < _LEAST_CORNERS:
            raise MessageError(
                f"expected {_LEAST_CORNERS} corners or more of the room {room.name!r}, "
                f"got {len(ring)}"
            )
    return shapely.Polygon(rings[0], rings[1:])
