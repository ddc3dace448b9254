"""How far a map may be bent against its own beginning."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.arrays import Floats
from roomba.perception.slam.submaps.heading_drift import heading_drift
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind

STEP = 3.0
"""m; way from one submap to the next."""
COUNT = 25
WAYS = [STEP * number for number in range(COUNT)]
LEAST = math.radians(0.25)
"""rad per square root of m; no drive drifts less."""
SURE = np.diag([0.005**-2, 0.005**-2, 0.002**-2])
ROUGH = np.diag([0.5**-2, 0.5**-2, 0.1**-2])


def straight(off: float = 0.0) -> tuple[Floats, list[Link]]:
    """Return submaps along a line, and links from each to the next, ``off`` by turns, rad."""
    poses = np.zeros((COUNT, 3))
    poses[:, 0] = WAYS
    links = [
        Link(child - 1, child, np.array([STEP, 0.0, (-1) ** child * off]), SURE, LinkKind.DRIVEN)
        for child in range(1, COUNT)
    ]
    return poses, links


def match(parent: int, child: int) -> Link:
    return Link(parent, child, np.zeros(3), SURE)


def test_a_way_that_comes_back_nowhere_drifts_as_its_square_root() -> None:
    poses, links = straight()
    drift = heading_drift(poses, WAYS, links)
    assert drift.way == WAYS[-1]
    assert drift.deviation == pytest.approx(LEAST * math.sqrt(WAYS[-1]), rel=0.01)


def test_it_drifts_as_much_as_the_drive_itself_shows() -> None:
    off = math.radians(1.5)
    poses, links = straight(off)
    drift = heading_drift(poses, WAYS, links)
    assert drift.deviation == pytest.approx(off / math.sqrt(STEP) * math.sqrt(WAYS[-1]), rel=0.01)


def test_a_place_that_is_seen_again_holds_the_heading() -> None:
    poses, links = straight()
    alone = heading_drift(poses, WAYS, links)
    closed = heading_drift(poses, WAYS, [*links, match(0, COUNT - 1)])
    # What is halfway between two held ends is off by half as much.
    assert closed.deviation == pytest.approx(0.5 * alone.deviation, rel=0.05)
    assert closed.way == pytest.approx(0.5 * WAYS[-1], abs=STEP)


def test_what_comes_after_the_last_place_seen_again_drifts_on() -> None:
    poses, links = straight()
    drift = heading_drift(poses, WAYS, [*links, match(0, 10), match(1, 11)])
    assert drift.way == WAYS[-1]
    assert drift.deviation == pytest.approx(LEAST * math.sqrt(WAYS[-1] - WAYS[11]), rel=0.1)


def test_matches_of_neighbours_say_nothing_new() -> None:
    poses, links = straight()
    beside = [match(child - 2, child) for child in range(2, COUNT)]
    assert heading_drift(poses, WAYS, [*links, *beside]) == heading_drift(poses, WAYS, links)


def test_what_is_guessed_does_not_count_unless_a_match_joins_it() -> None:
    poses, links = straight()
    links[9] = Link(9, 10, links[9].relative, ROUGH, LinkKind.GUESSED)
    apart = heading_drift(poses, WAYS, links)
    assert apart.way == WAYS[9]
    joined = heading_drift(poses, WAYS, [*links, match(8, 10)])
    assert joined.way == WAYS[-1]
    assert joined.deviation < 1.1 * LEAST * math.sqrt(WAYS[-1])


def test_a_place_that_was_told_is_no_step_that_drifts() -> None:
    poses, links = straight()
    poses[10:, 2] = 1.0
    turned = np.array([STEP, 0.0, 0.0])
    links[9] = Link(9, 10, turned, SURE, LinkKind.TOLD)
    told = heading_drift(poses, WAYS, links)
    assert told.way == WAYS[-1]
    assert told.deviation == pytest.approx(LEAST * math.sqrt(WAYS[-1] - STEP), rel=0.01)


def test_a_single_submap_is_not_bent() -> None:
    assert heading_drift(np.zeros((1, 3)), [0.0], []) == (0.0, 0.0)
