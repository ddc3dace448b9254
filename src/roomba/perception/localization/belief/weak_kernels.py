"""Compiled: how much a scan really tells along the direction of which it tells least.

A bare wall tells nothing of the pose along the wall. But the map draws walls in cells, and the
noise of ranges puts ends before and behind the steps between cells, where the nearest surface lies
aside. A match takes the slope of the field at each such end for information, the more so the
farther off the end is: these are a regression's errors in variables (W. Fuller, "Measurement Error
Models", 1987). If the pose is moved, slopes that are noise pull either way, and those of a real
surface pull the pose back. So the pull back is measured, over some scans. The information is then
scaled by the square of the share that pulls back, as that is how it goes into the variance of an
estimate (the sandwich; P. Huber, 1967).
"""

from __future__ import annotations

import math
from typing import Final

from roomba.arrays import Floats
from roomba.compilation import inner_part
from roomba.perception.localization.belief.belief import Row
from roomba.perception.matching.field_kernels import Field, Place
from roomba.perception.matching.match_kernels import add_beams, invert

_SHIFT: Final = 0.02
"""m, rad; how far the pose is moved to either side: so little that the ends still count."""
_OF_SURFACES: Final = 0.5
"""Share of the information that pulls back at real surfaces: ends off surfaces pull back less. In
furnished homes 0.53 to 0.75 of the information pulls back, along bare walls 0.07."""
_NEWEST: Final = 0.1
"""Share of the newest scan in the mean pull: few ends of one scan tell anything along a wall."""
_OF_MEAN: Final = _NEWEST / (2.0 - _NEWEST)
"""Variance of the mean pull, as a share of the variance of a single scan's pull."""
_SURELY: Final = 0.5
"""Deviations that are taken off the mean pull: along a bare wall some ends pull back by chance."""
_LEAST_INFORMATION: Final = 1.0
"""1/m2, 1/rad2; added, so that a direction of which a scan tells nothing is found as well."""
_ROUNDS: Final = 4
"""Of the power method that finds the direction."""

_PULL: Final = 0
_SQUARED: Final = 1
_SEEMING: Final = 2
"""Places in ``pulls`` of a belief."""


@inner_part
def believe_less(
    belief: Row,
    field: Field,
    place: Place,
    lanes: Floats,
    count: int,
    scale: float,
    variance: float,
) -> float:
    """Take back what noise did to a pose that was just matched; return the share that is left.

    Only the weakest direction is changed; it goes to ``belief.work[9]``, of length 1 in m and rad.
    ``lanes``, ``scale``, m, and ``variance``, m2, are those of
    :func:`roomba.perception.matching.match_kernels.match_in` in its last round, which leaves the
    prior's information in ``belief.work[0:3]``.
    """
    pose, covariance, prior, pulls = belief.pose, belief.covariance, belief.unmatched, belief.pulls
    of_prior, information = belief.work[0:3], belief.work[3:6]
    inverse, weak = belief.work[6:9], belief.work[9]
    if not invert(covariance, information):
        return 1.0
    for row in range(3):
        for column in range(3):
            information[row, column] -= of_prior[row, column]
        information[row, row] += _LEAST_INFORMATION
    if not invert(information, inverse):
        return 1.0
    told = _find_weakest(inverse, weak)
    pull = _pull_back(belief, field, place, lanes, count, weak, scale)
    newest = _NEWEST if pulls[_SEEMING] > 0.0 else 1.0
    pulls[_PULL] += newest * (pull - pulls[_PULL])
    pulls[_SQUARED] += newest * (pull * pull - pulls[_SQUARED])
    pulls[_SEEMING] += newest * (told * variance - pulls[_SEEMING])
    unsure = math.sqrt(max(0.0, _OF_MEAN * (pulls[_SQUARED] - pulls[_PULL] * pulls[_PULL])))
    surely = max(0.0, pulls[_PULL] - _SURELY * unsure)
    share: float = min(1.0, surely / (_OF_SURFACES * pulls[_SEEMING]))
    share *= share
    if share == 1.0:
        return 1.0
    less = (1.0 - share) * told
    # Where the match ended, the pull of the beams and that of the prior are in balance.
    pulled = 0.0
    for row in range(3):
        for column in range(3):
            information[row, column] += of_prior[row, column] - less * weak[row] * weak[column]
            pulled += weak[row] * of_prior[row, column] * (pose[column] - prior[column])
    if not invert(information, covariance):
        return 1.0
    for row in range(3):
        for column in range(3):
            pose[row] -= (1.0 - share) * pulled * covariance[row, column] * weak[column]
    return share


@inner_part
def leave_out(weak: Floats, share: float, spread: Floats) -> None:
    """Reduce a covariance's [3, 3] deviation along a direction [3], of length 1, to a share."""
    less = 1.0 - share
    along = 0.0
    for row in range(3):
        for column in range(3):
            along += weak[row] * spread[row, column] * weak[column]
    x = spread[0, 0] * weak[0] + spread[0, 1] * weak[1] + spread[0, 2] * weak[2]
    y = spread[1, 0] * weak[0] + spread[1, 1] * weak[1] + spread[1, 2] * weak[2]
    turn = spread[2, 0] * weak[0] + spread[2, 1] * weak[1] + spread[2, 2] * weak[2]
    crossed = (x, y, turn)
    for row in range(3):
        for column in range(3):
            both = weak[row] * crossed[column] + crossed[row] * weak[column]
            spread[row, column] += less * (less * along * weak[row] * weak[column] - both)


@inner_part
def _find_weakest(inverse: Floats, weak: Floats) -> float:
    """Fill ``weak`` [3] with the direction of least information, and return that information.

    ``inverse`` [3, 3] is the inverse of the information.
    """
    first = 0
    for axis in range(1, 3):
        if inverse[axis, axis] > inverse[first, first]:
            first = axis
    for axis in range(3):
        weak[axis] = inverse[axis, first]
    length = 1.0
    for _ in range(_ROUNDS + 1):
        length = math.sqrt(weak[0] * weak[0] + weak[1] * weak[1] + weak[2] * weak[2])
        x, y, turn = weak[0] / length, weak[1] / length, weak[2] / length
        for axis in range(3):
            weak[axis] = inverse[axis, 0] * x + inverse[axis, 1] * y + inverse[axis, 2] * turn
    length = math.sqrt(weak[0] * weak[0] + weak[1] * weak[1] + weak[2] * weak[2])
    for axis in range(3):
        weak[axis] /= length
    return 1.0 / length


@inner_part
def _pull_back(
    belief: Row, field: Field, place: Place, lanes: Floats, count: int, weak: Floats, scale: float
) -> float:
    """Return how strongly the ends pull back a pose that is moved along ``weak``, in beams.

    An end at a surface that faces along ``weak`` counts as one beam.
    """
    unused, moved, gradient = belief.work[6:9], belief.work[10], belief.work[11]
    for axis in range(3):
        gradient[axis] = 0.0
    for side in (-1.0, 1.0):
        for axis in range(3):
            moved[axis] = belief.pose[axis] + side * _SHIFT * weak[axis]
        add_beams(field, place, lanes, count, moved, scale, side, unused, gradient)
    pull = gradient[0] * weak[0] + gradient[1] * weak[1] + gradient[2] * weak[2]
    return float(pull / (2.0 * _SHIFT))
