"""Compiled path tracking: from the robot's place along its path to the twist that keeps it there.

The robot follows a path section by section. At the sharp corners between sections it turns on the
spot; in a section it follows the curve that rounds off the path.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part
from roomba.control.curve_kernels import Course

TRACK: Final = np.dtype(
    [
        ("section", "i8"),  # index of the section that the robot is on
        ("leg", "i8"),  # index of the leg of the path that the robot is on
        ("turning", "f8"),  # 1 while the robot turns on the spot towards its section
        ("to_turn", "f8"),  # rad; what is left of that turn, infinite where it drives
        ("done", "f8"),  # 1 at the end of the path
        ("along", "f8"),  # how far along the path the robot is, m
        ("aside", "f8"),  # how far left of its curve, m
        ("speed", "f8"),  # m/s; that the drive should have by the commands so far
        # what does not change
        ("acceleration", "f8"),  # m/s2
        ("braking", "f8"),  # m/s2
        ("reach", "f8"),  # m; at low speed the robot comes back to its curve over about this way
        ("reach_time", "f8"),  # s; faster, over what it drives in this time in addition
        ("gain", "f8"),  # 1/s; of the heading
        ("turning_speed", "f8"),  # rad/s
        ("turning_braking", "f8"),  # rad/s2
        ("aimed", "f8"),  # rad; a turn on the spot ends at an error of the heading below this
        ("there", "f8"),  # m; a section ends so near to its end
        ("period", "f8"),  # s; between two ticks
        ("askew", "f8"),  # rad; at a larger error of the heading the robot turns on the spot
        ("turning_delay", "f8"),  # s; until the drive has the turning speed that it is told
        ("late", "f8"),  # ticks by which the drive is expected to brake late
        ("slowest", "f8"),  # m/s and rad/s; slower than this drives do not turn reliably
    ]
)
"""State and numbers of a tracker, one row; a row in a kernel is a pointer."""
Row = Any

_ROUNDS: Final = 2
"""Rounds of the search for the curve's nearest place; each starts where the one before ended."""
_NO_TURN: Final = 1e-9
"""rad/s; the smallest turning speed that the limit is divided by."""
_STRIDE: Final = 0.1
"""m; how far along a curve that search moves at most in each round."""


@entry
def track(
    state: Row, course: Course, x: float, y: float, theta: float, limit: float
) -> tuple[float, float]:
    """Return the twist, m/s and rad/s, that follows a course from the pose on.

    ``limit`` is the speed wanted, m/s. Advances ``state``, a row of TRACK.
    """
    while state.done == 0.0 and state.section < course.sections.size:
        section = course.sections[state.section]
        heading = locate(state, course, section, x, y)
        error = wrapped(heading - theta)
        if state.turning > 0.0:
            if abs(error) > state.aimed:
                return turn_on_the_spot(state, error)
            state.turning = 0.0
        state.to_turn = math.inf
        left = section.end - state.along
        if left > state.there:
            return drive(state, course, section, error, left, limit)
        state.section += 1
        state.along = section.end
        if state.section < course.sections.size:
            state.leg = section.end_leg
            state.turning = 1.0
    state.done = 1.0
    return 0.0, 0.0


@inner_part
def along_of(state: Row, course: Course) -> float:
    """Return how far along its path the robot is, m; ``state`` is a row of TRACK."""
    length = course.stations[course.stations.size - 1]
    if state.done > 0.0 or course.sections.size == 0:
        return float(length)
    return float(min(max(state.along, 0.0), length))


@inner_part
def off_path(state: Row, course: Course, x: float, y: float) -> float:
    """Return how far a place is from the leg that the robot should be on, m."""
    first_x, first_y = course.points[0, 0], course.points[0, 1]
    if course.sections.size == 0:
        return math.hypot(x - first_x, y - first_y)
    first_x, first_y = course.points[state.leg, 0], course.points[state.leg, 1]
    way_x = course.points[state.leg + 1, 0] - first_x
    way_y = course.points[state.leg + 1, 1] - first_y
    share = ((x - first_x) * way_x + (y - first_y) * way_y) / (way_x * way_x + way_y * way_y)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(x - (first_x + share * way_x), y - (first_y + share * way_y))


@inner_part
def locate(state: Row, course: Course, section: Row, x: float, y: float) -> float:
    """Find the curve's place that is nearest to the robot; return its heading, rad."""
    step = (section.end - section.begin) / (section.last - section.first)
    stride = max(step, _STRIDE)
    along, heading = state.along, 0.0
    for _ in range(_ROUNDS):
        base = min(max(along, section.begin), section.end)
        low, share = between(section, base)
        before, after = course.samples[low], course.samples[low + 1]
        heading = before.heading + share * (after.heading - before.heading)
        dx = x - (before.x + share * (after.x - before.x))
        dy = y - (before.y + share * (after.y - before.y))
        cosine, sine = math.cos(heading), math.sin(heading)
        way = dx * cosine + dy * sine
        state.aside = dy * cosine - dx * sine
        along = base + min(max(way, -stride), stride)
    state.along = max(along, section.begin)
    while state.leg + 1 < section.end_leg and course.stations[state.leg + 1] <= along:
        state.leg += 1
    return heading


@inner_part
def between(section: Row, station: float) -> tuple[int, float]:
    """Return the sample before a station, m, of a section, and the share of the next one."""
    steps = section.last - section.first
    at = steps * (station - section.begin) / (section.end - section.begin)
    low = int(min(max(at, 0.0), steps - 1.0))
    return section.first + low, min(max(at - low, 0.0), 1.0)


@inner_part
def turn_on_the_spot(state: Row, error: float) -> tuple[float, float]:
    """Return the twist that turns by ``error``, rad, and note what is left of the turn."""
    state.speed, state.to_turn = 0.0, abs(error)
    return 0.0, turn_speed(state, error)


@inner_part
def turn_speed(state: Row, error: float) -> float:
    """Return the turning speed, rad/s, that ends a turn on the spot without overshoot."""
    size = abs(error)
    brakeable = stopping_speed(size, state.turning_braking, state.turning_delay)
    speed = min(state.turning_speed, brakeable)
    # The rest at the end takes a few ticks more: the drive is a tick or two late.
    speed = max(min(speed, size / (1.7 * state.period)), 4.0 * state.slowest)
    return math.copysign(min(speed, size / state.period), error)


@inner_part
def drive(
    state: Row, course: Course, section: Row, error: float, left: float, limit: float
) -> tuple[float, float]:
    """Return the twist along the curve, and back onto it, as fast as the curve ahead allows."""
    if abs(error) > state.askew:
        # The robot was pushed aside: it aims first.
        state.turning = 1.0
        return turn_on_the_spot(state, error)
    late = state.late * state.period * state.speed
    speed = min(limit, speed_at(course, section, state.along + late))
    speed = min(speed, arriving_speed(state, left))
    answer(state, speed)
    # The drive answers late: take the curvature where the robot will be by then.
    low, share = between(section, state.along + state.turning_delay * state.speed)
    before, after = course.samples[low].curvature, course.samples[low + 1].curvature
    curvature = before + share * (after - before)
    reach = state.reach + state.reach_time * speed + abs(state.aside)
    back = -math.atan(state.aside / reach)
    turn = state.speed * curvature + state.gain * wrapped(error + back)
    # Where the robot cannot turn so fast, it slows down and keeps to its curve.
    share = min(1.0, state.turning_speed / max(abs(turn), _NO_TURN))
    return share * speed, share * turn


@inner_part
def speed_at(course: Course, section: Row, station: float) -> float:
    """Return the fastest speed at a station of a section, m/s."""
    low, share = between(section, station)
    before, after = course.samples[low].speed, course.samples[low + 1].speed
    return float(before + share * (after - before))


@inner_part
def arriving_speed(state: Row, left: float) -> float:
    """Return the speed, m/s, from which the robot stops at its section's end, ``left`` m ahead."""
    nearly = left / (2.2 * state.period)
    stopping = stopping_speed(left, state.braking, state.late * state.period)
    return float(max(min(stopping, nearly), state.slowest))


@inner_part
def answer(state: Row, speed: float) -> None:
    """Note the speed that the drive has a tick after it was told ``speed``, m/s."""
    least = state.speed - state.braking * state.period
    most = state.speed + state.acceleration * state.period
    state.speed = min(max(speed, least), most)


@inner_part
def stopping_speed(way: float, braking: float, delay: float) -> float:
    """Return the speed from which the drive stops within ``way``: m/s and m, or rad/s and rad.

    The drive goes on for ``delay``, s, and then brakes: v delay + v^2 / (2 braking) = way.
    """
    speed: float = braking * (math.sqrt(delay * delay + 2.0 * max(way, 0.0) / braking) - delay)
    return speed
