"""Links between submaps: the pose of one in the frame of an earlier one, found by matching."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.compilation import entry
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.match_kernels import invert
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher, is_in_reach
from roomba.perception.slam.scan_matching.surfels import Match, SurfelGrid
from roomba.perception.slam.scan_matching.tolerances import Tolerances, tolerances_of
from roomba.perception.slam.submaps.pose_graph import Link, relative_to
from roomba.perception.slam.submaps.submap import Submap

_COARSE: Final = np.array([0.3, 0.2, 0.1])
_FINE: Final = (0.05,)
"""m; scales of the coarse and of the fine match; the last ones follow from the lidar's noise."""
_ROUNDS: Final = 8
_COARSE_REACH: Final = 3
"""Cells of surfels; reach of the coarse match."""
_COARSE_STRIDE: Final = 3
_SAME: Final = 0.005
_SAME_TURN: Final = 0.002
"""m, rad; a link that agrees with the present poses to less than this is not searched for again."""
_KEPT: Final = 40
"""Submaps whose likelihood fields are cached: some 2 MB each."""


class Linker:
    """Matches submaps, one to another."""

    def __init__(self, config: MappingConfig, half_width: float) -> None:
        """Take the configuration, and how far the points of a submap reach, m."""
        self._config = config
        self._grid = SurfelGrid(half_width)
        self._matchers: dict[int, CorrelativeMatcher] = {}
        self.use_noise(0.0)

    def use_noise(self, deviation: float) -> None:
        """Go by the standard deviation of a range, m."""
        self._fine = tolerances_of(_FINE, deviation, self._config.point_deviation)
        self._coarse = Tolerances(_COARSE, self._fine.variance, self._fine.close)

    def forget(self, submap: int) -> None:
        """Drop the cached field of a submap, as its points changed."""
        self._matchers.pop(submap, None)

    def links_to(
        self, child: int, last: int, submaps: list[Submap], poses: Floats, links: list[Link]
    ) -> list[Link]:
        """Return the links of a submap to submaps before ``last`` that lie near.

        A link among ``links`` that agrees with the present poses would only be found again: it is
        kept.
        """
        found = []
        windows, turns = self._windows(child, poses, links)
        known = {each.parent: each for each in links if each.child == child and each.may_be_wrong}
        for parent in self._candidates(child, last, poses, windows):
            link = known.get(parent)
            if link is None or not _is_so(link, poses):
                link = self._link(
                    parent, child, submaps, poses, float(windows[parent]), float(turns[parent])
                )
            if link is not None:
                found.append(link)
        return found

    def link_at(self, parent: int, child: int, submaps: list[Submap], poses: Floats) -> Link | None:
        """Return the link between two submaps that lie about where they are thought to be."""
        windows = self._config.windows
        return self._link(parent, child, submaps, poses, windows.narrow, windows.turn)

    def _windows(self, child: int, poses: Floats, links: list[Link]) -> tuple[Floats, Floats]:
        """Return how far each submap may be off as seen from ``child``, m and rad, [n] each."""
        drift, config = self._config.drift, self._config.windows
        ways, unsure = _ways(child, poses, links, drift, config.hardly)
        away = np.hypot(*(poses[:, :2] - poses[child, :2]).T)
        windows = np.minimum(config.beside + drift * ways + unsure * away, config.widest)
        turns = np.minimum(config.turn_per_metre * windows, config.most_turn)
        return windows, config.turn + turns + unsure

    def _candidates(self, child: int, last: int, poses: Floats, windows: Floats) -> list[int]:
        """Return the submaps before ``last`` that lie near ``child``, and some that may do so."""
        radius, config = self._config.link_radius, self._config.windows
        away = np.hypot(*(poses[:last, :2] - poses[child, :2]).T)
        near = [index for index in np.flatnonzero(away <= radius).tolist() if index != child]
        far: list[int] = []
        maybe = np.flatnonzero((away > radius) & (away <= radius - config.narrow + windows[:last]))
        for index in maybe[np.argsort(away[maybe], kind="stable")].tolist():
            if len(far) == config.most_far:
                break
            if all(abs(index - other) >= config.far_apart for other in (*far, child)):
                far.append(index)
        return sorted(near + far)

    def _link(
        self,
        parent: int,
        child: int,
        submaps: list[Submap],
        poses: Floats,
        window: float,
        turn: float,
    ) -> Link | None:
        """Return the link between two submaps, or None where they do not match well enough.

        They may lie off by ``window``, m, and ``turn``, rad, from where they are thought to be.
        """
        cloud = submaps[child].cloud
        if len(cloud) < self._config.link_points or not len(submaps[parent].cloud):
            return None
        thought = relative_to(poses[parent : parent + 1], poses[child : child + 1])[0]
        start: Floats | None = thought
        narrow = self._config.windows.narrow
        if window > narrow:
            start = self._found(parent, submaps[parent].cloud, cloud, thought, window, turn)
        if start is None:
            return None
        self._grid.clear()
        self._grid.add(submaps[parent].cloud, np.zeros(3))
        match = self._match(cloud, start)
        if match is None or not self._is_good(match):
            return None
        if math.hypot(*(match.pose[:2] - thought[:2])) > max(window, narrow):
            return None
        return Link(parent, child, match.pose, self._information(match))

    def _found(
        self,
        parent: int,
        there: Floats,
        cloud: Floats,
        thought: Floats,
        window: float,
        turn: float,
    ) -> Floats | None:
        """Return the rough pose [3] of ``cloud`` in a submap, found in a wide window, or None."""
        reach, config = self._config.search_reach, self._config.windows
        if not is_in_reach(there, reach):
            return None
        matcher = self._matchers.pop(parent, None) or CorrelativeMatcher(there, reach)
        self._matchers[parent] = matcher
        if len(self._matchers) > _KEPT:
            self._matchers.pop(next(iter(self._matchers)))
        found = matcher.best(cloud, thought, window, turn, config.likely)
        if found is None:
            return None
        may_be_another = window > config.ambiguous
        if may_be_another and not matcher.is_unique(cloud, found, thought, window, turn):
            return None
        return found.pose

    def _match(self, cloud: Floats, start: Floats) -> Match | None:
        """Match coarsely, then finely; None where a pose cannot be told."""
        loose = np.diag([1.0, 1.0, 0.3])
        coarse = self._grid.match(
            cloud, start, loose, self._coarse,
            rounds=_ROUNDS, reach=_COARSE_REACH, stride=_COARSE_STRIDE,
        )  # fmt: skip
        if coarse is None:
            return None
        return self._grid.match(cloud, coarse.pose, loose, self._fine, rounds=_ROUNDS)

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


def _is_so(link: Link, poses: Floats) -> bool:
    """Whether the submaps of a link lie as the link measured."""
    off = relative_to(poses[link.parent][None], poses[link.child][None])[0] - link.relative
    return math.hypot(off[0], off[1]) < _SAME and abs(wrapped(off[2])) < _SAME_TURN


def _ways(
    submap: int, poses: Floats, links: list[Link], drift: float, hardly_known: float
) -> tuple[Floats, Floats]:
    """Return how long the shortest chains of links are from one submap to each other one, m.

    A link with a larger standard deviation than ``hardly_known``, m, counts as a way so long that
    drift makes it as unsure. Also return the sum of such links' deviations of the heading, rad.
    """
    joined = np.array([(link.parent, link.child) for link in links], np.int64).reshape(-1, 2)
    away = poses[joined[:, 0], :2] - poses[joined[:, 1], :2]
    unsure = np.array([link.information[0, 0] for link in links]).reshape(-1) ** -0.5
    turned = np.array([link.information[2, 2] for link in links]).reshape(-1) ** -0.5
    hardly = unsure > hardly_known
    lengths = np.hypot(away[:, 0], away[:, 1]) + np.where(hardly, unsure / drift, 0.0)
    ways, turns = np.full(len(poses), np.inf), np.zeros(len(poses))
    ways[submap] = 0.0
    _shorten(joined, lengths, np.where(hardly, turned, 0.0), ways, turns)
    return ways, turns


@entry
def _shorten(
    joined: NDArray[np.int64], lengths: Floats, unsure: Floats, ways: Floats, turns: Floats
) -> None:
    """Shorten ``ways`` [n] along links, int64 [m, 2], until none is shorter (Bellman-Ford).

    ``turns`` [n] becomes the sum of ``unsure`` [m] along them. Chains of links are short, so that
    few rounds are needed.
    """
    has_changed = True
    while has_changed:
        has_changed = False
        for index in range(lengths.size):
            one, other = joined[index, 0], joined[index, 1]
            if ways[one] + lengths[index] < ways[other]:
                ways[other], has_changed = ways[one] + lengths[index], True
                turns[other] = turns[one] + unsure[index]
            elif ways[other] + lengths[index] < ways[one]:
                ways[one], has_changed = ways[other] + lengths[index], True
                turns[one] = turns[other] + unsure[index]
