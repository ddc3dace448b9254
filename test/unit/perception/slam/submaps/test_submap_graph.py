"""Submaps and where they lie, against angles and lengths reckoned one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.perception.slam.finishing.finish import align_axes
from roomba.perception.slam.submaps.pose_graph import LinkKind
from roomba.perception.slam.submaps.submap import KeptSubmap, Keyframe
from roomba.perception.slam.submaps.submap_graph import SubmapGraph

Floats = NDArray[np.float64]
Pose = tuple[float, float, float]

POSES = st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), st.floats(-3.1, 3.1))
MAPPING, LOCALIZATION = MappingConfig(), LocalizationConfig()


def placed(parent: Pose, relative: Pose) -> complex:
    """Where a pose in another's frame lies: its place as a complex number."""
    turn = complex(math.cos(parent[2]), math.sin(parent[2]))
    return complex(parent[0], parent[1]) + turn * complex(relative[0], relative[1])


def assert_same(found: Floats, place: complex, theta: float) -> None:
    assert complex(found[0], found[1]) == pytest.approx(place)
    assert math.cos(found[2] - theta) == pytest.approx(1.0)


def keyframe(pose: Pose, *points: tuple[float, float]) -> Keyframe:
    """A scan of points that face along x."""
    rows = [(x, y, 1.0, 0.0) for x, y in points]
    return Keyframe(np.array(rows, np.float32).reshape(-1, 4), np.array(pose))


@given(POSES, st.lists(st.tuples(POSES, st.floats(0.0, 5.0)), min_size=1, max_size=4))
@settings(max_examples=examples(60))
def test_each_submap_begins_where_the_one_before_says_and_is_tied_to_it(
    start: Pose, steps: list[tuple[Pose, float]]
) -> None:
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.array(start))
    here, way = start, 0.0
    for number, (relative, driven) in enumerate(steps):
        place, theta = placed(here, relative), here[2] + relative[2]
        assert_same(graph.placed(np.array(relative)), place, theta)
        way += driven
        graph.begin(np.array(relative), way)
        here = (place.real, place.imag, theta)
        assert_same(graph.poses[-1], place, theta)
        link = graph.links[-1]
        assert (link.parent, link.child, link.kind) == (number, number + 1, LinkKind.DRIVEN)
        assert tuple(link.relative) == relative
        # What was driven grows unsure with its square root, but never sure of everything.
        sure = 1.0 / (LOCALIZATION.way_noise**2 * max(driven, 0.1))
        assert link.information[0, 0] == pytest.approx(sure)
    assert len(graph.submaps) == len(graph.poses) == len(steps) + 1
    assert graph.newest is graph.submaps[-1]


@given(POSES, st.lists(POSES, min_size=1, max_size=4), POSES)
@settings(max_examples=examples(60))
def test_a_place_that_was_told_is_tied_to_the_submap_nearest_to_it(
    start: Pose, steps: list[Pose], told: Pose
) -> None:
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.array(start))
    for relative in steps:
        graph.begin(np.array(relative), 1.0)
    poses = graph.poses.copy()
    graph.begin_at(np.array(told), 2.0)
    assert tuple(graph.poses[-1]) == told
    link = graph.links[-1]
    away = [math.dist(pose[:2], told[:2]) for pose in poses.tolist()]
    assert away[link.parent] == min(away)
    assert (link.child, link.kind) == (len(poses), LinkKind.TOLD)
    x, y, theta = poses[link.parent].tolist()
    assert placed((x, y, theta), tuple(link.relative.tolist())) == pytest.approx(
        complex(told[0], told[1])
    )


@given(st.lists(POSES, min_size=1, max_size=4), POSES)
@settings(max_examples=examples(40))
def test_near_submaps_are_those_within_the_radius_of_links(steps: list[Pose], at: Pose) -> None:
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.zeros(3))
    for relative in steps:
        graph.begin(np.array(relative), 1.0)
    expected = [
        number
        for number, pose in enumerate(graph.poses.tolist())
        if math.dist(pose[:2], at[:2]) < MAPPING.link_radius
    ]
    assert graph.near(np.array(at)) == expected


@given(st.lists(POSES, min_size=2, max_size=4), POSES)
@settings(max_examples=examples(40))
def test_keyframes_lie_where_their_submap_and_they_in_it_do(
    frames: list[Pose], second: Pose
) -> None:
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.array([0.5, -0.2, 0.3]))
    kept = (
        KeptSubmap(0.0, tuple(keyframe(pose) for pose in frames)),
        KeptSubmap(3.0, (keyframe((0.1, 0.2, 0.3)),)),
    )
    poses = np.array([(0.5, -0.2, 0.3), second])
    graph.take_over(kept, poses, ())
    found = [pose for _, pose in graph.keyframes()]
    owners: list[Pose] = [(0.5, -0.2, 0.3)] * len(frames) + [second]
    for pose, owner, own in zip(found, owners, [*frames, (0.1, 0.2, 0.3)], strict=True):
        assert_same(pose, placed(owner, own), owner[2] + own[2])
    beside = [pose for _, pose in graph.keyframes_beside([0])]
    assert len(beside) == len(frames)
    for pose, own in zip(beside, frames, strict=True):
        # Seen from the newest submap it lies where it lies on the map.
        x, y, theta = pose.tolist()
        assert placed(second, (x, y, theta)) == pytest.approx(placed((0.5, -0.2, 0.3), own))


@pytest.mark.parametrize(("turn", "left"), [(0.0, 0.0), (0.05, 0.0), (-0.06, 0.0), (0.3, 0.3)])
def test_squaring_turns_walls_along_the_axes_and_keeps_submaps_together(
    turn: float, left: float
) -> None:
    """Two submaps see the same two walls at right angles, askew by ``turn``: or oblique by design.

    All turn around the first one.
    """
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.array([0.5, 0.0, turn]))
    rows = [(1.0, 0.01 * n, 1.0, 0.0) for n in range(150)]
    rows += [(0.01 * n, 1.5, 0.0, -1.0) for n in range(150)]
    frame = Keyframe(np.array(rows, np.float32), np.zeros(3))
    poses = np.array([(0.5, 0.0, turn), (0.5, 0.0, turn), (1.5, 2.0, turn)])
    whole = KeptSubmap(0.0, (frame,))
    graph.take_over((whole, whole, KeptSubmap(0.0, ())), poses, ())
    align_axes(graph, 0.05, math.radians(MAPPING.oblique))
    assert graph.poses[0, :2].tolist() == [0.5, 0.0]
    assert graph.poses[:, 2] == pytest.approx([left] * 3, abs=0.001)
    away = complex(*graph.poses[2, :2]) - 0.5
    assert away == pytest.approx(complex(1.0, 2.0) * np.exp(-1.0j * (turn - left)), abs=0.01)


def test_what_was_driven_is_as_unsure_as_the_odometry_of_that_time() -> None:
    graph = SubmapGraph(MAPPING, LOCALIZATION, np.zeros(3))
    graph.begin(np.array([1.0, 0.0, 0.0]), 1.0)
    graph.use_odometry(LOCALIZATION.model_copy(update={"way_noise": 0.2}))
    graph.begin(np.array([1.0, 0.0, 0.0]), 2.0)
    known, guessed = (link.information[0, 0] ** -0.5 for link in graph.links)
    assert known == pytest.approx(LOCALIZATION.way_noise)
    assert guessed == pytest.approx(0.2)
