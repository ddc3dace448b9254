"""Main directions of the walls, found from the outlines of where the middle fits.

A grid draws slanted walls as stairs, so that single sides of cells tell no direction. A long part
of the outline that lies along a line does.
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
"""cells; width of a line. Between two corners of such a wall the outline is 5 cells off the line
through them, on a map with cells of 5 cm, and corners of cells lie up to one cell more off."""
_STRIDE = 5
"""Points from one window to the next."""
_ALONG = 0.75
"""Factor on the points of a window: a wall's line must be this long, cells, between its ends."""
_QUARTER = 90
"""degrees; walls at right angles to each other have one direction."""
_NEAR = 4
"""degrees; walls that are nearer than this to a main direction count as along it."""
_LEAST_SHARE = 0.2
"""Least share of all straight windows that a main direction must have."""
_AXES = math.radians(1.5)
"""A main direction this near to the axes is taken as along them: a room then has but few steps."""


def main_directions(middles: Mask) -> list[float]:
    """Return the angles of walls that are slanted, rad in (-pi / 4, pi / 4], the commonest first.

    ``middles``, bool [rows, columns], is where the middle fits. Walls at right angles to each other
    have the same direction. Walls along the axes are not slanted: if all are, the list is empty.
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
    """Count the windows of a chain, int32 [n, 2], that lie along a line, by whole degrees.

    ``sums``, float64 [90, 2], gets the sums of cosine and sine of four times their angles.
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

    ``points`` is an outline, float64 [n, 2]; along a line means within ``band`` cells.
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
