"""Compiled dead reckoning: a step by the wheels, with the turn fused from wheels and gyro."""

from __future__ import annotations

import math
from typing import Final

from roomba.angles import wrapped
from roomba.compilation import entry, inner_part, part
from roomba.configuration.body import FASTEST_SPEED
from roomba.perception.calibration.kernels import corrected, note_gyro, note_step
from roomba.perception.calibration.state import GYRO
from roomba.perception.localization.belief.belief import Row, Rows
from roomba.perception.matching.reckoned_path import ReckonedPath, forget_path, remember

LEFT_OUT: Final = 0
WENT_ON: Final = 1
WAS_SET_BACK: Final = 2
"""Results of :func:`reckon`: nothing (the stamp is old); a step; a step over a clock set back."""

_STANDS: Final = 1e-4
"""m and rad; steps of the encoders below this count as standstill."""
SET_BACK: Final = 0.1
"""s; a stamp older than the last one by this is of a clock that was set back."""
_ROUNDING: Final = 1e-6
"""s; margin for the rounding of clocks, so that the same samples count whenever a run begins."""
_UNSEEN: Final = 0.3
"""Deviation of the mean turning speed between two samples, as a share of its change."""


@entry
def reckon(
    beliefs: Rows,
    numbers: Rows,
    stamp: float,
    odometry_x: float,
    odometry_y: float,
    odometry_theta: float,
    turning: float,
) -> int:
    """Go on to the wheels' odometry and the gyro's turning speed, rad/s or nan, at a time.

    Moves the reckoned pose, the pose on the map and its covariance; all numbers but ``turning``
    must be finite. Odometry a little older than the last is left out, and so is a jump. If the
    clock was set back the way still counts, but the time that it took is not known.
    """
    belief, known = beliefs[0], numbers[0]
    since = stamp - belief.stamp
    if -SET_BACK < since <= 0.0:
        return LEFT_OUT
    is_first = belief.stamp == -math.inf
    ahead = aside = turn = 0.0
    if not is_first:
        off_x, off_y = odometry_x - belief.odometry[0], odometry_y - belief.odometry[1]
        cosine, sine = math.cos(belief.odometry[2]), math.sin(belief.odometry[2])
        ahead, aside = cosine * off_x + sine * off_y, cosine * off_y - sine * off_x
        turn = wrapped(odometry_theta - belief.odometry[2])
    if 0.0 < since < math.hypot(ahead, aside) / FASTEST_SPEED - known.jolt:
        # No robot goes as fast: the counter of the wheels was reset.
        ahead = aside = turn = 0.0
    elapsed = since if 0.0 < since <= known.longest_step and not is_first else 0.0
    belief.odometry[0], belief.odometry[1] = odometry_x, odometry_y
    belief.odometry[2], belief.stamp = odometry_theta, stamp
    _go(belief, known, ahead, aside, turn, turning, elapsed)
    return WENT_ON if since > 0.0 else WAS_SET_BACK


@entry
def reckon_on(
    beliefs: Rows,
    numbers: Rows,
    path: ReckonedPath,
    stamp: float,
    odometry_x: float,
    odometry_y: float,
    odometry_theta: float,
    turning: float,
) -> None:
    """Do what :func:`reckon` does, and remember on ``path`` where the robot was."""
    done = reckon(beliefs, numbers, stamp, odometry_x, odometry_y, odometry_theta, turning)
    if done == LEFT_OUT:
        return
    if done == WAS_SET_BACK:
        forget_path(path)
    remember(path, stamp, beliefs[0].reckoned)


@inner_part
def _go(
    belief: Row,
    numbers: Row,
    ahead: float,
    aside: float,
    wheels: float,
    turning: float,
    elapsed: float,
) -> None:
    """Move by a step of the wheels, m and rad, that took ``elapsed``, s; 0 if that is unknown."""
    way = math.hypot(ahead, aside)
    _learn_bias(belief, numbers, way, wheels, turning)
    note_step(belief.calibration, ahead, aside, wheels)
    ahead, aside, wheels = corrected(belief.calibration, ahead, aside, wheels)
    turn, variance = _turn(belief, numbers, way, wheels, turning, elapsed)
    half = 0.5 * (turn - wheels)
    cosine, sine = math.cos(half), math.sin(half)
    ahead, aside = cosine * ahead - sine * aside, sine * ahead + cosine * aside
    compose(belief.reckoned, ahead, aside, turn)
    of_turn = numbers.turn_way_variance * abs(turn)
    of_way = numbers.way_variance * way + of_turn
    of_side = numbers.side_variance * way + of_turn
    belief.spread[0] += of_way
    belief.spread[1] += of_side
    belief.spread[2] += variance
    scale = belief.odometry_scale
    of_way, of_side, variance = scale[0] * of_way, scale[1] * of_side, scale[2] * variance
    carry(belief.pose, belief.covariance, ahead, aside, turn, of_way, of_side, variance)
    _leave_surroundings(belief, numbers, way, turn)


@inner_part
def _leave_surroundings(belief: Row, numbers: Row, way: float, turn: float) -> None:
    """Add the map's errors to the covariance as other walls, with other errors, come in sight.

    The pose that fits the map best is off by the errors of the walls in sight. They are correlated
    over poses that see the same walls (a Gauss-Markov process over way and turn).
    """
    unlike = way / numbers.same_way + abs(turn) / numbers.same_turn
    belief.unlike = min(1.0, belief.unlike + unlike)
    share = min(1.0, 2.0 * unlike)
    for row in range(3):
        for column in range(3):
            belief.covariance[row, column] += share * belief.map_spread[row, column]


@inner_part
def _learn_bias(belief: Row, numbers: Row, way: float, turn: float, turning: float) -> None:
    """Learn the gyro's bias: the mean of what the gyro shows while the wheels stand."""
    if way > _STANDS or abs(turn) > _STANDS or math.isnan(turning):
        belief.still_since, belief.samples = math.inf, 0
        return
    belief.still_since = min(belief.still_since, belief.stamp)
    # Faster than any bias: the robot is being turned by hand.
    is_settling = belief.stamp - belief.still_since < numbers.settling - _ROUNDING
    if is_settling or abs(turning) > 5.0 * numbers.worst_bias:
        return
    belief.samples += 1
    bias = belief.bias + belief.calibration.gyro_bias
    belief.bias += (turning - bias) / (belief.samples + 20.0)


@inner_part
def _turn(
    belief: Row, numbers: Row, way: float, wheels: float, turning: float, elapsed: float
) -> tuple[float, float]:
    """Return the turn, rad, weighed from wheels and gyro, and its variance, rad2."""
    before, belief.turning = belief.turning, turning
    by_wheels = numbers.wheel_variance * way + numbers.turn_variance * abs(wheels) + 1e-9
    if math.isnan(turning) or elapsed == 0.0:
        note_gyro(belief.calibration, math.nan, elapsed)
        return wheels, by_wheels
    if math.isnan(before):
        before = turning
    bias = belief.bias + belief.calibration.gyro_bias
    gyro = (0.5 * (before + turning) - bias) * elapsed
    note_gyro(belief.calibration, gyro, elapsed)
    gyro *= 1.0 + belief.calibration.applied[GYRO]
    noise = numbers.gyro_noise * elapsed
    # How the turning speed changed between the two samples is not known.
    unseen = _UNSEEN * (turning - before) * elapsed
    by_gyro = noise * noise + numbers.drift_variance * elapsed
    by_gyro += numbers.turn_variance * abs(gyro) + unseen * unseen
    # A difference of the wheels from the gyro may be slip.
    by_wheels += (gyro - wheels) * (gyro - wheels)
    share = by_wheels / (by_wheels + by_gyro)
    return wheels + share * (gyro - wheels), share * by_gyro


@part
def compose(pose: Row, ahead: float, aside: float, turn: float) -> None:
    """Move a pose, float64 [3], by a step in its own frame, m and rad."""
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    pose[0] = pose[0] + cosine * ahead - sine * aside
    pose[1] = pose[1] + sine * ahead + cosine * aside
    pose[2] = wrapped(pose[2] + turn)


@entry
def carry(
    pose: Row,
    covariance: Row,
    ahead: float,
    aside: float,
    turn: float,
    of_way: float,
    of_side: float,
    of_turn: float,
) -> None:
    """Move a pose, float64 [3], and its covariance, [3, 3], by a step in its own frame.

    The three variances of the step are along the robot's axes after it, m2 and rad2.
    """
    x, y = pose[0], pose[1]
    compose(pose, ahead, aside, turn)
    off_x, off_y = pose[0] - x, pose[1] - y
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    xt, yt, tt = covariance[0, 2], covariance[1, 2], covariance[2, 2]
    after_xt, after_yt = xt - off_y * tt, yt + off_x * tt
    xx = covariance[0, 0] - off_y * (xt + after_xt)
    xy = covariance[0, 1] + off_x * after_xt - off_y * yt
    yy = covariance[1, 1] + off_x * (yt + after_yt)
    covariance[0, 0] = xx + cosine * cosine * of_way + sine * sine * of_side
    covariance[0, 1] = covariance[1, 0] = xy + cosine * sine * (of_way - of_side)
    covariance[1, 1] = yy + sine * sine * of_way + cosine * cosine * of_side
    covariance[0, 2] = covariance[2, 0] = after_xt
    covariance[1, 2] = covariance[2, 1] = after_yt
    covariance[2, 2] = tt + of_turn
