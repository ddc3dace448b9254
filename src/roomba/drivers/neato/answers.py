"""What a Neato answers, as values.

Lines are ``label,value,...``; which labels there are, and in which order, differs from firmware to
firmware, so they are found by their names. Source: OpenNeato's page of the serial protocol; the
names of older robots: mikeferguson/neato_robot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError

BEAMS: Final = 360
_LEAST_BEAMS: Final = 300
"""Lines of a scan; with fewer the answer was cut."""
_FIRST_ERROR: Final = 1
"""The least error code of a beam; 0 says that its range is good."""
_LONGEST_RANGE: Final = 65_535
"""mm; the lidar tells ranges in 16 bits."""

Values = Mapping[str, float]


class AnswerError(RoombaError):
    """An answer that cannot be used; the message says what was expected."""


@dataclass(frozen=True, slots=True)
class WheelPositions:
    """How far each wheel rolled since the robot was switched on, m."""

    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Touches:
    """What the digital sensors tell."""

    bumper_left: bool
    bumper_right: bool
    dropped_left: bool
    dropped_right: bool
    has_bin: bool


@dataclass(frozen=True, slots=True)
class Drops:
    """How far below each drop sensor the floor is, m."""

    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Charge:
    """The battery's level, 0..1, whether it charges, and whether a station or cable gives power."""

    level: float
    is_charging: bool
    has_power: bool


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """Ranges by degree, float32 [360], m, inf without an echo; turns of the lidar a second."""

    ranges: NDArray[np.float32]
    rotation: float


def values_of(lines: Sequence[str]) -> Values:
    """Return the numbers of an answer by their labels; lines without a number are left out."""
    values: dict[str, float] = {}
    for line in lines:
        label, *cells = (cell.strip() for cell in line.split(","))
        numbers = [number for number in map(_number, cells) if math.isfinite(number)]
        if numbers:
            values[label] = numbers[0]
    return values


def wheel_positions_of(lines: Sequence[str]) -> WheelPositions:
    """Return the answer to GetMotors; raises AnswerError."""
    values = values_of(lines)
    return WheelPositions(
        1e-3 * _of(values, "LeftWheel_PositionInMM"), 1e-3 * _of(values, "RightWheel_PositionInMM")
    )


def touches_of(lines: Sequence[str]) -> Touches:
    """Return the answer to GetDigitalSensors; raises AnswerError."""
    values = values_of(lines)

    def any_of(*names: str) -> bool:
        return any(values.get(name, 0.0) for name in names)

    for name in ("LSIDEBIT", "LFRONTBIT", "RSIDEBIT", "RFRONTBIT"):
        _of(values, name)
    return Touches(
        any_of("LSIDEBIT", "LFRONTBIT", "LLDSBIT"),
        any_of("RSIDEBIT", "RFRONTBIT", "RLDSBIT"),
        bool(_of(values, "SNSR_LEFT_WHEEL_EXTENDED")),
        bool(_of(values, "SNSR_RIGHT_WHEEL_EXTENDED")),
        bool(_of(values, "SNSR_DUSTBIN_IS_IN")),
    )


def drops_of(lines: Sequence[str]) -> Drops:
    """Return the answer to GetAnalogSensors; raises AnswerError."""
    values = values_of(lines)
    return Drops(
        1e-3 * _of(values, "DropSensorLeft", "LeftDropInMM"),
        1e-3 * _of(values, "DropSensorRight", "RightDropInMM"),
    )


def charge_of(lines: Sequence[str]) -> Charge:
    """Return the answer to GetCharger; raises AnswerError."""
    values = values_of(lines)
    level = 0.01 * _of(values, "FuelPercent")
    if not 0.0 <= level <= 1.0:
        raise AnswerError(f"expected FuelPercent from 0 to 100, got {100.0 * level:g}")
    return Charge(level, bool(_of(values, "ChargingActive")), bool(_of(values, "ExtPwrPresent")))


def scan_of(lines: Sequence[str]) -> Scan:
    """Return the answer to GetLDSScan; raises AnswerError for one that was cut."""
    ranges = np.full(BEAMS, np.inf, np.float32)
    rotation, seen = 0.0, 0
    for line in lines:
        cells = [cell.strip() for cell in line.split(",")]
        if cells[0] == "ROTATION_SPEED" and len(cells) > 1:
            rotation = _number(cells[1])
            continue
        angle, millimetres, error = _beam(cells)
        if not 0 <= angle < BEAMS:
            continue
        seen += 1
        if error < _FIRST_ERROR and millimetres > 0:
            ranges[angle] = 1e-3 * millimetres
    if seen < _LEAST_BEAMS or not math.isfinite(rotation):
        raise AnswerError(f"expected a scan of {BEAMS} lines and ROTATION_SPEED, got {seen}")
    return Scan(ranges, rotation)


def _beam(cells: Sequence[str]) -> tuple[int, int, int]:
    """Return angle, range and error of a line of a scan; the angle is -1 if the line is no beam."""
    try:
        angle, millimetres, error = int(cells[0]), int(cells[1]), int(cells[3], 16)
    except (IndexError, ValueError):
        return -1, 0, 0
    return (angle if 0 <= millimetres <= _LONGEST_RANGE else -1), millimetres, error


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _of(values: Values, *names: str) -> float:
    for name in names:
        if name in values:
            return values[name]
    raise AnswerError(f"expected {' or '.join(names)} in the answer, got {', '.join(values)[:120]}")
