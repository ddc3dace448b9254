"""Compiled: following the robot from scan to scan, in the frame of the newest submap."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part, part
from roomba.perception.localization.belief.belief import Row, Rows
from roomba.perception.localization.belief.reckon_kernels import compose
from roomba.perception.matching.pose_kernels import beyond, seen_from
from roomba.perception.slam.scan_matching.surfel_kernels import (
    ALIGN_WORK,
    ASKED,
    CLOSE,
    MATCHED,
    Surfels,
    align,
)
from roomba.perception.slam.scan_matching.tolerances import Tolerances, in_plane, last_scale

FOLLOWER: Final = np.dtype(
    [
        ("here", "f8", (3,)),  # at the newest scan: x, y, theta, frame of the newest submap
        ("reckoned", "f8", (3,)),  # the same by dead reckoning, in its own frame
        ("spread", "f8", (3, 3)),  # since a scan confirmed it, m2 and rad2, submap's axes
        ("way", "f8"),  # m; driven in all
        ("met", "f8"),  # of the newest scan: share of points that met a known surface
        ("close", "f8"),  # and share of these that lie in its plane
        ("is_sure", "?"),  # whether the newest scan confirmed the pose
        ("misses", "i8"),  # scans since the last one that confirmed the pose
        ("unsure_way", "f8"),  # m; driven since then
        ("unsure_turn", "f8"),  # rad; turned since then
        ("odometry_scale", "f8", (3,)),  # factors on dead reckoning's variances, learned
        ("range_deviation", "f8"),  # m; of a range, as measured
        ("scanned_at", "f8", (3,)),  # by dead reckoning, where the newest scan was taken
        ("points", "i8"),  # that the newest scan shows
        ("heading_before", "f8"),  # rad; at the scan before, nan if that did not confirm it
        ("keyframe", "f8", (3,)),  # pose of the newest keyframe, in its submap
        ("pace", "f8", (3,)),  # m/s, rad/s; ahead, aside and turning, between the newest two scans
        # what does not change
        ("variance", "f8"),  # m2; of a point
        ("least_points", "i8"),  # see FollowingConfig
        ("many_misses", "i8"),
        ("least_met", "f8"),
        ("least_close", "f8"),
        ("keyframe_way", "f8"),  # m; a scan is kept that is so far from the newest keyframe,
        ("keyframe_turn", "f8"),  # rad; or turned by so much
        ("standing", "f8", (3,)),  # m2, rad2; variances even of a step that odometry reports as 0
        ("work", "f8", (18 + ALIGN_WORK, 3)),  # what the kernel works in; means nothing between
    ],
    align=True,
)
"""State and parameters of a follower, one row."""

COVARIANCE: Final = 4
"""The first of three rows of ``work`` with the covariance of the newest matched pose.

The next three rows are the information of the points by which it was matched."""
_FIRST_SCALES: Final = (0.1, 0.05)
"""m; scales of the first rounds of a match."""
_LEARNING: Final = 0.02
"""Share of the newest scan in the factors on dead reckoning's variances."""
_MARGIN: Final = 4.0
"""Factor on the squared errors that were seen, as errors are larger at times."""
_DOUBTED_MORE: Final = 1.2
"""Factor by which these factors grow after a scan that confirms nothing."""
_MOST_OFF: Final = 200.0
"""Limit of the factor that one scan shows: a jump says nothing of the usual errors."""
_FARTHER_SCALES: Final = (0.3, 0.1)
_FARTHER_SPREAD: Final = (0.1**2, 0.1**2, 0.15**2)
"""m; m2, rad2: scales and variances of a match in a wide window, if a scan hardly agrees."""
_CLEARLY: Final = 1.15
"""Factor by which a scan must agree better after such a match."""
_HARDEST: Final = (1.5, 1.5, 8.0)
"""m/s2, rad/s2; the pace changes by no more: otherwise a match jumped along a corridor, and the
next one would jump back."""
_NO_LEAP: Final = 0.03
"""m; tolerance for the error of a match."""
_LONGEST: Final = 1.0
"""s; over a longer time the pace of the robot is not known."""
_ROUNDS: Final = 5
_STRIDE: Final = 2
"""Stride over the points that are matched, if there are many; keyframes have all points."""
_MANY: Final = 200
"""Points; if there are fewer, all are matched."""
_FAR_REACH: Final = 3
"""Cells of surfels; reach of a match in a wide window, or after many misses."""


@entry
def follow(
    followers: Rows,
    beliefs: Rows,
    reckoned: Floats,
    surfels: Surfels,
    points: Floats,
    count: int,
    elapsed: float,
    expected: float,
) -> None:
    """Move on to ``reckoned`` [3], and correct that by a scan, points [n, 4] seen from there.

    The scan was taken ``elapsed``, s, after the one before it. If that is soon, and a smaller share
    of its points than ``expected`` agrees, the scan is matched again in a wider window.
    """
    follower = followers[0]
    prior, pose, by_pace = follower.work[0], follower.work[1], follower.work[2]
    knows_pace = _go_at_pace(follower, elapsed, by_pace)
    before_x, before_y, before_theta = follower.here[0], follower.here[1], follower.here[2]
    _move_on(follower, beliefs[0], reckoned)
    for axis in range(3):
        prior[axis] = follower.here[axis]
    covariance = follower.work[COVARIANCE : COVARIANCE + 3]
    for row in range(3):
        for column in range(3):
            covariance[row, column] = follower.spread[row, column]
        covariance[row, row] += follower.standing[row]
    reach = _FAR_REACH if follower.misses >= follower.many_misses else 1
    shows_enough = _match(follower, surfels, points, count, prior, reach, _FIRST_SCALES)
    is_soon = 0.0 < elapsed < _LONGEST
    if shows_enough and is_soon and follower.met * follower.close < expected:
        farthest = _HARDEST[0] * elapsed * elapsed + _NO_LEAP if knows_pace else math.inf
        _look_farther(follower, surfels, points, count, prior, expected, farthest)
        if knows_pace and follower.met * follower.close < expected:
            _look_farther(follower, surfels, points, count, by_pace, expected, farthest)
    follower.is_sure = (
        shows_enough
        and follower.met >= follower.least_met
        and follower.close >= follower.least_close
    )
    if not follower.is_sure:
        follower.misses += 1
        for axis in range(3 if shows_enough else 0):
            # Perhaps dead reckoning is off by more than its variances say.
            follower.odometry_scale[axis] = min(
                _DOUBTED_MORE * follower.odometry_scale[axis], _MOST_OFF
            )
        return
    _learn_scale(follower, prior, pose)
    follower.here[0], follower.here[1], follower.here[2] = pose[0], pose[1], wrapped(pose[2])
    _learn_pace(follower, before_x, before_y, before_theta, elapsed)
    follower.spread[:] = 0.0
    follower.misses = 0
    follower.unsure_way = follower.unsure_turn = 0.0


@inner_part
def _go_at_pace(follower: Row, elapsed: float, pose: Floats) -> bool:
    """Fill ``pose`` [3] with where the robot is at its pace so far; tell if that is known."""
    if not follower.is_sure or not 0.0 < elapsed < _LONGEST:
        return False
    pace = follower.pace
    x, y, theta = follower.here[0], follower.here[1], follower.here[2]
    pose[0], pose[1], pose[2] = beyond(
        x, y, theta, pace[0] * elapsed, pace[1] * elapsed, pace[2] * elapsed
    )
    return True


@inner_part
def _learn_pace(follower: Row, x: float, y: float, theta: float, elapsed: float) -> None:
    """Learn the robot's pace since a pose before, even if no scan had confirmed that pose."""
    if not 0.0 < elapsed < _LONGEST:
        follower.pace[:] = 0.0
        return
    off_x, off_y = follower.here[0] - x, follower.here[1] - y
    cosine, sine = math.cos(theta), math.sin(theta)
    seen = (
        (cosine * off_x + sine * off_y) / elapsed,
        (cosine * off_y - sine * off_x) / elapsed,
        wrapped(follower.here[2] - theta) / elapsed,
    )
    for axis in range(3):
        most = _HARDEST[axis] * elapsed
        change = seen[axis] - follower.pace[axis]
        follower.pace[axis] += min(max(change, -most), most)


@inner_part
def _look_farther(
    follower: Row,
    surfels: Surfels,
    points: Floats,
    count: int,
    guess: Floats,
    expected: float,
    farthest: float,
) -> None:
    """Match a scan in a wide window about ``guess`` [3].

    The result is kept only if it agrees as ``expected``, agrees clearly better than before, and is
    no leap of ``farthest``, m, or more.
    """
    pose, matrices = follower.work[1], follower.work[COVARIANCE : COVARIANCE + 6]
    sure, before = follower.work[10], follower.work[11:17]
    met, close = follower.met, follower.close
    for axis in range(3):
        sure[axis] = pose[axis]
        for row in range(6):
            before[row, axis] = matrices[row, axis]
        for row in range(3):
            matrices[row, axis] = 0.0
        matrices[axis, axis] = _FARTHER_SPREAD[axis]
    _match(follower, surfels, points, count, guess, _FAR_REACH, _FARTHER_SCALES)
    is_better = follower.met * follower.close >= max(expected, _CLEARLY * met * close)
    if is_better and not _is_leap(follower, farthest):
        return
    follower.met, follower.close = met, close
    for axis in range(3):
        pose[axis] = sure[axis]
        for row in range(6):
            matrices[row, axis] = before[row, axis]


@inner_part
def _is_leap(follower: Row, farthest: float) -> bool:
    """Whether a match is ``farthest``, m, or more from where odometry and pace both have the robot.

    Things that move along with the robot fit best if it is taken to stand.
    """
    prior, pose, by_pace = follower.work[0], follower.work[1], follower.work[2]
    off = math.hypot(pose[0] - prior[0], pose[1] - prior[1])
    off_pace = math.hypot(pose[0] - by_pace[0], pose[1] - by_pace[1])
    return min(off, off_pace) >= farthest


@part
def _match(
    follower: Row,
    surfels: Surfels,
    points: Floats,
    count: int,
    prior: Floats,
    reach: int,
    first_scales: tuple[float, float],
) -> bool:
    """Match a scan about ``prior`` [3]; set ``met``, ``close``, and pose and covariance (``work``).

    Returns whether the scan shows enough to say anything.
    """
    work = follower.work
    pose, scales, counts = work[1], work[3], work[17]
    covariance, information = work[COVARIANCE : COVARIANCE + 3], work[7:10]
    for axis in range(3):
        pose[axis] = prior[axis]
    noise = follower.range_deviation
    scales[0], scales[1], scales[2] = first_scales[0], first_scales[1], last_scale(noise)
    tolerances = Tolerances(scales, follower.variance, in_plane(noise))
    stride = _STRIDE if count >= _MANY else 1
    is_solved = align(
        surfels, points, count, stride, reach, prior, covariance, tolerances, int(_ROUNDS), pose,
        information, counts, work[18:],
    )  # fmt: skip
    is_solved = is_solved and math.isfinite(pose[0] + pose[1] + pose[2])
    follower.met = follower.close = 0.0
    shows_enough: bool = is_solved and counts[ASKED] >= follower.least_points
    if shows_enough:
        follower.met = counts[MATCHED] / counts[ASKED]
        follower.close = counts[CLOSE] / max(counts[MATCHED], 1.0)
    return shows_enough


@inner_part
def _learn_scale(follower: Row, prior: Floats, pose: Floats) -> None:
    """Learn the factors on dead reckoning's variances from a match; they are 1 or more.

    A match differs from dead reckoning by errors of both. The variance of the match follows from
    the noise of ranges, and is subtracted. The larger it is, the less the match teaches.
    """
    cosine, sine = math.cos(prior[2]), math.sin(prior[2])
    off_x, off_y, turn = pose[0] - prior[0], pose[1] - prior[1], wrapped(pose[2] - prior[2])
    off = (cosine * off_x + sine * off_y, cosine * off_y - sine * off_x, turn)
    spread, scale = follower.spread, follower.odometry_scale
    along = cosine * cosine * spread[0, 0] + sine * sine * spread[1, 1]
    along += 2.0 * cosine * sine * spread[0, 1]
    across = spread[0, 0] + spread[1, 1] - along
    thought = (along, across, spread[2, 2])
    by_noise = (
        _of_noise(follower, cosine, sine, 0.0),
        _of_noise(follower, -sine, cosine, 0.0),
        _of_noise(follower, 0.0, 0.0, 1.0),
    )
    for axis in range(3):
        if not thought[axis] > 0.0:
            continue
        # Both matches err: this one, and the one before, from which dead reckoning went on.
        of_matches = 2.0 * by_noise[axis]
        share = thought[axis] / (thought[axis] + of_matches)
        of_odometry = off[axis] * off[axis] - of_matches
        seen = min(_MARGIN * of_odometry * scale[axis] / thought[axis], _MOST_OFF)
        scale[axis] = max(1.0, scale[axis] + _LEARNING * share * share * (seen - scale[axis]))


@inner_part
def _of_noise(follower: Row, x: float, y: float, turn: float) -> float:
    """Return the variance, m2 or rad2, that noise of ranges gives the newest match along an axis.

    The axis is a unit vector ``x``, ``y`` in the submap's frame, or the ``turn``.
    """
    covariance, information = follower.work[COVARIANCE : COVARIANCE + 3], follower.work[7:10]
    told = follower.work[18]
    variance = 0.0
    for row in range(3):
        told[row] = covariance[row, 0] * x + covariance[row, 1] * y + covariance[row, 2] * turn
    for row in range(3):
        for column in range(3):
            variance += told[row] * information[row, column] * told[column]
    noise = follower.range_deviation
    of_noise: float = variance * noise * noise / follower.variance
    return of_noise


@inner_part
def _move_on(follower: Row, belief: Row, reckoned: Floats) -> None:
    """Move on by dead reckoning, and add its variances since the last scan."""
    ahead, aside, turn = seen_from(follower.reckoned, reckoned)
    driven = math.hypot(ahead, aside)
    follower.way += driven
    follower.unsure_way += driven
    follower.unsure_turn += abs(turn)
    compose(follower.here, ahead, aside, turn)
    for axis in range(3):
        follower.reckoned[axis] = reckoned[axis]
    cosine, sine = math.cos(follower.here[2]), math.sin(follower.here[2])
    scale, spread = follower.odometry_scale, follower.spread
    along, across = scale[0] * belief.spread[0], scale[1] * belief.spread[1]
    spread[0, 0] += cosine * cosine * along + sine * sine * across
    spread[1, 1] += sine * sine * along + cosine * cosine * across
    spread[0, 1] += cosine * sine * (along - across)
    spread[1, 0] = spread[0, 1]
    spread[2, 2] += scale[2] * belief.spread[2]
    belief.spread[:] = 0.0


@entry
def moved_since(
    followers: Rows, beliefs: Rows, x: float, y: float, theta: float
) -> tuple[float, float, float]:
    """Return where the robot is now, x, y, theta, if it was at a pose at the newest scan."""
    ahead, aside, turn = seen_from(followers[0].reckoned, beliefs[0].reckoned)
    return beyond(x, y, theta, ahead, aside, turn)
