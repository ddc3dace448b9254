"""What the robot tells its clients, as values.

Numbers that are not finite, and ways to clean that are none, raise MessageError.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

import genpy
from roomba_robot.msg import (
    CleanFeedback,
    CleanResult,
    ExploreResult,
    LineTrouble,
    Localization,
    MissedArea,
    RoomArray,
    VacuumState,
)
from roomba_robot.msg import OpenEdge as OpenEdgeMessage
from roomba_robot.msg import RoomDirt as RoomDirtMessage
from roomba_robot.msg import TimeSpent as TimeSpentMessage
from std_msgs.msg import String

from roomba.client.protocol import (
    CleanProgress,
    CleanReport,
    ErrandOutcome,
    ExploreReport,
    MissedFloor,
    VacuumSnapshot,
)
from roomba.time_spent import NAMES, NOT_COUNTED, TimeSpent
from roomba.vocabulary import Hindrance, OpenEdge, Reason, RoomDirt, word_of
from roomba_ros.convert.clean_action import EDGE_REASONS, HINDRANCES, OUTCOMES, REASONS, ways_of
from roomba_ros.convert.errors import MessageError, require_finite
from roomba_ros.convert.localization import knowledge_of

BATTERY_NOT_HEARD: Final = -1.0
"""The charge in a state before the first message of the battery; a snapshot has NaN for it."""
_FAILED: Final = "error"
"""The state of a robot that does not do what was asked."""


def vacuum_of(message: VacuumState) -> VacuumSnapshot:
    """Return what the robot does, and how far it is."""
    require_finite(
        "areas, shares and times",
        message.covered,
        message.wanted,
        message.fraction,
        message.seconds_to_go,
        message.battery,
        message.looks_within,
    )
    return VacuumSnapshot(
        state=message.state,
        phase=message.phase,
        message=message.message,
        room=message.room,
        covered=message.covered,
        wanted=message.wanted,
        fraction=message.fraction,
        seconds_to_go=message.seconds_to_go,
        battery=math.nan if message.battery == BATTERY_NOT_HEARD else message.battery,
        queue=tuple(message.queue),
        is_on_carpet=message.on_carpet,
        hindrance=_hindrance_of(message.hindrance),
        looks_within=message.looks_within,
        queue_ways=ways_of(message.queue_passes, message.queue_fans),
    )


def line_trouble_of(message: LineTrouble) -> Reason:
    """Return why a robot on a line cannot be reached; empty if it can."""
    return Reason(message.message, _hindrance_of(message.hindrance))


def _hindrance_of(code: int) -> Hindrance:
    """Return the hindrance of a code; NONE for an unknown code."""
    return HINDRANCES.get(code, Hindrance.NONE)


def progress_of(message: CleanFeedback) -> CleanProgress:
    """Return how far a clean is."""
    return CleanProgress(
        state=message.state,
        room=message.room,
        covered=message.covered,
        wanted=message.wanted,
        fraction=message.fraction,
        seconds_to_go=message.seconds_to_go,
        battery=message.battery,
    )


def outcome_of(code: int) -> ErrandOutcome:
    """Return the outcome that a result's code means; FAULT for an unknown code."""
    named = (outcome for outcome, its_code in OUTCOMES.items() if its_code == code)
    found = next(named, None)
    return ErrandOutcome.FAULT if found is None else ErrandOutcome(found.value)


def clean_end_of(message: CleanResult, outcome: ErrandOutcome, reason: str) -> CleanReport:
    """Return the end of a clean; ``reason`` is used where the result has no message of its own."""
    return CleanReport(
        outcome=outcome,
        message=message.message or reason,
        covered=message.covered,
        wanted=message.wanted,
        dirt=message.dirt,
        distance=message.distance,
        duration=message.duration,
        energy=message.energy,
        missed=tuple(map(_missed_of, message.missed)),
        times=times_of(message.times),
        rooms=room_dirt_of(message.rooms),
        open_edges=open_edges_of(message.open_edges),
    )


def _missed_of(message: MissedArea) -> MissedFloor:
    """Return a missed area; its code is empty for a reason that is unknown here."""
    codes = [word_of(reason) for reason, code in REASONS.items() if code == message.reason]
    at, code = message.at, codes[0] if codes else ""
    return MissedFloor(message.area, at.x, at.y, message.room, message.message, code)


def exploration_end_of(
    message: ExploreResult, outcome: ErrandOutcome, reason: str
) -> ExploreReport:
    """Return the end of an exploration; ``reason`` as for :func:`clean_end_of`."""
    return ExploreReport(
        outcome,
        message.message or reason,
        message.known,
        message.distance,
        message.duration,
        open_edges_of(message.open_edges),
    )


def times_of(message: TimeSpentMessage) -> TimeSpent:
    """Return where the time of a clean went; all 0 if a number in the message is no valid time."""
    times = {name: float(getattr(message, name)) for name in NAMES}
    if not all(0.0 <= value < math.inf for value in times.values()):
        return NOT_COUNTED
    return TimeSpent(**times)


def room_dirt_of(messages: Sequence[RoomDirtMessage]) -> tuple[RoomDirt, ...]:
    """Return how dirty rooms were; rooms with invalid numbers are left out."""
    return tuple(
        RoomDirt(each.room, each.share, each.grains)
        for each in messages
        if 0.0 <= each.share <= 1.0 and 0.0 <= each.grains < math.inf
    )


def open_edges_of(messages: Sequence[OpenEdgeMessage]) -> tuple[OpenEdge, ...]:
    """Return where a map still ends; edges with invalid numbers are left out."""
    return tuple(
        OpenEdge(each.length, each.at.x, each.at.y, EDGE_REASONS[each.reason])
        for each in messages
        if each.reason in EDGE_REASONS
        and 0.0 <= each.length < math.inf
        and math.isfinite(each.at.x)
        and math.isfinite(each.at.y)
    )


def doubt_of(message: Localization) -> str:
    """Return why the robot does not know its pose better; empty if it knows it."""
    return knowledge_of(message).reason


def room_names_of(message: RoomArray) -> tuple[str, ...]:
    """Return the names of a map's rooms."""
    return tuple(room.name for room in message.rooms)


def held_or_troubled(raw: bytes) -> str:
    """Return what ``emergency_stop`` or ``trouble`` says; empty when all is well."""
    return str(_read(String(), raw).data)


def failure_of(raw: bytes) -> str:
    """Return what ``vacuum/state`` says is wrong; empty while the robot does what was asked."""
    state = _read(VacuumState(), raw)
    return str(state.message or state.phase) if state.state == _FAILED else ""


def _read(message: Any, raw: bytes) -> Any:
    try:
        return message.deserialize(raw)
    except genpy.DeserializationError as error:
        raise MessageError(f"expected a {message._type}: {error}") from error
