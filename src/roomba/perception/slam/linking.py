"""Links between submaps: where one lies beside another that was seen before, by matching them."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.match_kernels import invert
from roomba.perception.slam.pose_graph import Link, relative_to
from roomba.perception.slam.submap import Submap
from roomba.perception.slam.surfels import Match, SurfelGrid

Floats = NDArray[np.float64]

_COARSE: Final = np.array([0.3, 0.2, 0.1])
_FINE: Final = np.array([0.05, 0.03])
"""m; scales of a match, far off and near."""
_ROUNDS: Final = 8
_COARSE_REACH: Final = 3
"""Cells of surfels; so far off a link is found at first."""
_COARSE_STRIDE: Final = 3
_BESIDE: Final = 0.15
"""m; two submaps may always lie so far from where they were thought to be."""
_STEP: Final = 0.2
_TURN_STEP: Final = 0.04
"""m, rad; between the places that are tried when the drift may be long."""


class Linker:
    """Matches submaps, one to another."""

    def __init__(self, config: MappingConfig, half_width: float) -> None:
        """Take the numbers, and how far the points of a submap reach, m."""
        self._config = config
        self._grid = SurfelGrid(half_width)

    def links_to(
        self, child: int, last: int, submaps: list[Submap], poses: Floats, links: list[Link]
    ) -> list[Link]:
        """Return the links of a submap to those before ``last`` that lie near."""
        found = []
        ways = _ways(child, poses, links)
        for parent in range(last):
            away = math.hypot(*(poses[parent, :2] - poses[child, :2]))
            if away > self._config.link_radius or parent == child:
                continue
            link = self._link(parent, child, submaps, poses, ways[parent])
            if link is not None:
                found.append(link)
        return found

    def _link(
        self, parent: int, child: int, submaps: list[Submap], poses: Floats, way: float
    ) -> Link | None:
        """Return the link between two submaps that links of ``way`` m in all join already."""
        cloud = submaps[child].cloud
        if len(cloud) < self._config.link_points or not len(submaps[parent].cloud):
            return None
        thought = relative_to(poses[parent : parent + 1], poses[child : child + 1])[0]
        farthest = _BESIDE + self._config.drift * way
        self._grid.clear()
        self._grid.add(submaps[parent].cloud, np.zeros(3))
        best = None
        for start in _starts(thought, farthest):
            match = self._match(cloud, start)
            if match is None or math.hypot(*(match.pose[:2] - thought[:2])) > farthest:
                continue
            if best is None or match.met * match.close > best.met * best.close:
                best = match
            if self._is_good(best):
                break
        if best is None or not self._is_good(best):
            return None
        return Link(parent, child, best.pose, self._information(best))

    def _match(self, cloud: Floats, start: Floats) -> Match | None:
        """Match from far off, then exactly."""
        deviation = self._config.point_deviation
        loose = np.diag([1.0, 1.0, 0.3])
        coarse = self._grid.match(
            cloud, start, loose, _COARSE, deviation,
            rounds=_ROUNDS, reach=_COARSE_REACH, stride=_COARSE_STRIDE,
        )  # fmt: skip
        if coarse is None:
            return None
        return self._grid.match(cloud, coarse.pose, loose, _FINE, deviation, rounds=_ROUNDS)

    def _is_good(self, match: Match) -> bool:
        config = self._config
        enough = match.met * match.asked >= config.link_points
        return enough and match.met >= config.link_met and match.close >= config.link_close

    def _information(self, match: Match) -> Floats:
        """Return how sure a link is: no surer than points of neighbouring beams allow."""
        config = self._config
        least = np.diag([config.least_link_deviation] * 2 + [config.least_link_turn]) ** 2
        information = np.empty((3, 3))
        invert(match.covariance + least, information)
        return information


def _ways(submap: int, poses: Floats, links: list[Link]) -> Floats:
    """Return how long the shortest chains of links are from one submap to each other one, m."""
    joined = np.array([(link.parent, link.child) for link in links], np.int64).reshape(-1, 2)
    away = poses[joined[:, 0], :2] - poses[joined[:, 1], :2]
    ways = np.full(len(poses), np.inf)
    ways[submap] = 0.0
    _shorten(joined, np.hypot(away[:, 0], away[:, 1]), ways)
    return ways


@njit(cache=True, nogil=True, error_model="numpy")
def _shorten(joined: NDArray[np.int64], lengths: Floats, ways: Floats) -> None:
    """Make ``ways`` [n] as short as links between two of them, int64 [m, 2], allow.

    Link by link until nothing changes (Bellman and Ford): chains of links are short.
    """
    has_changed = True
    while has_changed:
        has_changed = False
        for index in range(lengths.size):
            one, other = joined[index, 0], joined[index, 1]
            if ways[one] + lengths[index] < ways[other]:
                ways[other], has_changed = ways[one] + lengths[index], True
            elif ways[other] + lengths[index] < ways[one]:
                ways[one], has_changed = ways[other] + lengths[index], True


def _starts(thought: Floats, farthest: float) -> list[Floats]:
    """Return where to begin: where it was thought to be, and ever farther around it."""
    reach = int(max(0.0, farthest - 2.0 * _BESIDE) / _STEP)
    if reach == 0:
        return [thought]
    shifts = np.arange(-reach, reach + 1) * _STEP
    turns = np.array([0.0, -1.0, 1.0]) * _TURN_STEP
    places = [(float(x), float(y)) for x in shifts for y in shifts]
    # The nearest first: the first that fits is taken, and rooms look alike from afar.
    return [
        thought + np.array([x, y, turn])
        for x, y in sorted(places, key=lambda place: math.hypot(*place))
        for turn in turns
        if math.hypot(x, y) <= farthest
    ]
