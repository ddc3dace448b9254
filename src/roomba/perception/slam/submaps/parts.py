"""Parts of a map that no scan joined to the others, and where they lie on these.

When scans no longer fit, the map goes on in a new piece, where dead reckoning puts it. If the robot
was carried, it is elsewhere, and in the wrong place the beams of the piece go through known walls.
Samples of such a part, some keyframes each, are then searched for on the parts before it, at any
heading. The part is laid where most samples are found, each by itself, if clearly fewer are found
elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.mapping import MappingConfig
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.submaps.places import ClearPlace, clearly_best
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind, composed, inverse, relative_to
from roomba.perception.slam.submaps.submap import Keyframe, Submap, cloud_of, moved

Labels = NDArray[np.int64]

_SHARES: Final = np.linspace(0.2, 0.8, 13)
"""Shares of a beam's length at which it is tested: not beside the robot, nor beside its end."""
_ROW: Final = 1 << 31
"""More cells than any map has in a row."""


class Carried(Enum):
    """How it is known that the robot was carried."""

    TOLD = "its wheels hung in the air"
    SEEN = "scans stopped to fit from one to the next"
    MISSED = "neither scans nor odometry came for long, and then one scan fitted elsewhere"


class FoundPart(NamedTuple):
    """Where a part lies: ``moved`` [3], the pose on the map of the part's former map frame.

    ``parents`` has, by number of a submap of the part, a submap before it that shows the same.
    """

    moved: Floats
    parents: dict[int, int]


class _Found(NamedTuple):
    """A sample that was found: the number of its submap, and where that submap lies then."""

    submap: int
    place: ClearPlace


def part_labels(count: int, links: Sequence[Link]) -> Labels:
    """Return for each of ``count`` submaps the first one of its part, int64 [count].

    Parts are the connected components of the graph without links that are guessed.
    """
    labels = np.arange(count)
    for link in links:
        if link.kind is not LinkKind.GUESSED:
            first, second = labels[link.parent], labels[link.child]
            labels[labels == max(first, second)] = min(first, second)
    return labels


def hanging_on(part: int, labels: Labels, links: Sequence[Link]) -> NDArray[np.bool_]:
    """Return the submaps of a part, and of later parts that are placed by guesses from it."""
    hanging: NDArray[np.bool_] = labels == part
    for link in sorted(links, key=lambda link: link.child):
        # Parts before it stay where they are.
        if link.kind is LinkKind.GUESSED and hanging[link.parent] and labels[link.child] > part:
            hanging |= labels == labels[link.child]
    return hanging


def is_contradicted(
    part: int, labels: Labels, submaps: Sequence[Submap], poses: Floats, config: MappingConfig
) -> bool:
    """Whether a part cannot lie where it is placed, as its beams go through surfaces there."""
    return seen_through(part, labels, submaps, poses, config) > config.parts.seen_through


def seen_through(
    part: int, labels: Labels, submaps: Sequence[Submap], poses: Floats, config: MappingConfig
) -> float:
    """Return the share of a part's beams, 0..1, that go through surfaces of earlier parts."""
    cell, before = config.parts.cell, np.flatnonzero(labels < part).tolist()
    clouds = [moved(submaps[number].cloud, poses[number])[:, :2] for number in before]
    surfaces = np.unique(_cells(np.concatenate(clouds), cell))
    through = [
        _go_through(frame, pose, surfaces, cell)
        for number in np.flatnonzero(labels == part).tolist()
        for frame, pose in zip(
            submaps[number].keyframes, submaps[number].poses(poses[number]), strict=True
        )
    ]
    beams = np.concatenate(through) if through else np.zeros(0, np.bool_)
    return float(beams.mean()) if len(beams) else 0.0


def _go_through(
    frame: Keyframe, pose: Floats, surfaces: NDArray[np.int64], cell: float
) -> NDArray[np.bool_]:
    """Return which beams of a keyframe go through cells with surfaces, bool [n]."""
    ends = moved(frame.points, pose)[:, :2]
    along = pose[:2] + _SHARES[:, None, None] * (ends - pose[:2])
    met: NDArray[np.bool_] = np.isin(_cells(along, cell), surfaces).any(axis=0)
    return met


def _cells(points: Floats, cell: float) -> NDArray[np.int64]:
    """Return a number for the cell of each point, [..., 2], m: parts may be far from each other."""
    cells = np.floor(points / cell).astype(np.int64)
    return np.asarray(cells[..., 0] * _ROW + cells[..., 1])


def found_part(
    part: int, labels: Labels, submaps: Sequence[Submap], poses: Floats, config: MappingConfig
) -> FoundPart | None:
    """Return where a part, by its label, lies on the parts before it; None if that is not clear."""
    before: list[int] = np.flatnonzero(labels < part).tolist()
    samples = _samples(np.flatnonzero(labels == part).tolist(), submaps, config)
    if len(samples) < config.parts.backed:
        return None
    places = clearly_best(
        [cloud for _, cloud in samples],
        [submaps[number] for number in before],
        poses[before],
        config,
        config.windows.likely,
    )
    found = [
        _Found(number, place._replace(submap=before[place.submap]))
        for (number, _), place in zip(samples, places, strict=True)
        if place is not None
    ]
    return _most_agreed(found, poses, config)


def _samples(
    own: list[int], submaps: Sequence[Submap], config: MappingConfig
) -> list[tuple[int, Floats]]:
    """Return samples of some submaps, spread over them: the submap's number, and points in it."""
    most = config.parts.looked_for
    pieces = -(-most // len(own))
    samples = []
    for number in own[:: -(-len(own) // most)]:
        frames = submaps[number].keyframes
        size = max(-(-len(frames) // pieces), config.parts.keyframes)
        for first in range(0, len(frames) - size + 1, size):
            cloud = cloud_of(frames[first : first + size])
            if len(cloud) >= config.link_points:
                samples.append((number, cloud))
    return samples[:: max(1, -(-len(samples) // most))]


def _most_agreed(found: list[_Found], poses: Floats, config: MappingConfig) -> FoundPart | None:
    """Return where most samples place their part, if clearly fewer agree on another place."""
    agrees = np.array(
        [[_agree(one, other, poses, config) for other in found] for one in found], np.bool_
    ).reshape(len(found), len(found))
    best = _largest_group(agrees)
    # The largest group of the other samples:
    rival = _largest_group(agrees & ~best & ~best[:, None])
    if best.sum() < max(config.parts.backed, config.parts.clearer * rival.sum()):
        return None
    group = [each for each, is_in in zip(found, best.tolist(), strict=True) if is_in]
    surest = max(group, key=lambda each: each.place.score)
    moved = composed(surest.place.pose[None], inverse(poses[surest.submap])[None])[0]
    return FoundPart(moved, {each.submap: each.place.submap for each in group})


def _largest_group(agrees: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the samples that agree with the one that most agree with, bool [n]; table [n, n]."""
    if not len(agrees):
        return np.zeros(0, np.bool_)
    group: NDArray[np.bool_] = agrees[int(np.argmax(agrees.sum(axis=1)))]
    return group


def _agree(one: _Found, other: _Found, poses: Floats, config: MappingConfig) -> bool:
    """Whether two samples were found as they lie to each other, but for the drift in the part."""
    step = relative_to(poses[one.submap][None], poses[other.submap][None])
    expected = composed(one.place.pose[None], step)[0]
    backing, drifted = config.backing, config.drift * math.hypot(step[0, 0], step[0, 1])
    way = backing.same_place + drifted
    return not is_apart(other.place.pose, expected, way, backing.same_heading)
