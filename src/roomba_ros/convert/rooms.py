"""Rooms as ROS messages."""

from __future__ import annotations

import colorsys
import itertools

import shapely
from geometry_msgs.msg import Point, Point32, Polygon, Vector3
from roomba_robot.msg import Room, RoomArray
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from roomba.perception.rooms.rooms import Rooms
from roomba_ros.convert.common import header, quaternion_of

_GOLDEN = 0.618034
"""Of the circle of colours: neighbours in number are far apart on it."""
_LINE = 0.04
_LETTERS = 0.35
"""m; width of outlines and height of names in RViz."""


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
