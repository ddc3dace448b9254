"""The state of a map, and offered changes, as ROS messages."""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import Point
from roomba_robot.msg import MapChange, Mapping, MapUpdate

from roomba.perception.floors.map_changes import Change, ChangeKind
from roomba_ros.convert.common import header
from roomba_ros.convert.errors import require_finite


def is_growing_of(message: Mapping) -> bool:
    """Return whether the map is being made; raises MessageError for an area that is not finite."""
    require_finite("an area", message.known)
    return bool(message.is_growing)


def update_message(now: float, changes: Iterable[Change], frame_id: str) -> MapUpdate:
    """Return what of a map would be changed as a message."""
    return MapUpdate(
        header(now, frame_id),
        [
            MapChange(
                change.kind is ChangeKind.APPEARED,
                Point(change.x, change.y, 0.0),
                change.width,
                change.height,
                change.area,
            )
            for change in changes
        ],
    )
