"""Scans of a lidar that turns while the robot moves, as if all beams were measured at once.

Each beam is measured from where dead reckoning had the robot at its own time (as in Zhang and
Singh, "LOAM: lidar odometry and mapping in real-time", 2014). Seen from where the robot was at the
first beam, the ends lie between the lidar's directions; on a surface they are interpolated there.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part, part
from roomba.perception.matching.beams import LidarBeams, is_all_around
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_beyond

Floats = NDArray[np.float64]
Ranges = NDArray[np.float32]

_GRAZING: Final = 7.0
_NOISE: Final = 0.03
"""Two beams side by side met one surface if their ranges differ by no more than so many times what
lies between them, and so much, m."""
_MOST_TURNED: Final = 0.5
"""Share of the angle between two beams by which ends may lie apart at most to be neighbours still,
beyond that angle itself."""
SWEEP_WORK: Final = 3
"""Rows of what :func:`at_once` works in."""


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
    places, lengths = work[0], work[1]
    _see_from_first(ranges, lidar, path, stamp, places, lengths, work[2])
    for beam in range(beams):
        still[beam] = math.nan
    is_around = is_all_around(beams, lidar.step)
    # What met nothing first: what met something takes its place.
    for beam in range(beams):
        if not lengths[beam] >= 0.0:
            _put(still, round(places[beam]), ranges[beam], is_around)
    for beam in range(beams):
        if lengths[beam] >= 0.0:
            _put(still, round(places[beam]), lengths[beam], is_around)
    for beam in range(beams - 1):
        _interpolate(still, lidar.step, places, lengths, beam, is_around)


@inner_part
def _see_from_first(
    ranges: Ranges,
    lidar: LidarBeams,
    path: ReckonedPath,
    stamp: float,
    places: Floats,
    lengths: Floats,
    pose: Floats,
) -> None:
    """Find where the ends of beams are, as seen by the lidar from where the first was measured.

    ``places`` are their directions, in beams, ``lengths`` their distances, m, nan of those that met
    nothing. The function works in ``pose`` [3 or more].
    """
    mount_x, mount_y, mount_turn = lidar.mount[0], lidar.mount[1], lidar.mount[2]
    origin_x = origin_y = origin_turn = 0.0
    back_cosine, back_sine = 1.0, 0.0
    for beam in range(ranges.size):
        pose_beyond(path, stamp + beam * lidar.time_increment, pose)
        cosine, sine = math.cos(pose[2]), math.sin(pose[2])
        x = pose[0] + cosine * mount_x - sine * mount_y
        y = pose[1] + sine * mount_x + cosine * mount_y
        if beam == 0:
            origin_x, origin_y, origin_turn = x, y, pose[2]
            back = origin_turn + mount_turn
            back_cosine, back_sine = math.cos(back), math.sin(back)
        turned = wrapped(pose[2] - origin_turn)
        places[beam] = beam + turned / lidar.step
        lengths[beam] = math.nan
        length = ranges[beam]
        if not lidar.nearest <= length < lidar.farthest:
            continue
        # Where the lidar is by now, in its frame at the first beam.
        off_x, off_y = x - origin_x, y - origin_y
        away_x = back_cosine * off_x + back_sine * off_y
        away_y = back_cosine * off_y - back_sine * off_x
        cosine, sine = math.cos(turned), math.sin(turned)
        along, across = lidar.directions[beam, 0], lidar.directions[beam, 1]
        end_x = away_x + length * (cosine * along - sine * across)
        end_y = away_y + length * (sine * along + cosine * across)
        angle = lidar.first_angle + beam * lidar.step
        places[beam] = beam + wrapped(math.atan2(end_y, end_x) - angle) / lidar.step
        lengths[beam] = math.hypot(end_x, end_y)


@inner_part
def _interpolate(
    still: Ranges, step: float, places: Floats, lengths: Floats, beam: int, is_around: bool
) -> None:
    """Fill the directions between the ends of a beam and of the next, if both met one surface."""
    near, far = lengths[beam], lengths[beam + 1]
    apart = abs(places[beam + 1] - places[beam])
    if not (near >= 0.0 and far >= 0.0) or apart > 1.0 + _MOST_TURNED or apart == 0.0:
        return
    between = apart * abs(step) * min(near, far)
    if abs(far - near) > _GRAZING * between + _NOISE:
        return
    low, high = min(places[beam], places[beam + 1]), max(places[beam], places[beam + 1])
    for place in range(math.ceil(low), math.floor(high) + 1):
        # Where the ray meets the straight line between both ends.
        after, before = (places[beam + 1] - place) * step, (place - places[beam]) * step
        below = near * math.sin(before) + far * math.sin(after)
        if below != 0.0:
            length = near * far * math.sin(before + after) / below
            _put(still, place, length, is_around)


@part
def _put(still: Ranges, place: int, length: float, is_around: bool) -> None:
    """Set the range in a direction, in beams, if there is one."""
    if is_around:
        place %= still.size
    if 0 <= place < still.size:
        still[place] = length
