"""Lines of CARMEN logs, each a reading.

These parts are read, of the kinds of lines that a drive needs. Three words at the end of a line are
when it was measured, s, by which computer, and when it was recorded, s::

    ODOM x y theta tv rv accel
    FLASER readings [range ...] laser_x laser_y laser_theta odom_x odom_y odom_theta
    ROBOTLASER1 type start_angle field_of_view step farthest accuracy remission_mode readings
        [range ...] remissions [remission ...] laser_x laser_y laser_theta odom_x odom_y odom_theta
        tv rv forward_safety_distance side_safety_distance turn_axis
    RAWLASER1 type start_angle field_of_view step farthest accuracy remission_mode readings
        [range ...] remissions [remission ...]
    PARAM name value

Lengths in m, angles in rad. A FLASER looks ahead over 180 degrees, from right to left; with 400
beams or so over 100 degrees, as its maker sells it.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from roomba.arrays import Floats32
from roomba.geometry import Pose, wrap_angle

_NARROW: Final = (400, 401)
"""Readings of a FLASER over 100 degrees."""


class Fan(NamedTuple):
    """Beams: the first one's angle and the step to the next, rad, and what is the farthest, m."""

    beams: int
    first: float
    step: float
    farthest: float


class CarmenLine(NamedTuple):
    """One line: ``word`` says of which kind; without an odometry or a scan those are None."""

    word: str
    stamp: float
    arrival: float
    odometry: Pose | None
    laser: Pose | None
    fan: Fan | None
    ranges: Floats32 | None


def _parse_odometry(words: list[str]) -> CarmenLine:
    stamp, arrival = _times(words[7:])
    return CarmenLine("ODOM", stamp, arrival, _pose(words[1:4]), None, None, None)


def _parse_front_laser(words: list[str]) -> CarmenLine:
    beams = int(words[1])
    ranges, rest = _ranges(words[2 : 2 + beams], beams), words[2 + beams :]
    if beams in _NARROW:
        fan = Fan(beams, -math.radians(50.0), math.radians(0.25), 0.0)
    else:
        step = math.pi / max(beams - beams % 2, 1)
        fan = Fan(beams, -0.5 * math.pi, step, 0.0)
    stamp, arrival = _times(rest[6:])
    return CarmenLine("FLASER", stamp, arrival, _pose(rest[3:6]), _pose(rest[:3]), fan, ranges)


def _parse_robot_laser(words: list[str]) -> CarmenLine:
    fan, ranges, rest = _configured(words)
    laser, odometry = _pose(rest[:3]), _pose(rest[3:6])
    stamp, arrival = _times(rest[11:])
    return CarmenLine("ROBOTLASER1", stamp, arrival, odometry, laser, fan, ranges)


def _parse_raw_laser(words: list[str]) -> CarmenLine:
    fan, ranges, rest = _configured(words)
    stamp, arrival = _times(rest)
    return CarmenLine("RAWLASER1", stamp, arrival, None, None, fan, ranges)


PARSERS: Final = {
    "FLASER": _parse_front_laser,
    "ROBOTLASER1": _parse_robot_laser,
    "RAWLASER1": _parse_raw_laser,
    "ODOM": _parse_odometry,
}
"""What reads the words of a line, by its first one; raises ValueError and IndexError."""


def _configured(words: list[str]) -> tuple[Fan, Floats32, list[str]]:
    """Return beams and ranges of a line that tells its lidar, and the words after them."""
    first, step, farthest = finite(words[2]), finite(words[4]), finite(words[5])
    beams = int(words[8])
    ranges = _ranges(words[9 : 9 + beams], beams)
    remissions = int(words[9 + beams])
    return Fan(beams, first, step, farthest), ranges, words[10 + beams + remissions :]


def _ranges(words: list[str], beams: int) -> Floats32:
    if len(words) != beams or beams < 0:
        raise ValueError(f"expected {beams} ranges, got {len(words)}")
    return np.array(words, np.float64).astype(np.float32)


def _pose(words: list[str]) -> Pose:
    if len(words) < 3:
        raise ValueError(f"expected x, y and theta, got {len(words)} numbers")
    x, y, theta = map(finite, words)
    return Pose(x, y, wrap_angle(theta))


def _times(words: list[str]) -> tuple[float, float]:
    """Return stamp and arrival, s, of the words that end a line: 0 for a stamp that is missing."""
    stamp = finite(words[0]) if words else 0.0
    return stamp, finite(words[2]) if len(words) > 2 else stamp


def is_number(word: str) -> bool:
    """Whether a word is that of a number, nan and infinity included."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def finite(word: str) -> float:
    """Return the number of a word; raises ValueError for one that is not finite, or none."""
    number = float(word)
    if not math.isfinite(number):
        raise ValueError(f"expected a finite number, got {word}")
    return number
