"""Compiled: keyframes of a finished drive are matched to groups of others nearby."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import allocating_entry, allocating_part
from roomba.perception.matching.match_kernels import invert
from roomba.perception.matching.pose_kernels import seen_from
from roomba.perception.slam.scan_matching.surfel_kernels import (
    ALIGN_WORK,
    ASKED,
    CLOSE,
    COUNTS,
    MATCHED,
    Surfels,
    add_points,
    align,
    clear,
)
from roomba.perception.slam.scan_matching.tolerances import Tolerances

Numbers = NDArray[np.int64]

SIZE: Final = 10
"""Keyframes of a group."""
_NEARBY: Final = 2.0
"""m; from a keyframe to the middle of a group that it is matched to."""
_APART: Final = 25
"""Keyframes; a group farther away than this in time is of another visit."""
_BETWEEN: Final = 12
"""Keyframes; of groups nearer to each other than this in time one is enough."""
_ROUNDS: Final = 5
_REACH: Final = 1
"""Cells of surfels."""
_POINTS: Final = 120
"""About so many points of a keyframe are matched: neighbouring beams err alike."""
_LOOSE: Final = (0.2**2, 0.2**2, 0.1**2)
"""m2, rad2; assumed variances of the present poses."""
_LEAST_POINTS: Final = 25
_LEAST_MET: Final = 0.5
_LEAST_CLOSE: Final = 0.75
_FARTHEST: Final = 0.3
"""m; a match that corrects by more than this found another place."""
_LEAST: Final = (0.004**2, 0.004**2, 0.0015**2)
"""m2, rad2; least variances of a match, as neighbouring beams err alike."""
_NEXT_TO_NOTHING: Final = 1e-3
"""1/m2, 1/rad2; information along a direction in which nothing holds a match."""


class Scans(NamedTuple):
    """All keyframes: ``points`` [n, 4], one after the other, each from ``firsts`` [keyframes + 1]
    on; ``poses`` [keyframes, 3] are where they were taken, map frame.
    """

    points: Floats
    firsts: Numbers
    poses: Floats


class Asked(NamedTuple):
    """Groups of SIZE keyframes by their ``firsts`` and ``middles``, [groups], and the ``frames``
    [n] to be matched to each, one group after the other, from ``starts`` [groups + 1] on.
    """

    firsts: Numbers
    middles: Numbers
    starts: Numbers
    frames: Numbers


@allocating_entry
def nearby_visits(poses: Floats, middles: Numbers, visits: Numbers) -> None:
    """Fill ``visits`` [keyframes, n] with the groups of other visits nearest to each keyframe.

    ``poses`` is float64 [keyframes, 3], map frame; ``middles`` [groups] are the middle keyframes of
    groups. The nearest groups come first; the rest of a row is -1.
    """
    visits[:] = -1
    near, away = np.empty(middles.size, np.int64), np.empty(middles.size)
    for frame in range(poses.shape[0]):
        count = 0
        for group in range(middles.size):
            middle = middles[group]
            off_x = poses[middle, 0] - poses[frame, 0]
            off_y = poses[middle, 1] - poses[frame, 1]
            if abs(off_x) > _NEARBY or abs(middle - frame) <= _APART:
                continue
            distance = math.hypot(off_x, off_y)
            if distance <= _NEARBY:
                near[count], away[count] = group, distance
                count += 1
        chosen = 0
        for place in np.argsort(away[:count], kind="mergesort"):
            is_new = True
            for other in visits[frame, :chosen]:
                is_new = is_new and abs(middles[near[place]] - middles[other]) > _BETWEEN
            if is_new:
                visits[frame, chosen] = near[place]
                chosen += 1
            if chosen == visits.shape[1]:
                break


@allocating_entry
def match_to_groups(
    surfels: Surfels,
    scans: Scans,
    asked: Asked,
    is_due: NDArray[np.bool_],
    tolerances: Tolerances,
    found: Floats,
    information: Floats,
) -> None:
    """Match keyframes to the groups for which they are ``asked``, where a group ``is_due``.

    For these matches it fills ``found`` [n, 3] with the keyframe's pose as seen from the middle
    keyframe of the group, nan if no pose was found, and ``information`` [n, 3, 3] with that of the
    pose. ``surfels`` is used as a work array.
    """
    work, pose = np.empty((ALIGN_WORK, 3)), np.empty(3)
    for group in range(is_due.size):
        if not is_due[group] or asked.starts[group] == asked.starts[group + 1]:
            continue
        first, middle = asked.firsts[group], asked.middles[group]
        clear(surfels)
        for index in range(first, first + SIZE):
            pose[0], pose[1], pose[2] = seen_from(scans.poses[middle], scans.poses[index])
            points = scans.points[scans.firsts[index] : scans.firsts[index + 1]]
            add_points(surfels, points, len(points), pose)
        for place in range(asked.starts[group], asked.starts[group + 1]):
            frame = asked.frames[place]
            pose[0], pose[1], pose[2] = seen_from(scans.poses[middle], scans.poses[frame])
            points = scans.points[scans.firsts[frame] : scans.firsts[frame + 1]]
            if not _match(
                surfels, points, pose, tolerances, found[place], information[place], work
            ):
                found[place] = math.nan


@allocating_part
def _match(
    surfels: Surfels,
    points: Floats,
    thought: Floats,
    tolerances: Tolerances,
    pose: Floats,
    information: Floats,
    work: Floats,
) -> bool:
    """Find the pose near ``thought`` [3] from which the points fit; tell if there is one."""
    covariance, gained, counts = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(COUNTS)
    for axis in range(3):
        covariance[axis, axis] = _LOOSE[axis]
        pose[axis] = thought[axis]
    stride = max(1, len(points) // _POINTS)
    is_solved = align(
        surfels, points, len(points), stride, int(_REACH), thought, covariance, tolerances,
        int(_ROUNDS), pose, gained, counts, work,
    )  # fmt: skip
    if not (is_solved and math.isfinite(pose[0] + pose[1] + pose[2])):
        return False
    if counts[MATCHED] < max(_LEAST_POINTS, _LEAST_MET * counts[ASKED]):
        return False
    if counts[CLOSE] < _LEAST_CLOSE * counts[MATCHED]:
        return False
    if math.hypot(pose[0] - thought[0], pose[1] - thought[1]) > _FARTHEST:
        return False
    for axis in range(3):
        gained[axis, axis] += _NEXT_TO_NOTHING
    if not invert(gained, covariance):
        return False
    for axis in range(3):
        covariance[axis, axis] += _LEAST[axis]
    return invert(covariance, information)
