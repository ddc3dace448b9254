"""The mission's commands, states and zones, as values and as ROS messages."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from enum import Enum
from typing import TypeVar

import numpy as np
import shapely
from geometry_msgs.msg import Point, Vector3
from nav_msgs.msg import OccupancyGrid
from numpy.typing import NDArray
from roomba_robot.msg import (
    Carpet,
    CarpetArray,
    CleanFeedback,
    CleanGoal,
    LineTrouble,
    LowThing,
    LowThingArray,
    MissedArea,
    Rectangle,
    Room,
    RoomArray,
    VacuumState,
    ZoneArray,
)
from roomba_robot.msg import CleanResult as CleanResultMessage
from roomba_robot.msg import ExploreResult as ExploreResultMessage
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from roomba_robot.msg import RoomDirt as RoomDirtMessage
from roomba_robot.msg import TimeSpent as TimeSpentMessage
from roomba_robot.msg import Zone as ZoneMessage
from roomba_robot.srv import ChangeRoomsRequest
from sensor_msgs.msg import BatteryState
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from roomba.clean_request import CleanRefusedError, CleanRequest, require_passes
from roomba.grid import GridFrame, OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome, CleanResult, Missed, MissReason
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.inputs.senses import Battery
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import OfferedZone
from roomba.perception.rooms.zones import WALL_WIDTH, Zone, ZoneKind, Zones, ZonesError
from roomba.perception.swept.coverage_bits import SWEPT, WANTED
from roomba.vocabulary import (
    CarpetWay,
    CleanMode,
    EdgeOrder,
    EdgeReason,
    FanLevel,
    Hindrance,
    OpenEdge,
    Reason,
    RoomWay,
)
from roomba_ros.convert.common import header, map_message, quaternion_of
from roomba_ros.convert.errors import MessageError, require_finite

MODES = {getattr(CleanGoal, mode.name): mode for mode in CleanMode}
FANS = {getattr(CleanGoal, level.name): level for level in FanLevel}
OUTCOMES = {outcome: getattr(CleanResultMessage, outcome.name) for outcome in CleanOutcome}
REASONS = {reason: getattr(MissedArea, reason.name) for reason in MissReason}
HINDRANCES = {getattr(VacuumState, hindrance.name): hindrance for hindrance in Hindrance}
EDGE_REASONS = {getattr(OpenEdgeMessage, reason.name): reason for reason in EdgeReason}
CARPETS = {getattr(CleanGoal, f"CARPETS_{way.name}"): way for way in CarpetWay}
EDGES = {getattr(CleanGoal, f"EDGES_{order.name}"): order for order in EdgeOrder}
KINDS = {getattr(ZoneMessage, kind.name): kind for kind in ZoneKind}

_LEAST_CORNERS = 3
"""Of an outline that encloses something."""
_DRAWN = 0.003
"""m; a path that is shown is as near to that which is driven."""
_BARRED, _CARPET = (0.9, 0.1, 0.1, 0.9), (0.5, 0.45, 0.4, 0.9)
"""Red, green, blue and opacity of zones."""
_OUTLINE = 0.03
"""m; width of lines around zones."""


_Member = TypeVar("_Member", bound=Enum)

RoomOutlines = tuple[tuple[str, shapely.Polygon], ...]
"""Names and outlines, m, of rooms."""


class CleanGoalError(MessageError, CleanRefusedError):
    """An invalid goal of a clean."""


def request_of(goal: CleanGoal) -> CleanRequest:
    """Return the request of a goal; raises CleanGoalError for an invalid one."""
    if goal.mode not in MODES:
        raise CleanGoalError(f"expected a mode from 0 to {len(MODES) - 1}, got {goal.mode}")
    if goal.fan not in FANS:
        raise CleanGoalError(f"expected a fan level from 0 to {len(FANS) - 1}, got {goal.fan}")
    for what, code, known in (("carpets", goal.carpets, CARPETS), ("edges", goal.edges, EDGES)):
        if code not in known:
            raise CleanGoalError(f"expected {what} from 0 to {len(known) - 1}, got {code}")
    mode, zones = MODES[goal.mode], tuple(map(_corners, goal.zones))
    spot = None if goal.spot_is_here else (goal.spot.x, goal.spot.y)
    if not all(map(math.isfinite, spot or ())):
        raise CleanGoalError(f"expected a spot of finite numbers, m, got {spot}")
    try:
        request = CleanRequest(
            mode,
            rooms=tuple(goal.rooms),
            zones=zones,
            spot=spot if mode is CleanMode.SPOT else None,
            passes=goal.passes or 1,
            fan=FANS[goal.fan],
            in_order=goal.in_order,
            each=ways_of(goal),
            carpets=CARPETS[goal.carpets],
            edges=EDGES[goal.edges],
        )
    except CleanRefusedError as error:
        raise CleanGoalError(str(error)) from error
    return request


def goal_of(request: CleanRequest) -> CleanGoal:
    """Return the goal of a request."""
    spot = request.spot
    passes, fans = way_codes(request.each)
    return CleanGoal(
        mode=_code_of(MODES, request.mode),
        rooms=list(request.rooms),
        in_order=request.in_order,
        zones=[Rectangle(*zone) for zone in request.zones],
        spot=Point() if spot is None else Point(*spot, 0.0),
        spot_is_here=spot is None,
        passes=request.passes,
        fan=_code_of(FANS, request.fan),
        room_passes=passes,
        room_fans=fans,
        carpets=_code_of(CARPETS, request.carpets),
        edges=_code_of(EDGES, request.edges),
    )


def way_codes(each: Sequence[RoomWay]) -> tuple[list[int], list[int]]:
    """Return passes and fan levels of rooms, as messages have them; raises CleanRefusedError."""
    for way in each:
        require_passes(way.passes)
    return [way.passes for way in each], [_code_of(FANS, way.fan) for way in each]


def _code_of(codes: Mapping[int, _Member], member: _Member) -> int:
    return next(code for code, each in codes.items() if each is member)


def ways_of(asked: CleanGoal | ChangeRoomsRequest) -> tuple[RoomWay, ...]:
    """Return how each room is cleaned; arrays of uint8 come as bytes. Raises CleanGoalError."""
    passes, fans = list(asked.room_passes), list(asked.room_fans)
    if len(passes) != len(fans) or not set(fans) <= set(FANS):
        raise CleanGoalError(
            f"expected as many fan levels from 0 to {len(FANS) - 1} as passes of rooms, got "
            f"{fans} for {passes}"
        )
    return tuple(RoomWay(often, FANS[fan]) for often, fan in zip(passes, fans, strict=True))


def _corners(zone: Rectangle) -> tuple[float, float, float, float]:
    return zone.min_x, zone.min_y, zone.max_x, zone.max_y


def result_message(result: CleanResult) -> CleanResultMessage:
    """Return what a clean achieved as a message."""
    return CleanResultMessage(
        outcome=OUTCOMES[result.outcome],
        message=result.message,
        covered=result.covered,
        wanted=result.wanted,
        dirt=result.dirt,
        distance=result.distance,
        duration=result.duration,
        energy=result.energy,
        missed=[_missed_message(missed) for missed in result.missed],
        times=TimeSpentMessage(**asdict(result.times)),
        rooms=[RoomDirtMessage(each.room, each.share, each.grains) for each in result.rooms],
        open_edges=_edge_messages(result.open_edges),
    )


def explored_message(result: ExploreResult) -> ExploreResultMessage:
    """Return what an exploration achieved as a message."""
    return ExploreResultMessage(
        outcome=OUTCOMES[result.outcome],
        message=result.message,
        known=result.known,
        distance=result.distance,
        duration=result.duration,
        unseen=[Point(x, y, 0.0) for x, y in result.unseen],
        open_edges=_edge_messages(result.open_edges),
    )


def _edge_messages(edges: Sequence[OpenEdge]) -> list[OpenEdgeMessage]:
    return [
        OpenEdgeMessage(
            edge.length,
            Point(edge.x, edge.y, 0.0),
            _code_of(EDGE_REASONS, edge.reason),
            edge.reason.value,
        )
        for edge in edges
    ]


def _missed_message(missed: Missed) -> MissedArea:
    return MissedArea(
        missed.area,
        Point(missed.x, missed.y, 0.0),
        missed.room,
        REASONS[missed.reason],
        missed.reason.value,
    )


def put_reason(state: VacuumState, reason: Reason) -> None:
    """Put into a state why the robot does not do what was asked."""
    state.message, state.looks_within = reason.text, reason.looks_within
    state.hindrance = _code_of(HINDRANCES, reason.hindrance)


def line_trouble_message(reason: Reason) -> LineTrouble:
    """Return why a robot on a line cannot be reached as a message."""
    return LineTrouble(_code_of(HINDRANCES, reason.hindrance), reason.text)


def feedback_message(state: VacuumState) -> CleanFeedback:
    """Return the progress of a clean, from the state that is published."""
    return CleanFeedback(
        state.state,
        state.room,
        state.covered,
        state.wanted,
        state.fraction,
        state.seconds_to_go,
        state.battery,
    )


def battery_of(message: BatteryState, voltage: float, is_docked: bool = False) -> Battery:
    """Return the battery; charges are in Ah at the nominal ``voltage``, V.

    A capacity that is not finite is not measured. Raises MessageError for a level that is none.
    """
    level = message.percentage
    if not 0.0 <= level <= 1.0:
        raise MessageError(f"expected a percentage from 0 to 1, got {level}")
    energy = message.capacity * voltage
    if not (math.isfinite(energy) and energy > 0.0):
        return Battery(level, is_docked=is_docked)
    return Battery(level, energy, is_docked)


def outlines_of(message: RoomArray) -> RoomOutlines:
    """Return the names and outlines of rooms, m; raises MessageError for a broken outline."""
    return tuple((room.name, _outline_of(room)) for room in message.rooms)


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
                _code_of(KINDS, zone.kind),
                [Point(x, y, 0.0) for x, y in zone.points],
            )
            for zone in zones.all
        ],
    )


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


def coverage_message(
    now: float, cells: NDArray[np.uint8], frame: GridFrame, rows: int, frame_id: str
) -> OccupancyGrid:
    """Return how much is cleaned: 0 to 100 of what is wanted in a cell, -1 where nothing is.

    ``cells`` are bits over the fine ``frame``; the message has ``rows`` rows, a whole part of it.
    """
    factor = frame.rows // rows
    coarse = GridFrame(
        frame.resolution * factor, frame.origin_x, frame.origin_y, rows, frame.columns // factor
    )
    wanted = _count(cells & WANTED == WANTED, factor)
    swept = _count(cells & (WANTED | SWEPT) == (WANTED | SWEPT), factor)
    share = np.round(100.0 * swept / np.maximum(wanted, 1))
    values = np.where(wanted > 0, share, -1).astype(np.int8)
    return map_message(now, OccupancyMap(coarse, values), frame_id)


def _count(mask: NDArray[np.bool_], factor: int) -> NDArray[np.int64]:
    """Return how many are true in each block of ``factor`` by ``factor`` cells."""
    rows, columns = mask.shape[0] // factor, mask.shape[1] // factor
    blocks = mask.reshape(rows, factor, columns, factor)
    counted: NDArray[np.int64] = blocks.sum(axis=(1, 3))
    return counted


def dirt_message(
    now: float, density: NDArray[np.float32], frame: GridFrame, dirty: float, frame_id: str
) -> OccupancyGrid:
    """Return where it is dirty, by grains/m2, NaN where that is not known: -1 there.

    100 stands for ``dirty`` and more, from which on floor is cleaned once more.
    """
    share = np.clip(100.0 * np.nan_to_num(density) / dirty, 0.0, 100.0)
    values = np.where(np.isnan(density), -1, np.round(share)).astype(np.int8)
    return map_message(now, OccupancyMap(frame, values), frame_id)


def shown(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a path, float64 [n, 2], with as few points as it needs to be drawn."""
    if len(points) < 3:
        return points
    line = shapely.LineString(points).simplify(_DRAWN, preserve_topology=False)
    return np.asarray(line.coords, np.float64)
