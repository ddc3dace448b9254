"""Refinement of all keyframe poses of a finished drive.

Within a submap keyframes lie as they were tracked, with errors of centimetres on noisy lidars. Each
keyframe is therefore matched to groups of keyframes: to the group just before it, and to groups
that were taken nearby on other visits. The matches are links of a sparse pose graph of all
keyframes, which is solved in least squares (Lu and Milios, "Globally consistent range scan
alignment", 1997). The stage runs twice. The second time only those groups are matched to anew
whose keyframes moved against each other.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from roomba.angles import wrap_angles
from roomba.arrays import Floats
from roomba.perception.slam.finishing.refinement_kernels import (
    SIZE,
    Asked,
    Scans,
    match_to_groups,
    nearby_visits,
)
from roomba.perception.slam.scan_matching.surfels import SurfelGrid
from roomba.perception.slam.scan_matching.tolerances import tolerances_of
from roomba.perception.slam.submaps.pose_graph import (
    Link,
    Measurements,
    brought_to_agree,
    relative_to,
)
from roomba.perception.slam.submaps.submap import Keyframe

_STRIDE: Final = 5
"""Keyframes from the first of a group to the first of the next."""
_MOST_VISITS: Final = 5
"""Groups of other visits that a keyframe is matched to, at most."""
_ROUNDS: Final = 2
_SETTLED: Final = np.array([0.002, 0.002, 0.002])
"""m, m, rad; a group is unchanged if no keyframe moved farther than this against its middle one."""
_SCALES: Final = (0.1, 0.05)
"""m; scales of the first rounds of a match."""
_DRIVEN: Final = np.diag([0.02**-2, 0.02**-2, 0.02**-2])
"""1/m2, 1/rad2; information of a step between two keyframes of one submap."""


def refined(
    keyframes: list[Keyframe],
    poses: Floats,
    steps: dict[int, Link],
    half_width: float,
    range_deviation: float,
    point_deviation: float,
) -> Floats:
    """Return better poses of all keyframes, float64 [n, 3], m and rad, map frame.

    ``poses``, [n, 3], are the present ones; the first one stays. ``steps`` are the links from a
    keyframe to the next one if that is of another submap, by the number of the latter keyframe.
    ``half_width``, m, is how far the points of a group reach. The deviations, m, are the standard
    deviations of a range and of a point in a match.
    """
    if len(keyframes) < 2 * SIZE:
        return poses
    points = [np.asarray(frame.points, np.float64) for frame in keyframes]
    matcher = _GroupMatcher(points, poses, half_width, range_deviation, point_deviation)
    now = poses
    for _ in range(_ROUNDS):
        if not matcher.match(now):
            break
        now = brought_to_agree(now, _steps(now, steps).beside(matcher.measurements()))
    return now


def _steps(poses: Floats, steps: dict[int, Link]) -> Measurements:
    """Return the measurements from each keyframe to the next one, as they were tracked."""
    parents = np.arange(len(poses) - 1)
    information = np.broadcast_to(_DRIVEN, (len(parents), 3, 3)).copy()
    for later, step in steps.items():
        information[later - 1] = step.information
    relative = relative_to(poses[:-1], poses[1:])
    return Measurements(parents, parents + 1, relative, information, np.zeros(len(parents), bool))


class _GroupMatcher:
    """Matches keyframes, whose points [n, 4] are given, to groups of others near ``poses``."""

    def __init__(
        self,
        points: list[Floats],
        poses: Floats,
        half_width: float,
        range_deviation: float,
        deviation: float,
    ) -> None:
        self._points = np.concatenate(points)
        self._firsts = np.cumsum([0, *map(len, points)])
        self._grid = SurfelGrid(half_width)
        self._tolerances = tolerances_of(_SCALES, range_deviation, deviation)
        self._asked = _asked(poses)
        count = len(self._asked.frames)
        self._found, self._information = np.full((count, 3), np.nan), np.empty((count, 3, 3))
        self._shapes = np.full((len(self._asked.firsts), SIZE, 3), np.nan)

    def match(self, poses: Floats) -> bool:
        """Match to all groups whose shape changed; return whether there were any."""
        shapes = _shapes(poses, self._asked)
        off = shapes - self._shapes
        off[:, :, 2] = wrap_angles(off[:, :, 2])
        is_due = ~np.all(np.abs(off) < _SETTLED, axis=(1, 2))
        self._shapes[is_due] = shapes[is_due]
        match_to_groups(
            self._grid.arrays,
            Scans(self._points, self._firsts, np.ascontiguousarray(poses)),
            self._asked,
            is_due,
            self._tolerances,
            self._found,
            self._information,
        )
        return bool(is_due.any())

    def measurements(self) -> Measurements:
        """Return the matches as measurements of the keyframes."""
        asked, is_found = self._asked, np.isfinite(self._found[:, 0])
        middles = np.repeat(asked.middles, np.diff(asked.starts))
        return Measurements(
            middles[is_found],
            asked.frames[is_found],
            self._found[is_found],
            self._information[is_found],
            np.ones(np.count_nonzero(is_found), bool),
        )


def _shapes(poses: Floats, asked: Asked) -> Floats:
    """Return the keyframes of groups as seen from the middle ones, float64 [groups, SIZE, 3]."""
    members = (asked.firsts[:, None] + np.arange(SIZE)).ravel()
    relative = relative_to(poses[np.repeat(asked.middles, SIZE)], poses[members])
    return relative.reshape(-1, SIZE, 3)


def _asked(poses: Floats) -> Asked:
    """Return which keyframes are to be matched to which groups."""
    frames = np.arange(len(poses))
    firsts = np.arange(0, len(poses) - SIZE + 1, _STRIDE)
    middles = firsts + SIZE // 2
    visits = np.empty((len(poses), _MOST_VISITS), np.int64)
    nearby_visits(np.ascontiguousarray(poses), middles, visits)
    before = frames // _STRIDE - SIZE // _STRIDE
    groups = np.column_stack((before, visits)).ravel()
    is_one = groups >= 0
    order = np.argsort(groups[is_one], kind="stable")
    starts = np.searchsorted(groups[is_one][order], np.arange(len(firsts) + 1))
    return Asked(firsts, middles, starts, np.repeat(frames, 1 + _MOST_VISITS)[is_one][order])
