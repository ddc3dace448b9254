"""A path prepared for driving: its legs, and the curve that rounds off its soft corners."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import TrackingConfig
from roomba.control.curve_kernels import BENDING, SAMPLE, SECTION, Course, round_off

Floats = NDArray[np.float64]
Rows = NDArray[np.void]

SHORTEST_LEG: Final = 1e-4
"""m; points nearer to the one before are left out."""
_STEP: Final = 0.004
"""m; at most, between samples of the curve."""


def course_of(points: Floats, config: TrackingConfig, body: BodyConfig) -> Course:
    """Return the course along ``points``, float64 [n, 2], m.

    Corners sharper than ``config.sharp_corner`` part it into sections. The curve of a section is at
    most ``config.off_corner`` from the path.
    """
    legs = np.hypot(*np.diff(points, axis=0).T)
    points = np.ascontiguousarray(points[np.concatenate(([True], legs > SHORTEST_LEG))])
    ways = np.diff(points, axis=0)
    headings = np.arctan2(ways[:, 1], ways[:, 0])
    stations = np.concatenate(([0.0], np.cumsum(np.hypot(ways[:, 0], ways[:, 1]))))
    turns = np.zeros(len(points))
    turns[1:-1] = np.abs(wrap_angles(np.diff(headings)))
    sections = _sections(stations, np.flatnonzero(turns > config.sharp_corner))
    samples = np.zeros(int(sections["last"][-1]) + 1 if len(sections) else 0, SAMPLE)
    course = Course(points, stations, sections, samples)
    _round_off(course, turns, config, body)
    return course


def _sections(stations: Floats, stops: NDArray[np.intp]) -> Rows:
    """Return the sections, rows of SECTION, between the path's ends and its stops."""
    ends = np.concatenate((stops, [len(stations) - 1]))[: max(len(stations) - 1, 0)]
    begins = np.concatenate(([0], ends[:-1])) if len(ends) else ends
    sections = np.zeros(len(ends), SECTION)
    sections["begin"], sections["end"] = stations[begins], stations[ends]
    sections["leg"], sections["end_leg"] = begins, ends
    # A straight one is told by its ends.
    steps = np.ceil((sections["end"] - sections["begin"]) / _STEP).astype(np.int64)
    steps[ends - begins == 1] = 1
    sections["last"] = np.cumsum(steps + 1) - 1
    sections["first"] = sections["last"] - steps
    return sections


def _round_off(course: Course, turns: Floats, config: TrackingConfig, body: BodyConfig) -> None:
    """Fill in the course's curve; ``turns`` is how much the path turns at each point, rad."""
    keep = np.zeros(1, BENDING)
    keep["off_corner"], keep["longest_blend"] = config.off_corner, config.longest_blend
    keep["turning"] = config.corner_turning
    keep["turning_acceleration"] = config.corner_acceleration
    keep["slowest"], keep["fastest"] = config.slowest_corner, body.max_speed
    keep["acceleration"], keep["braking"] = body.max_acceleration, config.braking
    round_off(course, turns, np.zeros(len(turns)), np.empty((_room(course, config), 2)), keep)


def _room(course: Course, config: TrackingConfig) -> int:
    """Return for how many samples the longest section needs room, with what is around it."""
    sections = course.sections
    steps = sections["last"] - sections["first"]
    around = np.ceil(config.longest_blend * steps / (sections["end"] - sections["begin"]))
    return int(np.max(steps + 2 * around + 1, initial=0))
