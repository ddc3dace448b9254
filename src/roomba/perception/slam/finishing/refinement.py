"""Refinement of all keyframe poses of a finished drive.

Within a submap keyframes lie as they were tracked, with errors of centimetres on noisy lidars. Each
keyframe is therefore matched to groups of keyframes: to the group just before it, and to groups
that were taken nearby on other visits. The matches are links of a sparse pose graph of all
keyframes, which is solved in least squares (Lu and Milios, "Globally consistent range scan
alignment", 1997). The stage runs twice, the second time from the poses of the first.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.perception.slam.finishing.refinement_kernels import Scans, match_to_group, nearby_visits
from roomba.perception.slam.scan_matching.surfels import SurfelGrid
from roomba.perception.slam.scan_matching.tolerances import tolerances_of
from roomba.perception.slam.submaps.pose_graph import Link, optimised, relative_to
from roomba.perception.slam.submaps.submap import Keyframe

Floats = NDArray[np.float64]

_SIZE: Final = 10
_STRIDE: Final = 5
"""Keyframes of a group, and from the first of one to the first of the next."""
_MOST_VISITS: Final = 5
"""Groups of other visits that a keyframe is matched to, at most."""
_ROUNDS: Final = 2
_SETTLED: Final = 0.002
"""m; when no keyframe moved farther, all agree."""
_SCALES: Final = (0.1, 0.05)
"""m; of the first rounds of a match."""
_DRIVEN: Final = np.diag([0.02**-2, 0.02**-2, 0.02**-2])
"""1/m2, 1/rad2; of a step between two keyframes of one submap, if nothing else is known."""


def refined(
    keyframes: list[Keyframe],
    poses: Floats,
    steps: dict[int, Link],
    half_width: float,
    range_deviation: float,
    point_deviation: float,
) -> Floats:
    """Return better poses of all keyframes, float64 [n, 3], m and rad, map frame.

    ``poses``, [n, 3], are the present ones; the first one stays. ``steps`` are the links from one
    keyframe to the next where that is of another submap, by the number of the latter.
    ``half_width``, m, is how far the points of a group reach. The deviations, m, are the standard
    deviations of a range and of a point in a match.
    """
    if len(keyframes) < 2 * _SIZE:
        return poses
    points = [np.asarray(frame.points, np.float64) for frame in keyframes]
    matcher = _GroupMatcher(points, half_width, range_deviation, point_deviation)
    now = poses
    for _ in range(_ROUNDS):
        links = _steps(poses, steps) + matcher.links(now)
        before, now = now, optimised(now, links)
        if np.hypot(*(now - before)[:, :2].T).max() < _SETTLED:
            break
    return now


def _steps(poses: Floats, steps: dict[int, Link]) -> list[Link]:
    """Return the links from each keyframe to the next one, as the drive was followed."""
    relative = relative_to(poses[:-1], poses[1:])
    links = []
    for later in range(1, len(poses)):
        step = steps.get(later)
        information = _DRIVEN if step is None else step.information
        links.append(Link(later - 1, later, relative[later - 1], information, False))
    return links


class _GroupMatcher:
    """Matches keyframes, whose points [n, 4] are given, to groups of others."""

    def __init__(
        self, points: list[Floats], half_width: float, range_deviation: float, deviation: float
    ) -> None:
        self._points = np.concatenate(points)
        self._firsts = np.cumsum([0, *map(len, points)])
        self._grid = SurfelGrid(half_width)
        self._tolerances = tolerances_of(_SCALES, range_deviation, deviation)

    def links(self, poses: Floats) -> list[Link]:
        """Return the links between keyframes that matches at the present poses tell."""
        links, scans = [], Scans(self._points, self._firsts, np.ascontiguousarray(poses))
        for first, frames in _asked(poses).items():
            middle, group = first + _SIZE // 2, np.arange(first, first + _SIZE)
            found, information = np.empty((len(frames), 3)), np.empty((len(frames), 3, 3))
            match_to_group(
                self._grid.arrays, scans, group, middle, np.array(frames), self._tolerances, found,
                information,
            )  # fmt: skip
            for index in np.flatnonzero(np.isfinite(found[:, 0])).tolist():
                links.append(Link(middle, frames[index], found[index], information[index]))
        return links


def _asked(poses: Floats) -> dict[int, list[int]]:
    """Return for groups, by their first keyframe, the keyframes to be matched to them."""
    asked: dict[int, list[int]] = defaultdict(list)
    firsts = np.arange(0, len(poses) - _SIZE + 1, _STRIDE)
    middles = firsts + _SIZE // 2
    visits = np.empty((len(poses), _MOST_VISITS), np.int64)
    nearby_visits(np.ascontiguousarray(poses), middles, visits)
    for frame, groups in enumerate(visits.tolist()):
        before = (frame // _STRIDE - _SIZE // _STRIDE) * _STRIDE
        if before >= 0:
            asked[before].append(frame)
        for group in groups:
            if group >= 0:
                asked[int(firsts[group])].append(frame)
    return asked
