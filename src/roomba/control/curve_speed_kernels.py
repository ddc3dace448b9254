"""Compiled limits of speed along a curve: what its bends, the brakes and the motors allow.

The turning speed is the speed times the curvature. Both the turning speed and its change are
limited. It changes with the speed, and as the bend tightens or opens.
"""

from __future__ import annotations

import math
from typing import Any, Final

from roomba.compilation import inner_part

Row = Any
"""One row of an array, in a kernel."""

_NO_TURN: Final = 1e-9
"""1/m or 1/m2; the smallest curvature, or change of it, that a limit is divided by."""


@inner_part
def limit_speeds(samples: Any, section: Row, step: float, limits: Row) -> None:
    """Fill in the speeds: what each bend allows by itself, then what braking and speeding up allow.

    ``samples`` are rows of SAMPLE, of which the section's lie ``step`` m apart, ``limits`` a row of
    BENDING.
    """
    first, last = section.first, section.last
    for at in range(first, last + 1):
        samples[at].speed = _bend_speed(samples[at], limits)
    for at in range(last - 1, first - 1, -1):
        after = samples[at + 1].speed
        reached = math.sqrt(after * after + 2.0 * limits.braking * step)
        samples[at].speed = min(samples[at].speed, reached)
    for at in range(first + 1, last + 1):
        before = samples[at - 1]
        acceleration = _bend_acceleration(before, limits)
        reached = math.sqrt(before.speed * before.speed + 2.0 * acceleration * step)
        samples[at].speed = min(samples[at].speed, reached)


@inner_part
def _bend_speed(sample: Row, limits: Row) -> float:
    """Return the fastest speed that the bend at a sample allows by itself, m/s.

    Where the curvature changes by c per metre, the turning speed changes by v^2 c per second. The
    outer wheel is the faster one, so that its top speed counts.
    """
    bend, tightening = abs(sample.curvature), sample.tightening
    most = limits.turning_acceleration if tightening > 0.0 else limits.turning_braking
    even = math.sqrt(most / max(abs(tightening), _NO_TURN))
    turning = limits.turning / max(bend, _NO_TURN)
    outer = limits.fastest / (1.0 + limits.half_track * bend)
    return float(max(min(even, turning, outer), limits.slowest))


@inner_part
def _bend_acceleration(sample: Row, limits: Row) -> float:
    """Return the acceleration that the bend at a sample allows, m/s2.

    A growing speed and a tightening bend both raise the turning speed, and share its limit.
    """
    left = limits.turning_acceleration - sample.speed * sample.speed * sample.tightening
    bend = max(abs(sample.curvature), _NO_TURN)
    return float(min(max(left / bend, 0.0), limits.acceleration))
