"""Main directions of the walls, told from the outlines of where the middle fits.

A grid draws slanted walls as stairs, so that single sides tell nothing; a long part of the
outline that lies along a line does.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.compilation import allocating_entry, inner_part
from roomba.planning.coverage.passes.contours import Chain, outlines

_WINDOW = 150
"""Points of an outline, more than 1.5 m: three steps or more of a wall that is slanted by 6
degrees."""
_BAND = 6.5
"""cells; between two corners of such a wall the outline is 5 off the line through them, on a map of
5 cm, and corners of cells lie off their line by up to one more."""
_STRIDE = 5
"""Points from one window to the next."""
_ALONG = 0.75
"""Of the points of a window: the least length, cells, of a way that leads along a wall."""
_QUARTER = 90
"""degrees; walls at right angles to each other have one direction."""
_NEAR = 4
"""degrees; walls that are nearer to a main direction than this are told to be along it."""
_LEAST_SHARE = 0.2
"""Of all that is straight; walls of fewer make no direction a main one."""
_AXES = math.radians(1.5)
"""A main direction as near to the axes as this is theirs: a room has but few steps then."""


def main_directions(middles: Mask) -> list[float]:
    """Return the angles of walls that are slanted, rad in (-pi / 4, pi / 4], the commonest first.

    ``middles``, bool [rows, columns], is where the middle fits. Walls along the axes, and at right
    angles to each other, are the same: of a home along the axes the list is empty.
    """
    counts = np.zeros(_QUARTER)
    sums = np.zeros((_QUARTER, 2))
    for chain in outlines(middles):
        _count(np.concatenate((chain, chain[: _WINDOW - 1])), counts, sums)
    total, found = counts.sum(), []
    around = np.arange(-_NEAR, _NEAR + 1)
    while counts.any():
        near = (np.argmax(sum(np.roll(counts, step) for step in around)) + around) % _QUARTER
        if counts[near].sum() < _LEAST_SHARE * total:
            break
        along = sums[near].sum(axis=0)
        angle = 0.25 * math.atan2(along[1], along[0])
        if abs(angle) >= _AXES:
            found.append(angle)
        counts[near] = 0.0
    return found


@allocating_entry
def _count(chain: Chain, counts: NDArray[np.float64], sums: NDArray[np.float64]) -> None:
    """Count windows that lie along a line by their whole degrees, int32 [n, 2] of a chain.

    ``sums``, float64 [90, 2], are those of cosine and sine of four times their angles.
    """
    points = chain.astype(np.float64)
    for first in range(0, len(points) - _WINDOW + 1, _STRIDE):
        is_straight, angle = line_along(points, first, _WINDOW, _BAND)
        if is_straight:
            at = math.floor(math.degrees(angle) + 0.5) % _QUARTER
            counts[at] += 1.0
            sums[at, 0] += math.cos(4.0 * angle)
            sums[at, 1] += math.sin(4.0 * angle)


@inner_part
def line_along(
    points: NDArray[np.float64], first: int, window: int, band: float
) -> tuple[bool, float]:
    """Return whether ``window`` points from ``first`` on lie along one line, and its angle, rad.

    Of an outline, float64 [n, 2], which is within ``band`` cells then.
    """
    mean_x, mean_y = 0.0, 0.0
    for at in range(first, first + window):
        mean_x += points[at, 0] / window
        mean_y += points[at, 1] / window
    xx, yy, xy = 0.0, 0.0, 0.0
    for at in range(first, first + window):
        x, y = points[at, 0] - mean_x, points[at, 1] - mean_y
        xx += x * x
        yy += y * y
        xy += x * y
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    cosine, sine = math.cos(angle), math.sin(angle)
    nearest, farthest, begin, end = np.inf, -np.inf, np.inf, -np.inf
    for at in range(first, first + window):
        x, y = points[at, 0] - mean_x, points[at, 1] - mean_y
        along, aside = x * cosine + y * sine, y * cosine - x * sine
        begin, end = min(begin, along), max(end, along)
        nearest, farthest = min(nearest, aside), max(farthest, aside)
    is_straight = end - begin >= _ALONG * window and farthest - nearest <= band
    return is_straight, angle
