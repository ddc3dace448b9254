"""Compiled limits of speed along a curve: what its bends allow, and from where they are reached.

The turning speed is the speed times the curvature. It is limited itself, and so is how fast it may
change: by the speed, and by how much the bend tightens or opens.
"""

from __future__ import annotations

import math
from typing import Any, Final

from roomba.compilation import inner_part

Row = Any
"""One row of an array, in a kernel."""

_NO_TURN: Final = 1e-9
"""1/m or 1/m2; a curvature, or its change, that is none."""


@inner_part
def limit_speeds(samples: Any, section: Row, step: float, limits: Row) -> None:
    """Fill in the speeds: of each bend by itself, then from where it can brake and speed up.

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
    """Return the fastest speed at a sample by itself, m/s.

    Where the curvature changes by c in a metre, the turning speed does by v^2 c in a second. The
    outer wheel is the fastest one.
    """
    bend, tightening = abs(sample.curvature), sample.tightening
    most = limits.turning_acceleration if tightening > 0.0 else limits.turning_braking
    even = math.sqrt(most / max(abs(tightening), _NO_TURN))
    turning = limits.turning / max(bend, _NO_TURN)
    outer = limits.fastest / (1.0 + limits.half_track * bend)
    return float(max(min(even, turning, outer), limits.slowest))


@inner_part
def _bend_acceleration(sample: Row, limits: Row) -> float:
    """Return by how much the speed may grow at a sample, m/s2.

    There the turning speed grows with the speed, and with what the bend tightens.
    """
    left = limits.turning_acceleration - sample.speed * sample.speed * sample.tightening
    bend = max(abs(sample.curvature), _NO_TURN)
    return float(min(max(left / bend, 0.0), limits.acceleration))
