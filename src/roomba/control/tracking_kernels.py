"""Compiled path tracking: from the robot's place along its path to the twist that keeps it there.

A path is followed leg by leg. Sharp corners are turned on the spot; at soft ones the heading goes
over from one leg to the next while driving.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part

Floats = NDArray[np.float64]

TRACK: Final = np.dtype(
    [
        ("leg", "i8"),  # that it is on
        ("turning", "f8"),  # 1 while it turns on the spot towards its leg
        ("done", "f8"),  # 1 at the end of the path
        ("along", "f8"),  # way on its leg, m
        ("aside", "f8"),  # left of its leg, m
        # what does not change
        ("braking", "f8"),  # m/s2
        ("reach", "f8"),  # m; being aside it comes back over about this way
        ("gain", "f8"),  # 1/s; of the heading
        ("turning_speed", "f8"),  # rad/s
        ("turning_braking", "f8"),  # rad/s2
        ("aimed", "f8"),  # rad; so well it aims before it drives
        ("there", "f8"),  # m; so near to a corner it is there
        ("period", "f8"),  # s; between two ticks
        ("askew", "f8"),  # rad; with a larger error of the heading it turns on the spot first
        ("turning_delay", "f8"),  # s; until the drive has the turning speed that it is told
        ("late", "f8"),  # ticks; by so much the drive is expected to brake late
        ("slowest", "f8"),  # m/s and rad/s; slower than this drives do not turn reliably
    ]
)
"""State and numbers of a tracker, one row; a row in a kernel is a pointer."""
Row = Any


class Course(NamedTuple):
    """A path as kernels know it; see :mod:`.course`.

    ``points`` is [n, 2], m; ``stations`` [n] the way to each, m; ``through`` [n] how fast its
    corner may be taken, m/s, 0 for those that are turned on the spot; ``halves`` [n] how far before
    and after a corner the heading changes, m. ``headings`` [n - 1] are those of the legs, rad.
    """

    points: Floats
    headings: Floats
    stations: Floats
    through: Floats
    halves: Floats


@entry
def track(
    state: Row, course: Course, x: float, y: float, theta: float, limit: float
) -> tuple[float, float]:
    """Return the twist, m/s and rad/s, that follows a course from the pose on.

    ``limit`` is the speed wanted, m/s. Advances ``state``, a row of TRACK.
    """
    last = course.headings.size - 1
    while state.done == 0.0:
        if last < 0:
            state.done = 1.0
            break
        leg = state.leg
        dx, dy = x - course.points[leg, 0], y - course.points[leg, 1]
        heading = course.headings[leg]
        cosine, sine = math.cos(heading), math.sin(heading)
        state.along, state.aside = dx * cosine + dy * sine, dy * cosine - dx * sine
        left = course.stations[leg + 1] - course.stations[leg] - state.along
        error = wrapped(heading - theta)
        if state.turning > 0.0:
            if abs(error) > state.aimed:
                return 0.0, turn_speed(state, error)
            state.turning = 0.0
        is_stop = course.through[leg + 1] == 0.0
        if left > (state.there if is_stop else 0.0):
            return drive(state, course, error, left, limit)
        if leg == last:
            state.done = 1.0
        else:
            state.leg = leg + 1
            state.turning = 1.0 if is_stop else 0.0
    return 0.0, 0.0


@inner_part
def turn_speed(state: Row, error: float) -> float:
    """Return the turning speed, rad/s, that ends a turn on the spot without overshoot."""
    size = abs(error)
    speed = min(state.turning_speed, math.sqrt(2.0 * state.turning_braking * size))
    # The rest at the end takes a few ticks more: the drive is a tick or two late.
    speed = max(min(speed, size / (1.7 * state.period)), 4.0 * state.slowest)
    return math.copysign(min(speed, size / state.period), error)


@inner_part
def drive(
    state: Row, course: Course, error: float, left: float, limit: float
) -> tuple[float, float]:
    """Return the twist along the leg: as fast as the corners ahead allow, back to the line."""
    speed = min(limit, corner_limit(state, course, left, limit))
    bend, _ = blended(state, course, left, 0.0)
    if abs(error + bend) > state.askew:
        # Pushed aside: it aims first.
        state.turning = 1.0
        return 0.0, turn_speed(state, error)
    # Drives answer late: what it has to turn by then.
    _, curvature = blended(state, course, left, state.turning_delay * speed)
    back = -math.atan(state.aside / state.reach)
    turn = speed * curvature + state.gain * wrapped(error + bend + back)
    return speed, min(max(turn, -state.turning_speed), state.turning_speed)


@inner_part
def corner_limit(state: Row, course: Course, left: float, limit: float) -> float:
    """Return the fastest speed, m/s, from which it can brake for all corners ahead."""
    last = course.headings.size - 1
    speed: float = limit
    horizon = limit * limit / (2.0 * state.braking) + 2.0 * limit * state.period
    leg, ahead = state.leg, left
    if state.leg > 0 and state.along < course.halves[leg]:
        # Still in the corner behind.
        speed = min(speed, max(course.through[leg], 4.0 * state.slowest))
    while ahead <= horizon:
        through = course.through[leg + 1]
        if through == 0.0:
            nearly: float = max(ahead, 0.0) / (2.2 * state.period)
            stopping: float = max(min(speed, stopping_speed(state, ahead), nearly), state.slowest)
            return stopping
        way = max(ahead - course.halves[leg + 1] - speed * state.period, 0.0)
        speed = min(speed, math.sqrt(through * through + 2.0 * state.braking * way))
        leg += 1
        if leg > last:
            break
        ahead += course.stations[leg + 1] - course.stations[leg]
    return speed


@inner_part
def stopping_speed(state: Row, way: float) -> float:
    """Return the speed, m/s, from which it stops within ``way``, m.

    The drive obeys with a delay T, for which it goes on: v T + v^2 / (2 b) = way.
    """
    late, braking = state.late * state.period, state.braking
    speed: float = braking * (math.sqrt(late * late + 2.0 * max(way, 0.0) / braking) - late)
    return speed


@inner_part
def blended(state: Row, course: Course, left: float, lead: float) -> tuple[float, float]:
    """Return by how much the wanted heading differs from the leg's, rad, and the curvature, 1/m.

    It is looked up ``lead`` m ahead.
    """
    leg = state.leg
    half = course.halves[leg + 1]
    if half > 0.0 and left - lead < half:
        corner = wrapped(course.headings[leg + 1] - course.headings[leg])
        share = min(0.5 * (1.0 - (left - lead) / half), 1.0)
        return corner * share, corner / (2.0 * half) if share < 1.0 else 0.0
    half = course.halves[leg]
    after = state.along + lead
    if half > 0.0 and after < half:
        corner = wrapped(course.headings[leg] - course.headings[leg - 1])
        return -corner * 0.5 * (1.0 - after / half), corner / (2.0 * half)
    return 0.0, 0.0
