"""Compiled correction of a believed pose by a scan, and whether scans fit as well as usual."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import allocating_entry, allocating_part, entry, inner_part, part
from roomba.perception.calibration.kernels import drop_window
from roomba.perception.calibration.place_kernels import note_pose
from roomba.perception.localization.belief.behind_kernels import leave_out_behind
from roomba.perception.localization.belief.belief import AGREE, EVIDENCE, SHORT, THROUGH, Row, Rows
from roomba.perception.localization.belief.map_spread_kernels import (
    map_spread,
    of_cell,
    wall_variance_of,
)
from roomba.perception.localization.belief.trust_kernels import learn_trust, note_correction
from roomba.perception.localization.belief.weak_kernels import believe_less, leave_out
from roomba.perception.matching.beams import LidarBeams
from roomba.perception.matching.field_kernels import Field, Place
from roomba.perception.matching.fit_kernels import AGREEING, LOOKED_AT, judge
from roomba.perception.matching.fit_kernels import EVIDENCE as ALL_EVIDENCE
from roomba.perception.matching.fit_kernels import SHORT as ALL_SHORT
from roomba.perception.matching.fit_kernels import THROUGH as ALL_THROUGH
from roomba.perception.matching.match_kernels import beam_ends, fill_lanes, match_in
from roomba.perception.matching.pose_kernels import beyond, seen_from
from roomba.perception.matching.reckoned_path import ReckonedPath, pose_at

_NARROW: Final = np.array([0.10, 0.05, 0.05])
_WIDE: Final = np.array([0.40, 0.30, 0.20, 0.10, 0.05, 0.05])
"""m; beams that end farther off than this lose weight, round by round."""
_STRIDE: Final = 8
"""Stride over the beams that are judged: every eighth of 360 is enough to notice a wrong pose."""
_LEAST_JUDGED: Final = 24
"""Beams that are judged at least, if so many met something: fewer tell too little."""
_MATCHES: Final = 3
"""Matches of a scan at most; each leaves out the beams that the one before left behind walls."""
_OF_MAP: Final = 0.1
"""Share of the newest scan in the estimate of the covariance by the map's errors."""
_OF_WALLS: Final = 0.02
"""Share of new surroundings in the estimate of how far walls are off."""
_LEAST_BEAMS: Final = 50.0
"""Beams from which on it is known how far all walls are off alike."""
_STILL: Final = (0.0005**2, 0.0005**2, 0.0003**2)
"""m2, rad2; added before each match: errors of the map, which more scans do not reduce."""


@entry
def correct(
    beliefs: Rows,
    numbers: Rows,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: NDArray[np.float32],
    now: float,
) -> int:
    """Correct the pose by a scan, float32 [beams], m, taken here; return how many beams ended.

    It came at ``now``, s. Afterwards ``lidar.ends`` has the beams that ended. :func:`is_calm` tells
    whether the pose is still to be trusted.
    """
    belief = beliefs[0]
    count = beam_ends(
        ranges, lidar.directions, lidar.mount, lidar.nearest, lidar.farthest, lidar.ends
    )
    belief.beams = count
    if count > 0:
        belief.seen = now
        match_ends(beliefs, numbers, field, place, lidar.ends, count, lidar.lanes)
        if count >= numbers[0].least_beams:
            judge_ends(beliefs, numbers, field, place, lidar.ends, count, lidar.mount, lidar.lanes)
    return count


@inner_part
def correct_late(
    beliefs: Rows,
    numbers: Rows,
    field: Field,
    place: Place,
    lidar: LidarBeams,
    ranges: NDArray[np.float32],
    path: ReckonedPath,
    stamp: float,
    now: float,
    reckoned: Floats,
) -> int:
    """Correct the pose as :func:`correct` does, by a scan that was taken at ``stamp``, s.

    ``reckoned`` [3] is filled with where ``path`` had the robot then. A scan from before all of
    ``path`` is left out: 0 is returned.
    """
    belief, pose = beliefs[0], beliefs[0].pose
    if not pose_at(path, stamp, reckoned):
        belief.beams = 0
        return 0
    back = seen_from(belief.reckoned, reckoned)
    pose[0], pose[1], pose[2] = beyond(pose[0], pose[1], pose[2], back[0], back[1], back[2])
    count = correct(beliefs, numbers, field, place, lidar, ranges, now)
    on = seen_from(reckoned, belief.reckoned)
    pose[0], pose[1], pose[2] = beyond(pose[0], pose[1], pose[2], on[0], on[1], on[2])
    return count


@entry
def calibrate(beliefs: Rows) -> None:
    """Measure the robot's errors by a scan that was matched, and judged, just now."""
    belief = beliefs[0]
    if not belief.is_judged or belief.is_doubtful:
        drop_window(belief.calibration)
        return
    pose = belief.pose[0], belief.pose[1], belief.pose[2]
    note_pose(belief.calibration, pose, belief.covariance, belief.map_spread)


@entry
def is_calm(beliefs: Rows, numbers: Rows, now: float) -> bool:
    """Whether a known pose is still known, so that kernels alone can go on."""
    belief, known = beliefs[0], numbers[0]
    if belief.is_doubtful or belief.beams == 0 or not now - belief.seen <= known.scan_timeout:
        return False
    is_sure: bool = deviation(belief.covariance) <= min(
        known.known_deviation, known.astray_deviation
    )
    return is_sure


@entry
def deviation(covariance: Floats) -> float:
    """Return the standard deviation along the worst direction of the floor, m; nan is infinite."""
    return _worst(covariance[0, 0], covariance[0, 1], covariance[1, 1])


@part
def place_deviation(beliefs: Rows) -> float:
    """Return that deviation of a belief's position, m, with the errors of the map included."""
    own, of_map = beliefs[0].covariance, beliefs[0].map_spread
    return _worst(own[0, 0] + of_map[0, 0], own[0, 1] + of_map[0, 1], own[1, 1] + of_map[1, 1])


@part
def _worst(xx: float, xy: float, yy: float) -> float:
    variance = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    return math.sqrt(max(0.0, variance)) if variance == variance else math.inf


@allocating_entry
def match_ends(
    beliefs: Rows,
    numbers: Rows,
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    lanes: Floats,
) -> None:
    """Move the pose to where beams' ends, [n, 4], fit best; ``lanes`` is [BEHIND_LANES, n]."""
    belief = beliefs[0]
    pose, covariance, before = belief.pose, belief.covariance, belief.unmatched
    for row in range(3):
        before[row] = pose[row]
        for column in range(3):
            belief.unmatched_covariance[row, column] = covariance[row, column]
    scales = _WIDE if _is_unsure(belief.unmatched_covariance, numbers[0]) else _NARROW
    variance, work = _beam_variance(numbers[0], place, count), belief.work
    wall_variance = wall_variance_of(belief, place)
    fill_lanes(ends, count, lanes)
    rounds, used, share = 0, count, 1.0
    for number in range(_MATCHES):
        if number > 0:
            left = leave_out_behind(field, place, count, pose, wall_variance, lanes)
            if left == used:
                break
            used, variance = left, _beam_variance(numbers[0], place, left)
        _take_back(belief)
        for row in range(3):
            covariance[row, row] += _STILL[row]
        rounds = match_in(
            field, place, count, before, covariance, scales, variance, pose, work, lanes
        )
    if rounds > 0:
        share = believe_less(belief, field, place, lanes, count, scales[-1], variance)
    note_correction(belief, before)
    if not belief.is_doubtful:
        _note_map_errors(belief, field, place, ends, count, share)
    pose[2] = wrapped(pose[2])


@inner_part
def _is_unsure(covariance: Floats, numbers: Row) -> bool:
    """Whether the pose is so unsure that a scan is matched to surfaces farther away."""
    is_unsure: bool = max(covariance[0, 0], covariance[1, 1]) > numbers.unsure_deviation**2
    return is_unsure


@inner_part
def _take_back(belief: Row) -> None:
    """Reset pose and covariance to what they were before the newest scan was matched."""
    for row in range(3):
        belief.pose[row] = belief.unmatched[row]
        for column in range(3):
            belief.covariance[row, column] = belief.unmatched_covariance[row, column]


@allocating_part
def _note_map_errors(
    belief: Row, field: Field, place: Place, ends: Floats, count: int, share: float
) -> None:
    """Learn of the map's errors from a scan that was just matched.

    ``share`` is what :func:`believe_less` left of its information along the weakest direction.
    """
    spread, told, apart = np.empty((3, 3)), np.empty(4), belief.walls_apart
    wall_variance = wall_variance_of(belief, place)
    unlearned = of_cell(place) * _LEAST_BEAMS / (_LEAST_BEAMS + belief.wall_offset[1])
    if not map_spread(
        field, place, ends, count, belief.pose, wall_variance, unlearned, spread, told
    ):
        return
    if share < 1.0:
        # Along this direction the pose hardly follows the walls, nor, then, their errors.
        leave_out(belief.work[9], share, spread)
    for row in range(3):
        for column in range(3):
            more = spread[row, column] - belief.map_spread[row, column]
            belief.map_spread[row, column] += _OF_MAP * more
    # The same walls from the same place tell nothing new.
    kept = 1.0 - _OF_WALLS * belief.unlike
    for index in range(2):
        belief.wall_offset[index] = kept * belief.wall_offset[index] + belief.unlike * told[index]
        apart[index] = kept * apart[index] + belief.unlike * told[2 + index]
    belief.unlike = 0.0


@inner_part
def _beam_variance(numbers: Row, place: Place, count: int) -> float:
    """Return the variance of a beam, m2.

    It grows if there are few beams: beams that met one thing err together, in later scans as well.
    """
    cell = 0.5 * place[2]
    share = max(1.0, numbers.least_beams / max(count, 1))
    variance: float = (numbers.beam_variance + cell * cell) * share * share
    return variance


@entry
def judge_ends(
    beliefs: Rows,
    numbers: Rows,
    field: Field,
    place: Place,
    ends: Floats,
    count: int,
    mount: Floats,
    lanes: Floats,
) -> None:
    """Judge how well a scan fits the pose, and whether scans fit much worse than usual.

    The correction by a scan that hardly fits is taken back, unless the pose was unsure before.
    """
    belief, known = beliefs[0], numbers[0]
    pose, fit, counts = belief.pose, belief.fit, belief.counts
    stride = min(int(_STRIDE), max(1, count // int(_LEAST_JUDGED)))
    judge(field, place, ends, count, pose, mount, stride, counts, lanes)
    looked_at = max(counts[LOOKED_AT], 1.0)
    fit[AGREE], fit[SHORT] = counts[AGREEING] / looked_at, counts[ALL_SHORT] / looked_at
    fit[THROUGH], fit[EVIDENCE] = counts[ALL_THROUGH] / looked_at, counts[ALL_EVIDENCE]
    if not belief.is_judged:
        trust(beliefs)
    newest, adapting = known.newest_share, known.adapting_share
    belief.agree += newest * (fit[AGREE] - belief.agree)
    belief.through += newest * (fit[THROUGH] - belief.through)
    belief.usual_agree += adapting * (fit[AGREE] - belief.usual_agree)
    belief.usual_through += adapting * (fit[THROUGH] - belief.usual_through)
    belief.is_doubtful = (
        belief.agree < max(known.doubt_agree, belief.usual_agree - known.doubt_worse)
        or belief.through > belief.usual_through + known.doubt_through
    )
    if not belief.is_doubtful:
        learn_trust(belief)
    # The few beams that agree may have met a thing that was moved: it would take the pose along.
    if fit[AGREE] < known.doubt_agree and not _is_unsure(belief.unmatched_covariance, known):
        _take_back(belief)


@entry
def trust(beliefs: Rows) -> None:
    """Use the newest fit as the usual one."""
    belief = beliefs[0]
    belief.agree = belief.usual_agree = belief.fit[AGREE]
    belief.through = belief.usual_through = belief.fit[THROUGH]
    belief.is_judged = True
