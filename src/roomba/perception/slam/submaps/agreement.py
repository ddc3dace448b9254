"""Loop closures that need backing by others: links that would move a part of the map far.

In a building of rooms and corridors that look alike, one match says little about where a submap is.
The next submap, seen from elsewhere, must be found in a place that agrees with it.
"""

from __future__ import annotations

import math

from roomba.angles import wrapped
from roomba.arrays import Floats
from roomba.configuration.mapping import BackingConfig
from roomba.perception.slam.submaps.pose_graph import Link, composed, relative_to


def is_far(link: Link, poses: Floats, config: BackingConfig) -> bool:
    """Whether a link would move its child far, the submaps lying at ``poses``, [n, 3]."""
    here = _told(link, poses)
    return math.hypot(*(here[:2] - poses[link.child, :2])) > config.far


def is_backed(link: Link, others: list[Link], poses: Floats, config: BackingConfig) -> bool:
    """Whether another submap, near in time, was found where it must lie if this link is right."""
    moved = _told(link, poses)
    for other in others:
        if not 0 < abs(other.child - link.child) <= config.neighbours:
            continue
        step = relative_to(poses[link.child][None], poses[other.child][None])
        expected = composed(moved[None], step)[0]
        off = _told(other, poses) - expected
        is_there = math.hypot(off[0], off[1]) < config.same_place
        if is_there and abs(wrapped(off[2])) < config.same_heading:
            return True
    return False


def _told(link: Link, poses: Floats) -> Floats:
    """Return where a link says that its child lies, [3], map frame."""
    told: Floats = composed(poses[link.parent][None], link.relative[None])[0]
    return told
