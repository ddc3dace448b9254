"""What the robot tells its clients, as values; numbers that are not finite raise MessageError."""

from __future__ import annotations

import math
from typing import Any, Final

import genpy
from roomba_robot.msg import Localization, RoomArray, VacuumState
from std_msgs.msg import String

from roomba.client.protocol import VacuumSnapshot
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
    )


def doubt_of(message: Localization) -> str:
    """Return why the robot does not know its place better; empty if it knows it."""
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
