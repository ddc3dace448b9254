"""Parts of a map that no scan joined: found on the rest where that is clear, and only there."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, points_of, row
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.submaps import parts
from roomba.perception.slam.submaps.parts import found_part, hanging_on, part_labels
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind
from roomba.perception.slam.submaps.submap import Keyframe, Submap
from roomba.perception.slam.submaps.submap_graph import SubmapGraph
from roomba.world.home.home import Home

CONFIG, LOCALIZATION = MappingConfig(), LocalizationConfig()
ALIKE = room_home(8.2, 4.0, ((4.0, 0.0, 4.2, 4.0), (3.0, 3.4, 4.0, 4.0), (7.2, 3.4, 8.2, 4.0)))
"""Two rooms that look the same."""
CARRIED = Pose(2.5, -1.0, 1.9)
"""Where the frame of a part truly lies in that in which it is thought to lie."""


def link(parent: int, child: int, *, guessed: bool = False) -> Link:
    return Link(
        parent, child, np.zeros(3), np.eye(3), LinkKind.GUESSED if guessed else LinkKind.DRIVEN
    )


def submap(at: Pose, home: Home, frames: int = 10) -> Submap:
    """Scans on an arc of 1 m from a pose on."""
    eye, random = Eye(home), np.random.default_rng(0)
    made = Submap(0.0)
    for step in range(frames):
        inner = Pose(0.1 * step, 0.05 * step, 0.1 * step)
        points = points_of(eye.scan(at.compose(inner), random))
        made.keyframes.append(Keyframe(points.astype(np.float32), row(inner)))
    made.close(1500)
    return made


def seen(poses: list[Pose], home: Home, thought: Pose) -> tuple[list[Submap], NDArray[np.float64]]:
    """Submaps at poses, and where they are thought to lie by one who thinks to be elsewhere."""
    rows = np.array([row(thought.inverse().compose(pose)) for pose in poses])
    return [submap(pose, home) for pose in poses], rows


def test_links_that_scans_made_hold_parts_together() -> None:
    links = [link(0, 1), link(1, 2, guessed=True), link(2, 3), link(3, 4, guessed=True)]
    assert part_labels(5, links).tolist() == [0, 0, 2, 2, 4]
    assert part_labels(5, [*links, link(0, 4)]).tolist() == [0, 0, 2, 2, 0]
    assert part_labels(5, [*links, link(0, 3)]).tolist() == [0, 0, 0, 0, 4]
    assert part_labels(1, []).tolist() == [0]


def test_what_hangs_on_a_part_does_so_by_guesses_and_never_what_is_before_it() -> None:
    # Carried at 2, put back at 4; 5 hangs on what is before, 6 on the carried one.
    links = [
        *(link(0, 1), link(1, 2, guessed=True), link(2, 3), link(3, 4, guessed=True)),
        *(link(0, 4), link(4, 5, guessed=True), link(3, 6, guessed=True)),
    ]
    labels = part_labels(7, links)
    assert labels.tolist() == [0, 0, 2, 2, 0, 5, 6]
    assert np.flatnonzero(hanging_on(2, labels, links)).tolist() == [2, 3, 6]
    assert np.flatnonzero(hanging_on(5, labels, links)).tolist() == [5]


def test_a_part_is_found_where_it_truly_lies() -> None:
    known, at = seen([Pose(1.0, 1.0, 0.5), Pose(2.4, 1.6, 2.0)], FURNISHED, Pose())
    part, thought = seen([Pose(1.4, 2.0, -1.0), Pose(3.0, 1.2, 0.5)], FURNISHED, CARRIED)
    labels, poses = np.array([0, 0, 2, 2]), np.vstack((at, thought))
    found = found_part(2, labels, known + part, poses, CONFIG)
    assert found is not None
    assert not is_apart(found.moved, row(CARRIED), 0.1, 0.05)
    assert set(found.parents) == {2, 3}
    assert set(found.parents.values()) <= {0, 1}


@pytest.mark.parametrize(
    ("home", "why"), [(ALIKE, "two rooms look the same"), (FURNISHED, "it is of another home")]
)
def test_a_part_that_fits_nowhere_or_in_two_rooms_is_not_found(home: Home, why: str) -> None:
    known, at = seen([Pose(1.5, 2.0, 0.0), Pose(5.7, 2.0, 0.0)], ALIKE, Pose())
    part, thought = seen([Pose(1.4, 1.0, 1.0), Pose(2.0, 1.4, 0.5)], home, CARRIED)
    labels, poses = np.array([0, 0, 2, 2]), np.vstack((at, thought))
    assert found_part(2, labels, known + part, poses, CONFIG) is None, why


def test_a_part_of_which_there_is_little_is_not_found() -> None:
    known, at = seen([Pose(1.0, 1.0, 0.5), Pose(2.4, 1.6, 2.0)], FURNISHED, Pose())
    short = submap(Pose(1.4, 2.0, -1.0), FURNISHED, 2 * CONFIG.parts.keyframes)
    poses = np.vstack((at, np.zeros(3)))
    assert found_part(2, np.array([0, 0, 2]), [*known, short], poses, CONFIG) is None


def test_the_graph_lays_a_part_and_what_hangs_on_it_where_it_was_found() -> None:
    graph = SubmapGraph(CONFIG, LOCALIZATION, row(Pose(1.0, 1.0, 0.5)))
    graph.use_reach(16.0)
    known, at = seen([Pose(1.0, 1.0, 0.5), Pose(2.4, 1.6, 2.0)], FURNISHED, Pose())
    part, thought = seen([Pose(1.4, 2.0, -1.0), Pose(3.0, 1.2, 0.5)], FURNISHED, CARRIED)
    last = row(CARRIED.inverse().compose(Pose(3.2, 1.4, 0.9)))
    graph.submaps, graph.poses = [*known, *part, Submap(9.0)], np.vstack((at, thought, last))
    graph.submaps[-1].keyframes = part[0].keyframes[:1]
    for number, each in enumerate(graph.submaps):
        each.way = 2.0 * number
    graph.links = [
        Link(
            one,
            one + 1,
            row(relative(graph.poses, one)),
            np.diag([weight, weight, 1e4]),
            LinkKind.GUESSED if weight < 1e4 else LinkKind.DRIVEN,
        )
        for one, weight in enumerate((1e4, 4.0, 1e4, 4.0))
    ]
    assert graph.ways_apart(9.0) == pytest.approx([4.0, 1.0])
    graph.join_parts()
    # The robot was not carried: however like another place it looks, the part stays.
    assert graph.laid == 0
    assert np.array_equal(graph.poses[2:4], thought)
    # Nor where it seems to have been carried, and all could be where it is thought to be.
    graph._carried_to[2] = False
    far = graph.poses.copy()
    graph.poses[2:] += (30.0, 0.0, 0.0)
    graph.join_parts()
    assert graph.laid == 0
    graph.poses = far
    graph.join_parts()
    assert graph.laid == 1
    assert graph.ways_apart(9.0) == pytest.approx([1.0])
    true = [Pose(1.4, 2.0, -1.0), Pose(3.0, 1.2, 0.5), Pose(3.2, 1.4, 0.9)]
    for pose, expected in zip(graph.poses[2:], true, strict=True):
        assert not is_apart(pose, row(expected), 0.03, 0.02)
    assert np.array_equal(graph.poses[0], at[0])


def relative(poses: NDArray[np.float64], one: int) -> Pose:
    """Return where the next submap lies in this one."""
    return Pose(*poses[one].tolist()).inverse().compose(Pose(*poses[one + 1].tolist()))


def test_no_more_samples_are_looked_for_than_that() -> None:
    for count in range(1, 12):
        submaps = [submap(Pose(1.0, 1.0, 0.3 * number), FURNISHED, 40) for number in range(2)]
        several = (submaps * count)[:count]
        samples = parts._samples(list(range(count)), several, CONFIG)
        assert CONFIG.parts.backed <= len(samples) <= CONFIG.parts.looked_for


def test_parts_without_a_scan_are_none() -> None:
    graph = SubmapGraph(CONFIG, LOCALIZATION, np.zeros(3))
    graph.submaps[0].keyframes = submap(Pose(1.0, 1.0, 0.5), FURNISHED, 1).keyframes
    graph.begin_piece(np.zeros(3), 1.0, 0.0, 0.0)
    assert graph.ways_apart(1.0) == []


def test_a_part_is_contradicted_where_surfaces_stand_on_the_way() -> None:
    known, at = seen([Pose(1.0, 1.0, 0.5), Pose(2.4, 1.6, 2.0)], FURNISHED, Pose())
    labels = np.array([0, 0, 2, 2])
    for thought, contradicted in ((Pose(), False), (CARRIED, True), (Pose(-30.0), False)):
        part, there = seen([Pose(1.4, 2.0, -1.0), Pose(3.0, 1.2, 0.5)], FURNISHED, thought)
        poses = np.vstack((at, there))
        assert parts.is_contradicted(2, labels, known + part, poses, CONFIG) is contradicted


def test_where_nothing_was_seen_nothing_is_seen_through() -> None:
    whole, blind = submap(Pose(1.0, 1.0, 0.5), FURNISHED), Submap(0.0)
    labels, poses = np.array([0, 1]), np.zeros((2, 3))
    assert parts.seen_through(1, labels, [blind, whole], poses, CONFIG) == 0.0
    assert parts.seen_through(1, labels, [whole, blind], poses, CONFIG) == 0.0


def test_a_map_in_one_part_stays_as_it_is() -> None:
    graph = SubmapGraph(CONFIG, LOCALIZATION, np.zeros(3))
    graph.begin(np.array([1.0, 0.0, math.pi / 2]), 1.0)
    before = graph.poses.copy()
    graph.join_parts()
    assert np.array_equal(graph.poses, before)
    assert graph.ways_apart(3.0) == []
