"""Places all over a map, at any heading, where points fit clearly better than anywhere else."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.scan_matching.correlative import CorrelativeMatcher, is_in_reach
from roomba.perception.slam.submaps.pose_graph import composed
from roomba.perception.slam.submaps.submap import Submap


class ClearPlace(NamedTuple):
    """A pose [3], map frame, how likely points are there, 0..1, and the submap they fit to."""

    pose: Floats
    score: float
    submap: int


def clearly_best(
    clouds: Sequence[Floats],
    submaps: Sequence[Submap],
    poses: Floats,
    mapping: MappingConfig,
    least: float,
) -> list[ClearPlace | None]:
    """Return for each cloud, [n, 4], the place where it fits clearly better than in all others.

    ``poses`` [m, 3] are those of the submaps. The place is None if the cloud's mean likelihood is
    nowhere more than ``least``, 0..1, or if another place is nearly as good.
    """
    config, reach = mapping.relocation, mapping.search_reach
    found: list[list[ClearPlace]] = [[] for _ in clouds]
    for number, submap in enumerate(submaps):
        if not len(submap.cloud) or not is_in_reach(submap.cloud, reach):
            continue
        # One at a time: each takes some 2 MB.
        matcher = CorrelativeMatcher(submap.cloud, reach)
        for cloud, places in zip(clouds, found, strict=True):
            match = matcher.best(cloud, np.zeros(3), config.window, math.pi, least)
            if match is not None:
                pose = composed(poses[number][None], match.pose[None])[0]
                places.append(ClearPlace(pose, match.score, number))
    return [_clear(places, mapping) for places in found]


def _clear(places: list[ClearPlace], mapping: MappingConfig) -> ClearPlace | None:
    """Return the best of some places, None if another one is nearly as good."""
    if not places:
        return None
    config, best = mapping.relocation, max(places, key=lambda place: place.score)
    others = [
        place.score
        for place in places
        if is_apart(place.pose, best.pose, config.elsewhere_way, config.elsewhere_turn)
    ]
    return best if max(others, default=0.0) <= config.clearly * best.score else None
