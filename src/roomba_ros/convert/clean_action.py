"""What is asked of a clean, how far it is and what it achieved, as values and as messages."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict

from geometry_msgs.msg import Point
from roomba_robot.msg import (
    CleanFeedback,
    CleanGoal,
    LineTrouble,
    MissedArea,
    Rectangle,
    VacuumState,
)
from roomba_robot.msg import CleanResult as CleanResultMessage
from roomba_robot.msg import ExploreResult as ExploreResultMessage
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from roomba_robot.msg import RoomDirt as RoomDirtMessage
from roomba_robot.msg import TimeSpent as TimeSpentMessage

from roomba.clean_request import CleanRefusedError, CleanRequest, require_passes
from roomba.mission.cleaning.result import CleanOutcome, CleanResult, Missed, MissReason
from roomba.mission.exploring.exploration import ExploreResult
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
from roomba_ros.convert.errors import MessageError
from roomba_ros.convert.values import code_of

MODES = {getattr(CleanGoal, mode.name): mode for mode in CleanMode}
FANS = {getattr(CleanGoal, level.name): level for level in FanLevel}
OUTCOMES = {outcome: getattr(CleanResultMessage, outcome.name) for outcome in CleanOutcome}
REASONS = {reason: getattr(MissedArea, reason.name) for reason in MissReason}
HINDRANCES = {getattr(VacuumState, hindrance.name): hindrance for hindrance in Hindrance}
EDGE_REASONS = {getattr(OpenEdgeMessage, reason.name): reason for reason in EdgeReason}
CARPETS = {getattr(CleanGoal, f"CARPETS_{way.name}"): way for way in CarpetWay}
EDGES = {getattr(CleanGoal, f"EDGES_{order.name}"): order for order in EdgeOrder}


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
            each=ways_of(goal.room_passes, goal.room_fans),
            carpets=CARPETS[goal.carpets],
            edges=EDGES[goal.edges],
        )
    except (CleanRefusedError, MessageError) as error:
        raise CleanGoalError(str(error)) from error
    return request


def goal_of(request: CleanRequest) -> CleanGoal:
    """Return the goal of a request."""
    spot = request.spot
    passes, fans = way_codes(request.each)
    return CleanGoal(
        mode=code_of(MODES, request.mode),
        rooms=list(request.rooms),
        in_order=request.in_order,
        zones=[Rectangle(*zone) for zone in request.zones],
        spot=Point() if spot is None else Point(*spot, 0.0),
        spot_is_here=spot is None,
        passes=request.passes,
        fan=code_of(FANS, request.fan),
        room_passes=passes,
        room_fans=fans,
        carpets=code_of(CARPETS, request.carpets),
        edges=code_of(EDGES, request.edges),
    )


def way_codes(each: Sequence[RoomWay]) -> tuple[list[int], list[int]]:
    """Return passes and fan levels of rooms, as messages have them; raises CleanRefusedError."""
    for way in each:
        require_passes(way.passes)
    return [way.passes for way in each], [code_of(FANS, way.fan) for way in each]


def ways_of(passes: Sequence[int], fans: Sequence[int]) -> tuple[RoomWay, ...]:
    """Return how each room is cleaned; arrays of uint8 come as bytes. Raises MessageError."""
    if len(passes) != len(fans) or not set(fans) <= set(FANS):
        raise MessageError(
            f"expected as many fan levels from 0 to {len(FANS) - 1} as passes of rooms, got "
            f"{list(fans)} for {list(passes)}"
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
            code_of(EDGE_REASONS, edge.reason),
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
    state.hindrance = code_of(HINDRANCES, reason.hindrance)


def line_trouble_message(reason: Reason) -> LineTrouble:
    """Return why a robot on a line cannot be reached as a message."""
    return LineTrouble(code_of(HINDRANCES, reason.hindrance), reason.text)


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
