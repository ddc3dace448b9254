"""Links between submaps: the pose of one in the frame of an earlier one, found by matching."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.match_kernels import invert
from roomba.perception.slam.correlative import CorrelativeMatcher, is_in_reach
from roomba.perception.slam.follow_kernels import in_plane, last_scale
from roomba.perception.slam.pose_graph import Link, relative_to
from roomba.perception.slam.submap import Submap
from roomba.perception.slam.surfels import Match, SurfelGrid

Floats = NDArray[np.float64]

_COARSE: Final = np.array([0.3, 0.2, 0.1])
_FINE: Final = (0.05,)
"""m; scales of a match, far off and near; the last one is that of the lidar's noise."""
_ROUNDS: Final = 8
_COARSE_REACH: Final = 3
"""Cells of surfels; so far off a link is found at first."""
_COARSE_STRIDE: Final = 3
_BESIDE: Final = 0.15
"""m; two submaps may always lie so far from where they were thought to be."""
_NARROW: Final = 0.35
"""m; in a window that is no wider points find their surfaces by themselves."""
_WIDEST: Final = 6.0
"""m; the widest window that is searched."""
_TURN: Final = 0.1
_TURN_PER_METRE: Final = 0.15
"""rad, and rad/m; how much two submaps may be turned, by the width of the window."""
_LIKELY: Final = 0.45
"""Mean likelihood of points, 0..1, from which a pose of a wide window is looked at closely."""
_HARDLY: Final = 0.3
"""m; a link with a larger standard deviation was made without a scan that confirmed it."""
_KEPT: Final = 40
"""Submaps whose grids of likelihoods are kept: some 2 MB each."""


class Linker:
    """Matches submaps, one to another."""

    def __init__(self, config: MappingConfig, half_width: float) -> None:
        """Take the numbers, and how far the points of a submap reach, m."""
        self._config = config
        self._grid = SurfelGrid(half_width)
        self._matchers: dict[int, CorrelativeMatcher] = {}
        self._scale = np.array([_FINE[0], last_scale(0.0)])
        self._in_plane = in_plane(0.0)

    def use_noise(self, deviation: float) -> None:
        """Go by the standard deviation of a range, m."""
        self._scale = np.array([_FINE[0], last_scale(deviation)])
        self._in_plane = in_plane(deviation)

    def forget(self, submap: int) -> None:
        """Drop what is kept of a submap whose points changed."""
        self._matchers.pop(submap, None)

    def links_to(
        self, child: int, last: int, submaps: list[Submap], poses: Floats, links: list[Link]
    ) -> list[Link]:
        """Return the links of a submap to those before ``last`` that lie near."""
        found = []
        ways = _ways(child, poses, links, self._config.drift)
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
        """Return the link between two submaps, or None where they do not match well enough.

        ``way`` is the length of the shortest chain of links between them, m: over it they drifted.
        """
        cloud = submaps[child].cloud
        if len(cloud) < self._config.link_points or not len(submaps[parent].cloud):
            return None
        thought = relative_to(poses[parent : parent + 1], poses[child : child + 1])[0]
        window = min(_BESIDE + self._config.drift * way, _WIDEST)
        start: Floats | None = thought
        if window > _NARROW:
            start = self._found(parent, submaps[parent].cloud, cloud, thought, window)
        if start is None:
            return None
        self._grid.clear()
        self._grid.add(submaps[parent].cloud, np.zeros(3))
        match = self._match(cloud, start)
        if match is None or not self._is_good(match):
            return None
        if math.hypot(*(match.pose[:2] - thought[:2])) > max(window, _NARROW):
            return None
        return Link(parent, child, match.pose, self._information(match))

    def _found(
        self, parent: int, there: Floats, cloud: Floats, thought: Floats, window: float
    ) -> Floats | None:
        """Return roughly the pose [3] of points in a submap, found in a wide window, or None."""
        if not is_in_reach(there):
            return None
        matcher = self._matchers.pop(parent, None) or CorrelativeMatcher(there)
        self._matchers[parent] = matcher
        if len(self._matchers) > _KEPT:
            self._matchers.pop(next(iter(self._matchers)))
        turn = _TURN + _TURN_PER_METRE * window
        found = matcher.best(cloud, thought, window, turn, _LIKELY)
        return None if found is None else found.pose

    def _match(self, cloud: Floats, start: Floats) -> Match | None:
        """Match coarsely, then finely; None where a pose cannot be told."""
        deviation = self._config.point_deviation
        loose = np.diag([1.0, 1.0, 0.3])
        coarse = self._grid.match(
            cloud, start, loose, _COARSE, deviation, self._in_plane,
            rounds=_ROUNDS, reach=_COARSE_REACH, stride=_COARSE_STRIDE,
        )  # fmt: skip
        if coarse is None:
            return None
        return self._grid.match(
            cloud, coarse.pose, loose, self._scale, deviation, self._in_plane, rounds=_ROUNDS
        )

    def _is_good(self, match: Match) -> bool:
        config = self._config
        enough = match.met * match.asked >= config.link_points
        return enough and match.met >= config.link_met and match.close >= config.link_close

    def _information(self, match: Match) -> Floats:
        """Return the information matrix of a link, limited since neighbouring beams err alike."""
        config = self._config
        least = np.diag([config.least_link_deviation] * 2 + [config.least_link_turn]) ** 2
        information = np.empty((3, 3))
        invert(match.covariance + least, information)
        return information


def _ways(submap: int, poses: Floats, links: list[Link], drift: float) -> Floats:
    """Return how long the shortest chains of links are from one submap to each other one, m.

    A link that is hardly known counts as the way over which as much drift comes about.
    """
    joined = np.array([(link.parent, link.child) for link in links], np.int64).reshape(-1, 2)
    away = poses[joined[:, 0], :2] - poses[joined[:, 1], :2]
    unsure = np.array([link.information[0, 0] for link in links]).reshape(-1) ** -0.5
    lengths = np.hypot(away[:, 0], away[:, 1]) + np.where(unsure > _HARDLY, unsure / drift, 0.0)
    ways = np.full(len(poses), np.inf)
    ways[submap] = 0.0
    _shorten(joined, lengths, ways)
    return ways


@njit(cache=True, nogil=True, error_model="numpy")
def _shorten(joined: NDArray[np.int64], lengths: Floats, ways: Floats) -> None:
    """Shorten ``ways`` [n] along links, int64 [m, 2], until none is shorter (Bellman-Ford).

    Chains of links are short, so that few rounds are needed.
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
