"""A path prepared for driving: its legs, and the curve that rounds off its soft corners."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats
from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import TrackingConfig
from roomba.control.curve_kernels import BENDING, SAMPLE, SECTION, Course, round_off

Rows = NDArray[np.void]

SHORTEST_LEG: Final = 1e-4
"""m; a point nearer than this to the point before it is left out."""
_STEP: Final = 0.004
"""m; the largest distance between neighbouring samples of a section with soft corners."""
_ROUNDING: Final = 1e-6
"""In steps; rounding makes a sum of legs wrong by less than this."""


def course_of(points: Floats, config: TrackingConfig, body: BodyConfig) -> Course:
    """Return the course along ``points``, float64 [n, 2], m.

    Corners sharper than ``config.sharp_corner`` divide the course into sections. The curve of a
    section is at most ``config.off_corner`` from the path.
    """
    legs = np.hypot(*np.diff(points, axis=0).T)
    points = np.ascontiguousarray(points[np.concatenate(([True], legs > SHORTEST_LEG))])
    ways = np.diff(points, axis=0)
    headings = np.arctan2(ways[:, 1], ways[:, 0])
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(ways[:, 0], ways[:, 1]))))
    turns = np.zeros(len(points))
    turns[1:-1] = np.abs(wrap_angles(np.diff(headings)))
    sections = _sections(stations, np.flatnonzero(turns > config.sharp_corner), config)
    samples = np.zeros(np.sum(sections["last"] - sections["first"] + 1), SAMPLE)
    course = Course(points, stations, sections, samples)
    room = sections["last"] - sections["first"] + 2 * sections["around"] + 1
    raw = np.empty((np.max(room, initial=0), 2))
    round_off(course, turns, np.zeros(len(turns)), raw, _limits(config, body))
    return course


def _sections(stations: Floats, stops: NDArray[np.intp], config: TrackingConfig) -> Rows:
    """Return the sections, rows of SECTION, between the path's ends and its stops."""
    if len(stations) < 2:
        return np.zeros(0, SECTION)
    ends = np.append(stops, len(stations) - 1)
    begins = np.append(0, stops)
    sections = np.zeros(len(ends), SECTION)
    sections["begin"], sections["end"] = stations[begins], stations[ends]
    sections["leg"], sections["end_leg"] = begins, ends
    lengths = sections["end"] - sections["begin"]
    # A straight section needs no samples but its two ends.
    steps = np.where(ends - begins == 1, 1.0, np.ceil(lengths / _STEP - _ROUNDING))
    sections["around"] = np.ceil(config.longest_blend * steps / lengths)
    sections["last"] = np.cumsum(steps + 1.0) - 1.0
    sections["first"] = sections["last"] - steps
    return sections


def _limits(config: TrackingConfig, body: BodyConfig) -> Rows:
    """Return the limits of curves, a row of BENDING."""
    limits = np.zeros(1, BENDING)
    limits["off_corner"], limits["longest_blend"] = config.off_corner, config.longest_blend
    limits["turning"] = min(config.corner_turning, config.turning_speed, body.max_angular_speed)
    limits["turning_acceleration"] = min(config.corner_acceleration, body.max_angular_acceleration)
    limits["turning_braking"] = min(config.corner_braking, body.max_angular_deceleration)
    limits["half_track"] = 0.5 * body.wheel_separation
    limits["slowest"], limits["fastest"] = config.slowest_corner, body.max_speed
    limits["acceleration"], limits["braking"] = body.max_acceleration, config.braking
    return limits
