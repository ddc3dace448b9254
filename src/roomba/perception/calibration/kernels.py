"""Compiled calibration: it measures the robot's errors by scans, and corrects odometry by them.

Between two scans that determine the pose well, wheels and gyro measure how the robot moved, and the
scans how the lidar moved. For the right errors the two agree: a Kalman filter finds these errors
(the equations are those of Censi et al. 2013, see :mod:`roomba.perception.calibration.state`). A
measurement that fits badly, because of slip or a push, counts less.
"""

from __future__ import annotations

import math
from typing import Final

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry, inner_part, part
from roomba.perception.calibration.state import (
    AHEAD,
    DRIFT,
    ERRORS,
    GYRO,
    LEFT,
    OF_WHEELS,
    TURN,
    TURNED,
    WAY,
    Row,
)
from roomba.perception.matching.pose_kernels import beyond

_LONGEST: Final = 60.0
"""s; a window that takes longer is dropped: the robot stood meanwhile."""
_FITS: Final = 4.0
"""Squared residual, in variances, up to which a number counts in full; a larger one counts less."""
_FITS_NOT: Final = 100.0
"""Squared residual, in variances, above which a number does not count at all."""
_CALM: Final = 0.3
"""rad/s; while the robot turns faster no window begins or ends. Scans and wheels are reported some
ms apart, and the robot turns in that time: always the same way, so that it does not average out."""
_FINER: Final = 0.25
"""Factor on both thresholds of :func:`_is_due` for an error that is corrected already."""


@entry
def corrected(row: Row, ahead: float, aside: float, turn: float) -> tuple[float, float, float]:
    """Return a step of odometry in the robot's frame, m and rad, without the wheels' errors."""
    if not row.is_applied:
        return ahead, aside, turn
    applied = row.applied
    rolled = _rolled(ahead, aside, turn)
    by_wheels = (1.0 + applied[TURN]) * turn + applied[DRIFT] * rolled
    bend, scale = 0.5 * (by_wheels - turn), 1.0 + applied[WAY]
    creep = 0.25 * applied[DRIFT] * row.base * row.base * turn
    cosine, sine = math.cos(bend), math.sin(bend)
    return (
        scale * (cosine * ahead - sine * aside) + creep,
        scale * (sine * ahead + cosine * aside),
        by_wheels,
    )


@entry
def note_step(row: Row, ahead: float, aside: float, turn: float) -> None:
    """Add a step of odometry, m and rad, that is not corrected yet, to the window."""
    row.newest_turn = turn
    if not row.is_open:
        return
    errors, moved, slopes = row.errors, row.moved, row.slopes
    rolled = _rolled(ahead, aside, turn)
    of_drift = 0.25 * row.base * row.base * turn
    way = (1.0 + errors[WAY]) * rolled + errors[DRIFT] * of_drift
    by_wheels = (1.0 + errors[TURN]) * turn + errors[DRIFT] * rolled
    middle = moved[2] + 0.5 * by_wheels
    cosine, sine = math.cos(middle), math.sin(middle)
    for error in range(OF_WHEELS):
        of_way = rolled if error == WAY else of_drift if error == DRIFT else 0.0
        of_turn = turn if error == TURN else rolled if error == DRIFT else 0.0
        bent = way * (slopes[2, error] + 0.5 * of_turn)
        slopes[0, error] += cosine * of_way - sine * bent
        slopes[1, error] += sine * of_way + cosine * bent
        slopes[2, error] += of_turn
    moved[0] += cosine * way
    moved[1] += sine * way
    moved[2] += by_wheels
    row.way += abs(rolled)
    row.turned += abs(turn)


@entry
def note_gyro(row: Row, turn: float, elapsed: float) -> None:
    """Add the gyro's turn in a step of ``elapsed`` s, rad, less the bias; nan without a gyro."""
    if math.isnan(turn):
        row.has_gyro = False
    else:
        row.gyro += turn
    row.time += elapsed
    row.turning = abs(row.newest_turn) / elapsed if elapsed > 0.0 else 0.0
    row.gyro_bias_variance = min(
        row.gyro_bias_variance + row.bias_walk * elapsed, row.bias * row.bias
    )


@entry
def note_place(
    row: Row, pose: tuple[float, float, float], variance: float, turn_variance: float
) -> None:
    """Take the robot's pose by scans, x, y, theta, and its variances, m2 and rad2."""
    if row.turning > _CALM:
        return
    applied = row.applied
    lidar = beyond(pose[0], pose[1], pose[2], applied[AHEAD], applied[LEFT], applied[TURNED])
    if row.is_open and row.time <= _LONGEST:
        if row.way < row.window_way and row.turned < row.window_turn:
            return
        _measure(row, lidar, variance, turn_variance)
    row.begin[0], row.begin[1], row.begin[2] = lidar
    row.begin_variance[0], row.begin_variance[1] = variance, turn_variance
    row.moved[:] = 0.0
    row.slopes[:] = 0.0
    row.gyro = row.way = row.turned = row.time = 0.0
    row.has_gyro = row.is_open = True


@part
def _rolled(ahead: float, aside: float, turn: float) -> float:
    """Return the way along an arc whose chord is given, m, negative backwards."""
    return math.cos(0.5 * turn) * ahead + math.sin(0.5 * turn) * aside


@entry
def drop_window(row: Row) -> None:
    """Drop the window under way: the pose is not known, or is in another frame from now on."""
    row.is_open = False


@inner_part
def _measure(
    row: Row, lidar: tuple[float, float, float], variance: float, turn_variance: float
) -> None:
    """Correct the errors by the window that ends with the lidar at a pose."""
    begin, work = row.begin, row.work
    slopes, off, unsure, step = work[:4], work[4], work[5], work[6]
    _expect(row, slopes, off)
    away_x, away_y = lidar[0] - begin[0], lidar[1] - begin[1]
    cosine, sine = math.cos(begin[2]), math.sin(begin[2])
    turn = lidar[2] - begin[2]
    off[0] = cosine * away_x + sine * away_y - off[0]
    off[1] = cosine * away_y - sine * away_x - off[1]
    off[2], off[3] = wrapped(turn - off[2]), wrapped(turn - off[3])
    _doubt(row, unsure, variance, turn_variance)
    _forget(row)
    row.windows += 1
    if row.has_gyro:
        _follow_bias(row, off, unsure)
    for number in range(4 if row.has_gyro else 3):
        _correct(row, slopes[number], off[number], unsure[number], step, work[7])
        for other in range(number + 1, 4):
            for error in range(ERRORS):
                off[other] -= slopes[other, error] * step[error]
    _apply(row)


@inner_part
def _expect(row: Row, slopes: Floats, told: Floats) -> None:
    """Fill ``told`` [4] with how the lidar should have moved: ahead, left, turn, turn by the gyro.

    ``slopes`` [4, ERRORS] gets the derivatives of that by the errors.
    """
    errors, moved = row.errors, row.moved
    ahead, left = errors[AHEAD], errors[LEFT]
    cosine, sine = math.cos(moved[2]), math.sin(moved[2])
    back, aside = math.cos(errors[TURNED]), math.sin(errors[TURNED])
    x = moved[0] + (cosine - 1.0) * ahead - sine * left
    y = moved[1] + sine * ahead + (cosine - 1.0) * left
    told[0], told[1] = back * x + aside * y, back * y - aside * x
    told[2], told[3] = moved[2], (1.0 + errors[GYRO]) * row.gyro
    slopes[:] = 0.0
    for error in range(OF_WHEELS):
        turned = row.slopes[2, error]
        by_x = row.slopes[0, error] - (sine * ahead + cosine * left) * turned
        by_y = row.slopes[1, error] + (cosine * ahead - sine * left) * turned
        slopes[0, error], slopes[1, error] = back * by_x + aside * by_y, back * by_y - aside * by_x
        slopes[2, error] = turned
    slopes[0, AHEAD] = back * (cosine - 1.0) + aside * sine
    slopes[1, AHEAD] = back * sine - aside * (cosine - 1.0)
    slopes[0, LEFT] = aside * (cosine - 1.0) - back * sine
    slopes[1, LEFT] = back * (cosine - 1.0) + aside * sine
    slopes[0, TURNED], slopes[1, TURNED] = told[1], -told[0]
    slopes[3, GYRO] = row.gyro


@inner_part
def _doubt(row: Row, unsure: Floats, variance: float, turn_variance: float) -> None:
    """Fill ``unsure`` [4] with the variances of the lidar's measured motion less the expected."""
    way, turned = row.way, row.turned
    of_turn = row.turn_variance * turned
    by_wheels = row.wheel_variance * way + of_turn
    of_place = row.begin_variance[0] + variance + row.begin_variance[1] * way * way
    of_place += by_wheels * way * way / 3.0
    of_heading = row.begin_variance[1] + turn_variance
    # As the robot turned, part of the error of its way ahead is one to the side by now.
    bend = math.sin(0.5 * row.moved[2]) ** 2
    along, across = row.way_variance * way, row.side_variance * way
    unsure[0] = of_place + (1.0 - bend) * along + bend * across
    unsure[1] = of_place + (1.0 - bend) * across + bend * along
    unsure[2] = of_heading + by_wheels
    of_bias = row.gyro_bias_variance * row.time * row.time
    unsure[3] = of_heading + of_turn + of_bias + row.drift_variance * row.time


@inner_part
def _follow_bias(row: Row, off: Floats, unsure: Floats) -> None:
    """Correct the gyro's bias by the gyro's residual; leave in ``off`` what is not due to it.

    The bias wanders while the robot drives. This follows it, though the robot does not stop.
    """
    of_bias = row.gyro_bias_variance * row.time * row.time
    expected = unsure[3] + row.covariance[GYRO, GYRO] * row.gyro * row.gyro
    square = off[3] * off[3] / expected
    if not (square <= _FITS_NOT and row.time > 0.0):
        return
    share = of_bias / (expected * max(1.0, square / _FITS))
    row.gyro_bias -= share * off[3] / row.time
    row.gyro_bias_variance *= 1.0 - share
    off[3] -= share * off[3]
    unsure[3] -= share * of_bias


@inner_part
def _forget(row: Row) -> None:
    """Raise the variances of the errors a little for each metre, up to the prior: robots wear."""
    share = row.way / row.forgetting_way
    for error in range(ERRORS):
        prior, variance = row.prior[error], row.covariance[error, error]
        row.covariance[error, error] += share * max(0.0, prior - variance)


@inner_part
def _correct(
    row: Row, slope: Floats, off: float, unsure: float, step: Floats, reach: Floats
) -> None:
    """Correct the errors by the residual ``off`` of a number; fill ``step`` with the correction."""
    covariance = row.covariance
    of_errors = 0.0
    for error in range(ERRORS):
        reach[error] = 0.0
        for other in range(ERRORS):
            reach[error] += covariance[error, other] * slope[other]
        of_errors += slope[error] * reach[error]
    step[:] = 0.0
    square = off * off / (of_errors + unsure)
    if not square <= _FITS:
        row.outliers += 1
        if not square <= _FITS_NOT:
            return
        unsure *= square / _FITS
    share = 1.0 / (of_errors + unsure)
    for error in range(ERRORS):
        step[error] = share * off * reach[error]
        row.errors[error] += step[error]
    for error in range(ERRORS):
        for other in range(ERRORS):
            covariance[error, other] -= share * reach[error] * reach[other]


@inner_part
def _apply(row: Row) -> None:
    """Correct dead reckoning by the errors that are sure by now; note whether the lidar is due."""
    row.is_lidar_due = False
    for error in range(ERRORS):
        if not _is_due(row, error):
            continue
        if error <= GYRO:
            row.applied[error] = row.errors[error]
            row.is_applied = True
        else:
            row.is_lidar_due = True


@inner_part
def _is_due(row: Row, error: int) -> bool:
    """Whether an error surely differs from the one that is applied, and by enough to matter."""
    applied = row.applied[error]
    off = abs(row.errors[error] - applied)
    # An error that is corrected already is refined in smaller steps.
    share = _FINER if applied != 0.0 else 1.0
    unsure = row.sure * math.sqrt(row.covariance[error, error])
    is_due: bool = off > share * row.least[error] and off > share * unsure
    return is_due


@entry
def apply_lidar(row: Row) -> None:
    """Apply the errors of the lidar's mount that are sure by now."""
    for error in (AHEAD, LEFT, TURNED):
        if _is_due(row, error):
            row.applied[error] = row.errors[error]
    row.is_lidar_due = False
