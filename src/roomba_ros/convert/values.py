"""Messages of a single value as values; each function raises MessageError for an invalid one.

They stand apart so that small nodes load neither arrays nor maps.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, TypeVar

from std_msgs.msg import Float32, Time

from roomba_ros.convert.errors import MessageError, require_finite

Member = TypeVar("Member", bound=Enum)


def number_of(message: Float32) -> float:
    """Return a number."""
    require_finite("a value", message.data)
    return float(message.data)


def speed_of(message: Float32) -> float:
    """Return a speed wanted, m/s."""
    require_finite("a speed", message.data)
    if message.data < 0.0:
        raise MessageError(f"expected a speed of 0 m/s or more, got {message.data:g}")
    return float(message.data)


def duty_of(message: Float32) -> float:
    """Return a motor's power, 0 to 1."""
    if not 0.0 <= message.data <= 1.0:
        raise MessageError(f"expected a power from 0 to 1, got {message.data:g}")
    return float(message.data)


def time_of(message: Time) -> float:
    """Return a time, s."""
    return float(message.data.to_sec())


def unchanged(message: Any) -> Any:
    """Return a message that holds neither numbers nor sizes, such as the status of goals."""
    return message


def data_of(message: Any) -> Any:
    """Return the content of a Bool, a String or a UInt16; no value of these is invalid."""
    return message.data


def code_of(codes: Mapping[int, Member], member: Member) -> int:
    """Return the code of a member of an enumeration; ``codes`` are the members by their codes."""
    return next(code for code, each in codes.items() if each is member)
