"""Correction of scans for the robot's motion: as if all beams were measured at once.

Each beam starts from where dead reckoning had the robot at the beam's own time (as in Zhang and
Singh, "LOAM: lidar odometry and mapping in real-time", 2014). Seen from where the robot was at the
first beam, the ends lie between the directions of the lidar's beams. On a surface, ranges in these
directions are interpolated.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part
from roomba.perception.matching.beams import LidarBeams, is_all_around
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_in, stretch_at
from roomba.trigonometry import direction_of, sine_cosine

Ranges = NDArray[np.float32]

_GRAZING: Final = 7.0
_NOISE: Final = 0.03
"""Two neighbouring beams met one surface if their ranges differ by no more than this factor times
the distance between the beams, plus this, m."""
_MOST_TURNED: Final = 0.5
"""In angles between two beams; the ends of neighbours may lie apart by one angle and this more."""
SWEEP_WORK: Final = 6
"""Rows of what :func:`at_once` works in."""


class Ends(NamedTuple):
    """Ends of beams as seen by the lidar from where the first beam was measured, each [beams].

    ``places`` are the directions of the ends, in beams; ``lengths`` their distances, m, nan for
    beams that met nothing; ``x`` and ``y`` their points, m. ``cosines`` and ``sines`` are work
    arrays. The work is done in stages without branches, so that the compiler can take eight beams
    together.
    """

    places: Floats
    lengths: Floats
    x: Floats
    y: Floats
    cosines: Floats
    sines: Floats


@entry
def at_once(
    ranges: Ranges,
    lidar: LidarBeams,
    path: ReckonedPath,
    stamp: float,
    still: Ranges,
    work: Floats,
) -> None:
    """Fill ``still`` [beams], m, with the scan as if all of it was measured at ``stamp``, s.

    ``stamp`` is the time of the first beam; ``ranges`` is float32 [beams], m, and ``path`` is where
    the robot was. A direction that no beam came near gets nan. ``work`` is [SWEEP_WORK, beams].
    """
    beams = ranges.size
    ends = Ends(work[0], work[1], work[2], work[3], work[4], work[5])
    _see_from_first(ranges, lidar, path, stamp, ends)
    for beam in range(beams):
        still[beam] = math.nan
    is_around = is_all_around(beams, lidar.step)
    # Beams that met nothing come first, so that those that met something overwrite them.
    for beam in range(beams):
        if not ends.lengths[beam] >= 0.0:
            _put(still, round(ends.places[beam]), ranges[beam], is_around)
    for beam in range(beams):
        if ends.lengths[beam] >= 0.0:
            _put(still, round(ends.places[beam]), ends.lengths[beam], is_around)
    for beam in range(beams - 1):
        _interpolate(still, lidar, ends, beam, is_around)


@inner_part
def _see_from_first(
    ranges: Ranges, lidar: LidarBeams, path: ReckonedPath, stamp: float, ends: Ends
) -> None:
    """Find the ends of beams, as seen by the lidar from where the first beam was measured."""
    first = pose_in(stretch_at(path, stamp), stamp)
    _follow(lidar, path, stamp, first, ends)
    _see_lidar(lidar, first[2], ends)
    _see_ends(ranges, lidar, ends)
    _place(ranges, lidar, ends)


@inner_part
def _follow(
    lidar: LidarBeams,
    path: ReckonedPath,
    stamp: float,
    first: tuple[float, float, float],
    ends: Ends,
) -> None:
    """Find how far the robot has moved at each beam: ``x``, ``y``, m, and its turn, ``places``."""
    stretch = stretch_at(path, stamp)
    for beam in range(ends.places.size):
        now = stamp + beam * lidar.time_increment
        if not now < stretch.until:
            stretch = stretch_at(path, now)
        x, y, theta = pose_in(stretch, now)
        ends.x[beam], ends.y[beam] = x - first[0], y - first[1]
        ends.places[beam] = wrapped(theta - first[2])


@inner_part
def _see_lidar(lidar: LidarBeams, first_theta: float, ends: Ends) -> None:
    """Replace ``x``, ``y`` by where the lidar is at each beam, in its own frame at the first."""
    for beam in range(ends.places.size):
        ends.sines[beam], ends.cosines[beam] = sine_cosine(ends.places[beam])
    cosine, sine = math.cos(first_theta), math.sin(first_theta)
    # From the robot to its lidar at the first beam.
    arm_x = cosine * lidar.mount[0] - sine * lidar.mount[1]
    arm_y = sine * lidar.mount[0] + cosine * lidar.mount[1]
    back = first_theta + lidar.mount[2]
    back_cosine, back_sine = math.cos(back), math.sin(back)
    for beam in range(ends.places.size):
        cosine, sine = ends.cosines[beam], ends.sines[beam]
        off_x = ends.x[beam] + (cosine - 1.0) * arm_x - sine * arm_y
        off_y = ends.y[beam] + sine * arm_x + (cosine - 1.0) * arm_y
        ends.x[beam] = back_cosine * off_x + back_sine * off_y
        ends.y[beam] = back_cosine * off_y - back_sine * off_x


@inner_part
def _see_ends(ranges: Ranges, lidar: LidarBeams, ends: Ends) -> None:
    """Replace ``x``, ``y`` by the ends in a frame along each beam's direction: ahead and aside."""
    for beam in range(ranges.size):
        ends.cosines[beam] *= ranges[beam]
        ends.sines[beam] *= ranges[beam]
    for beam in range(ranges.size):
        along, across = lidar.directions[beam, 0], lidar.directions[beam, 1]
        away_x, away_y = ends.x[beam], ends.y[beam]
        ends.x[beam] = ends.cosines[beam] + along * away_x + across * away_y
        ends.y[beam] = ends.sines[beam] + along * away_y - across * away_x


@inner_part
def _place(ranges: Ranges, lidar: LidarBeams, ends: Ends) -> None:
    """Fill in directions and lengths of the ends; a beam that met nothing is only turned."""
    for beam in range(ranges.size):
        is_met = (ranges[beam] >= lidar.nearest) & (ranges[beam] < lidar.farthest)
        ahead, aside = ends.x[beam], ends.y[beam]
        turned = direction_of(aside, ahead) if is_met else ends.places[beam]
        ends.places[beam] = beam + turned / lidar.step
        ends.lengths[beam] = math.sqrt(ahead * ahead + aside * aside) if is_met else math.nan
    for beam in range(ranges.size):
        along, across = lidar.directions[beam, 0], lidar.directions[beam, 1]
        ahead, aside = ends.x[beam], ends.y[beam]
        ends.x[beam] = along * ahead - across * aside
        ends.y[beam] = across * ahead + along * aside


@inner_part
def _interpolate(still: Ranges, lidar: LidarBeams, ends: Ends, beam: int, is_around: bool) -> None:
    """Fill the directions between the ends of a beam and of the next, if both met one surface."""
    near, far = ends.lengths[beam], ends.lengths[beam + 1]
    apart = abs(ends.places[beam + 1] - ends.places[beam])
    if not (near >= 0.0 and far >= 0.0) or apart > 1.0 + _MOST_TURNED or apart == 0.0:
        return
    between = apart * abs(lidar.step) * min(near, far)
    if abs(far - near) > _GRAZING * between + _NOISE:
        return
    x, y = ends.x[beam], ends.y[beam]
    to_x, to_y = ends.x[beam + 1] - x, ends.y[beam + 1] - y
    low = min(ends.places[beam], ends.places[beam + 1])
    high = max(ends.places[beam], ends.places[beam + 1])
    for place in range(math.ceil(low), math.floor(high) + 1):
        index = _index(place, still.size, is_around)
        if index < 0:
            continue
        # Where the ray meets the straight line between both ends.
        along, across = lidar.directions[index, 0], lidar.directions[index, 1]
        beside = along * to_y - across * to_x
        if beside != 0.0:
            still[index] = (x * to_y - y * to_x) / beside


@inner_part
def _put(still: Ranges, place: int, length: float, is_around: bool) -> None:
    """Set the range in a direction, in beams, if there is one."""
    index = _index(place, still.size, is_around)
    if index >= 0:
        still[index] = length


@inner_part
def _index(place: int, beams: int, is_around: bool) -> int:
    """Return the index of the beam in a direction, which may be a turn off; -1 if there is none."""
    if is_around and place < 0:
        place += beams
    elif is_around and place >= beams:
        place -= beams
    return place if 0 <= place < beams else -1
