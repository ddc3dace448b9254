"""Compiled rounding of a path's soft corners: a curve, and how it bends.

Each point of the curve is the mean of the path's points around it, with triangular weights. A bend
of even curvature stays even, and a corner becomes a bend whose curvature rises and falls evenly. A
drive can follow that: along such a curve (a clothoid) the turning speed changes evenly. How fast
the curve can be driven: :mod:`.curve_speed_kernels`.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part
from roomba.control.curve_speed_kernels import Row, limit_speeds

SAMPLE: Final = np.dtype(
    [
        ("x", "f8"),  # m
        ("y", "f8"),  # m
        ("heading", "f8"),  # rad; without jumps within a section
        ("curvature", "f8"),  # 1/m; positive to the left
        ("tightening", "f8"),  # 1/m2; how much the size of the curvature grows per metre
        ("speed", "f8"),  # m/s; the fastest that is allowed there
    ]
)
"""A place on the curve."""

SECTION: Final = np.dtype(
    [
        ("begin", "f8"),  # m; along the path
        ("end", "f8"),  # m; the same
        ("first", "i8"),  # index of its first sample
        ("last", "i8"),  # and of its last one
        ("around", "i8"),  # samples before and behind the section that its means reach
        ("leg", "i8"),  # index of its first leg
        ("end_leg", "i8"),  # one past its last leg
    ]
)
"""A part of the course that is driven in one go, between two turns on the spot."""

BENDING: Final = np.dtype(
    [
        ("off_corner", "f8"),  # m; the curve is not farther off the path
        ("longest_blend", "f8"),  # m; no mean is taken over more than this to each side
        ("turning", "f8"),  # rad/s
        ("turning_acceleration", "f8"),  # rad/s2
        ("turning_braking", "f8"),  # rad/s2
        ("half_track", "f8"),  # m; from the middle to a wheel
        ("slowest", "f8"),  # m/s; no bend limits the speed to less
        ("fastest", "f8"),  # m/s; of a wheel
        ("acceleration", "f8"),  # m/s2
        ("braking", "f8"),  # m/s2
    ]
)
"""Limits of a curve, one row."""

_HALVINGS: Final = 10
"""How often the interval is halved in which a mean's width is searched for."""
_WIDENING: Final = 0.5
"""Share of the way between two corners by which the mean's reach may grow along that way."""
_STRAIGHT: Final = 1e-6
"""1/m; a smaller curvature is rounding error, and bends to neither side."""


class Course(NamedTuple):
    """A path as kernels know it; see :mod:`.course`.

    ``points`` is [n, 2], m, and ``stations`` [n] the length of the path up to each, m.
    ``sections``, rows of SECTION, are driven one after the other; ``samples``, rows of SAMPLE, are
    evenly spaced in each.
    """

    points: Floats
    stations: Floats
    sections: Any
    samples: Any


@entry
def round_off(course: Course, turns: Floats, halves: Floats, raw: Floats, limits: Any) -> None:
    """Fill in the samples of a course.

    ``turns`` [n] is how much the path turns at each of its points, rad, to either side. ``halves``
    [n] and ``raw`` [samples, 2] are work arrays: how far to each side of a corner the mean is
    taken, m, and the path's points at the samples of one section and around it, m. ``limits`` is
    one row of BENDING.
    """
    for section in course.sections:
        step = (section.end - section.begin) / (section.last - section.first)
        _widen(course.stations, turns, section, halves, limits[0])
        _lay_out(course, section, raw, step)
        _average(course, section, halves, raw, step)
        _bend(course.samples, section, step)
        _tighten(course.samples, section, step)
        limit_speeds(course.samples, section, step, limits[0])


@inner_part
def _widen(stations: Floats, turns: Floats, section: Row, halves: Floats, limits: Row) -> None:
    """Set how far to each side of the section's corners the mean is taken, m.

    It is as far as the limits let the curve leave the path, and changes slowly between corners.
    """
    first, last = section.leg + 1, section.end_leg - 1
    for at in range(first, last + 1):
        narrow, wide = 0.0, limits.longest_blend
        for _ in range(_HALVINGS):
            half = 0.5 * (narrow + wide)
            if _off_corner(stations, turns, at, first, last, half) <= limits.off_corner:
                narrow = half
            else:
                wide = half
        halves[at] = narrow
    for at in range(first + 1, last + 1):
        most = halves[at - 1] + _WIDENING * (stations[at] - stations[at - 1])
        halves[at] = min(halves[at], most)
    for at in range(last - 1, first - 1, -1):
        most = halves[at + 1] + _WIDENING * (stations[at + 1] - stations[at])
        halves[at] = min(halves[at], most)


@inner_part
def _off_corner(
    stations: Floats, turns: Floats, at: int, first: int, last: int, half: float
) -> float:
    """Return how far from a corner the mean over ``half`` m to each side is at most, m.

    A corner that turns by a rad, d m away, contributes a (half - d)^3 / (6 half^2).
    """
    off = float(turns[at] * half / 6.0)
    for way in (-1, 1):
        other = at + way
        while first <= other <= last:
            beyond = half - abs(stations[other] - stations[at])
            if beyond <= 0.0:
                break
            off += turns[other] * beyond * beyond * beyond / (6.0 * half * half)
            other += way
    return off


@inner_part
def _lay_out(course: Course, section: Row, raw: Floats, step: float) -> None:
    """Fill ``raw`` with the path's points at the section's samples and around the section, m.

    Before and behind the section the path is extended straight on.
    """
    before = section.around
    points, stations, leg = course.points, course.stations, section.leg
    for at in range(section.last - section.first + 2 * before + 1):
        station = section.begin + (at - before) * step
        while leg + 1 < section.end_leg and stations[leg + 1] <= station:
            leg += 1
        share = (station - stations[leg]) / (stations[leg + 1] - stations[leg])
        for axis in range(2):
            way = points[leg + 1, axis] - points[leg, axis]
            raw[at, axis] = points[leg, axis] + share * way


@inner_part
def _average(course: Course, section: Row, halves: Floats, raw: Floats, step: float) -> None:
    """Set the places of a section's samples to the means of the path around them."""
    before = section.around
    corner = section.leg
    for at in range(section.last - section.first + 1):
        station = section.begin + at * step
        while corner + 1 < section.end_leg and course.stations[corner + 1] <= station:
            corner += 1
        half = _half_width(course.stations, section, halves, corner, station) / step
        x, y, total = raw[before + at, 0], raw[before + at, 1], 1.0
        for away in range(1, math.ceil(half)):
            weight = 1.0 - away / half
            x += weight * (raw[before + at - away, 0] + raw[before + at + away, 0])
            y += weight * (raw[before + at - away, 1] + raw[before + at + away, 1])
            total += 2.0 * weight
        sample = course.samples[section.first + at]
        sample.x, sample.y = x / total, y / total


@inner_part
def _half_width(
    stations: Floats, section: Row, halves: Floats, corner: int, station: float
) -> float:
    """Return over how many m to each side of a station the mean is taken.

    ``corner`` is the index of the point before the station. Return 0 if no corner is in reach.
    """
    has_before, has_after = corner > section.leg, corner + 1 < section.end_leg
    since, until = station - stations[corner], stations[corner + 1] - station
    before = halves[corner] if has_before else halves[corner + 1]
    after = halves[corner + 1] if has_after else halves[corner]
    half = (until * before + since * after) / (since + until)
    is_near = (has_before and since < half) or (has_after and until < half)
    return half if is_near else 0.0


@inner_part
def _bend(samples: Any, section: Row, step: float) -> None:
    """Fill in the headings and the curvature of a section whose samples have their places."""
    first, last = section.first, section.last
    for at in range(first, last + 1):
        behind, ahead = samples[max(at - 1, first)], samples[min(at + 1, last)]
        heading = math.atan2(ahead.y - behind.y, ahead.x - behind.x)
        if at > first:
            before = samples[at - 1].heading
            heading = before + wrapped(heading - before)
        samples[at].heading = heading
    if last > first + 1:
        # So far the headings at the ends are those half a step inside: extrapolate them.
        samples[first].heading = 2.0 * samples[first].heading - samples[first + 1].heading
        samples[last].heading = 2.0 * samples[last].heading - samples[last - 1].heading
    for at in range(first, last + 1):
        low, high = max(at - 1, first), min(at + 1, last)
        turn = samples[high].heading - samples[low].heading
        samples[at].curvature = turn / ((high - low) * step)


@inner_part
def _tighten(samples: Any, section: Row, step: float) -> None:
    """Fill in by how much the bends of a section tighten; less than 0 where they open.

    A bend that changes sides counts as tightening: the turning speed grows there, to the other
    side.
    """
    first, last = section.first, section.last
    for at in range(first, last + 1):
        low, high = max(at - 1, first), min(at + 1, last)
        before, after = samples[low].curvature, samples[high].curvature
        changes_sides = min(before, after) < -_STRAIGHT and max(before, after) > _STRAIGHT
        change = abs(after - before) if changes_sides else abs(after) - abs(before)
        samples[at].tightening = change / ((high - low) * step)
