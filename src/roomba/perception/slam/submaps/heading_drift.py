"""How far a map may be turned against its own beginning: the deviations of submaps' headings.

From one submap to the next the heading drifts, as a random walk over the way: neighbouring scans
err alike, so that matches between neighbours say little. A match with a submap of long ago takes
the drift back. Submaps form a chain, or a net, of such steps; the variance of a heading against the
first one adds up in it as resistances do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats
from roomba.perception.slam.submaps.parts import part_labels
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind

_LEAST_DRIFT: Final = math.radians(0.25)
"""rad per square root of m; least drift, as loop closures of drives with good lidars show it."""
_LONG_AGO: Final = 10.0
"""m; matches between submaps with a shorter way between them say little of the heading."""
_SHORTEST: Final = 0.1
"""m; a shorter way counts as this: the heading drifts on it no less."""


class HeadingDrift(NamedTuple):
    """How unsure the least sure heading of a map is: its standard deviation, rad, and the way, m,
    that was driven before it was seen.
    """

    deviation: float
    way: float


def heading_drift(poses: Floats, ways: Sequence[float], links: Sequence[Link]) -> HeadingDrift:
    """Return the drift of submaps at ``poses``, float64 [n, 3], with ``ways``, m, driven before.

    Submaps that only guesses link to the first one do not count.
    """
    steps = [link for link in links if link.kind is LinkKind.DRIVEN]
    drift = max(_LEAST_DRIFT, _shown_drift(poses, ways, steps))
    breaks = np.ones(len(poses), np.int64)
    breaks[[0, *(step.child for step in steps)]] = 0
    pieces = np.cumsum(breaks)
    held = [link for link in links if _holds(link, ways, pieces)]
    variances = [
        drift**2 * _way_of(link, ways)
        if link.kind is LinkKind.DRIVEN
        else 1.0 / link.information[2, 2]
        for link in held
    ]
    unsure = _variances(len(poses), held, np.array(variances))
    worst = int(np.argmax(unsure))
    return HeadingDrift(math.sqrt(float(unsure[worst])), float(ways[worst]))


def _way_of(link: Link, ways: Sequence[float]) -> float:
    return max(ways[link.child] - ways[link.parent], _SHORTEST)


def _holds(link: Link, ways: Sequence[float], pieces: NDArray[np.int64]) -> bool:
    """Whether a link says something of a heading that other ones do not: see ``_LONG_AGO``."""
    if link.kind is not LinkKind.MATCHED:
        return link.kind is not LinkKind.GUESSED
    is_of_one_piece = bool(pieces[link.parent] == pieces[link.child])
    return not is_of_one_piece or _way_of(link, ways) >= _LONG_AGO


def _shown_drift(poses: Floats, ways: Sequence[float], steps: Sequence[Link]) -> float:
    """Return how far the tracked steps deviate from the map: rad per square root of m."""
    if not steps:
        return 0.0
    parents = np.array([step.parent for step in steps])
    turned = poses[parents + 1, 2] - poses[parents, 2]
    off = wrap_angles(turned - np.array([step.relative[2] for step in steps]))
    return math.sqrt(float(np.mean(off**2 / [_way_of(step, ways) for step in steps])))


def _variances(count: int, links: Sequence[Link], variances: Floats) -> Floats:
    """Return the variance of each heading against the first one, rad2, [count].

    It is 0 for submaps to which no link leads.
    """
    laplacian = np.zeros((count, count))
    for link, weight in zip(links, (1.0 / variances).tolist(), strict=True):
        one, other = link.parent, link.child
        laplacian[[one, other], [one, other]] += weight
        laplacian[[one, other], [other, one]] -= weight
    hanging = np.flatnonzero(part_labels(count, links) == 0)[1:]
    result = np.zeros(count)
    result[hanging] = np.diag(np.linalg.inv(laplacian[np.ix_(hanging, hanging)]))
    return result
