"""Where a map still ends after an exploration: how long its open edges are, and why they stayed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

from roomba.configuration.mission import ExploringConfig
from roomba.geometry import Point, Pose
from roomba.grid import OccupancyMap
from roomba.planning.frontiers.frontiers import lengths_near
from roomba.vocabulary import EdgeReason, OpenEdge

_MOST_TOLD: Final = 3


class GivenUp(NamedTuple):
    """A frontier that was given up; ``place`` is a point on it, m, map frame.

    ``seen_from`` is the least distance from which it was looked at, m; 0 where it shall not be
    looked at again.

    ``was_looked_at``: the robot looked at it from a viewpoint, and it stayed open.
    """

    place: Point
    seen_from: float
    was_looked_at: bool

    def moved(self, moved: Pose) -> GivenUp:
        """Return the same in another frame, in which this one lies at ``moved``."""
        return self._replace(place=moved.place_of(*self.place))


def open_edges(
    occupancy: OccupancyMap,
    given_up: Iterable[GivenUp],
    config: ExploringConfig,
) -> tuple[OpenEdge, ...]:
    """Return the longer frontiers of a map that were ``given_up``, the longest first.

    One frontier is told once. Those shorter than ``config.open_edge`` are left out.
    """
    # Where several places are of one frontier, the first one counts.
    places = sorted(given_up, key=lambda each: not each.was_looked_at)
    lengths = lengths_near(
        occupancy,
        [each.place for each in places],
        config.frontier_radius,
        config.least_unknown,
    )
    edges = [
        OpenEdge(length, *each.place, _reason(each))
        for each, length in zip(places, lengths.tolist(), strict=True)
        if length >= config.open_edge
    ]
    return tuple(sorted(edges, key=lambda edge: -edge.length))


def what_is_not_seen(edges: Sequence[OpenEdge]) -> str:
    """Return where the map still ends, and why; empty where it ends nowhere."""
    if not edges:
        return ""
    told = [
        f"for {edge.length:.1f} m at ({edge.x:.1f}, {edge.y:.1f}) ({edge.reason.value})"
        for edge in edges[:_MOST_TOLD]
    ]
    rest = edges[_MOST_TOLD:]
    if rest:
        length = math.fsum(edge.length for edge in rest)
        told.append(f"for {length:.1f} m at {len(rest)} more")
    return f"the map is open {', '.join(told)}"


def _reason(given_up: GivenUp) -> EdgeReason:
    return EdgeReason.NO_ECHO if given_up.was_looked_at else EdgeReason.NOT_LOOKED_AT
