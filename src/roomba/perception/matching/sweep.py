"""Scans of a lidar that turns while the robot moves, as if all beams were measured at once.

Each beam is measured from where dead reckoning had the robot at its own time (as in Zhang and
Singh, "LOAM: lidar odometry and mapping in real-time", 2014). Seen from where the robot was at the
first beam, the ends lie between the lidar's directions; on a surface they are interpolated there.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part
from roomba.perception.matching.beams import LidarBeams, is_all_around
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_in, stretch_at

Floats = NDArray[np.float64]
Ranges = NDArray[np.float32]

_GRAZING: Final = 7.0
_NOISE: Final = 0.03
"""Two beams side by side met one surface if their ranges differ by no more than so many times what
lies between them, and so much, m."""
_MOST_TURNED: Final = 0.5
"""Share of the angle between two beams by which ends may lie apart at most to be neighbours still,
beyond that angle itself."""
SWEEP_WORK: Final = 4
"""Rows of what :func:`at_once` works in."""


class Ends(NamedTuple):
    """Where beams ended, as seen by the lidar from where the first was measured, each [beams].

    ``places`` are their directions, in beams, ``lengths`` their distances, m, nan of those that met
    nothing, ``x`` and ``y`` where they are, m.
    """

    places: Floats
    lengths: Floats
    x: Floats
    y: Floats


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

    That is the time of the first beam; ``ranges`` is float32 [beams], m, and ``path`` is where the
    robot was. A direction that no beam came near is nan. ``work`` is [SWEEP_WORK, beams].
    """
    beams = ranges.size
    ends = Ends(work[0], work[1], work[2], work[3])
    _see_from_first(ranges, lidar, path, stamp, ends)
    for beam in range(beams):
        still[beam] = math.nan
    is_around = is_all_around(beams, lidar.step)
    # What met nothing first: what met something takes its place.
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
    """Find where the ends of beams are, as seen by the lidar from where the first was measured."""
    stretch = stretch_at(path, stamp)
    first_x, first_y, first_theta = pose_in(stretch, stamp)
    cosine, sine = math.cos(first_theta), math.sin(first_theta)
    # From the robot to its lidar at the first beam.
    arm_x = cosine * lidar.mount[0] - sine * lidar.mount[1]
    arm_y = sine * lidar.mount[0] + cosine * lidar.mount[1]
    back = first_theta + lidar.mount[2]
    back_cosine, back_sine = math.cos(back), math.sin(back)
    for beam in range(ranges.size):
        now = stamp + beam * lidar.time_increment
        if not now < stretch.until:
            stretch = stretch_at(path, now)
        x, y, theta = pose_in(stretch, now)
        turned = wrapped(theta - first_theta)
        ends.places[beam] = beam + turned / lidar.step
        ends.lengths[beam] = math.nan
        length = ranges[beam]
        if not lidar.nearest <= length < lidar.farthest:
            continue
        cosine, sine = math.cos(turned), math.sin(turned)
        # Where the lidar is by now, in its frame at the first beam.
        off_x = x - first_x + (cosine - 1.0) * arm_x - sine * arm_y
        off_y = y - first_y + sine * arm_x + (cosine - 1.0) * arm_y
        away_x = back_cosine * off_x + back_sine * off_y
        away_y = back_cosine * off_y - back_sine * off_x
        # The same, and the end, as seen along the beam's direction.
        along, across = lidar.directions[beam, 0], lidar.directions[beam, 1]
        ahead = length * cosine + along * away_x + across * away_y
        aside = length * sine + along * away_y - across * away_x
        ends.places[beam] = beam + math.atan2(aside, ahead) / lidar.step
        ends.lengths[beam] = math.sqrt(ahead * ahead + aside * aside)
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
    """Return which beam points in a direction, no more than a turn before or after all; or -1."""
    if is_around and place < 0:
        place += beams
    elif is_around and place >= beams:
        place -= beams
    return place if 0 <= place < beams else -1
