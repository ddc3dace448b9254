"""Poses and the links between them: agreeing where they can, the wrong ones outvoted."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.sparse.linalg
from fixtures.robots.mapped import Floats
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy.sparse import csc_matrix

from roomba.angles import wrap_angles
from roomba.geometry import Pose
from roomba.perception.slam.submaps.pose_graph import (
    Link,
    LinkKind,
    composed,
    optimised,
    relative_to,
)

SURE = np.diag([1e4, 1e4, 1e5])
rows = arrays.arrays(np.float64, (4, 3), elements=st.floats(-3.0, 3.0))


def link(truth: Floats, parent: int, child: int, kind: LinkKind = LinkKind.MATCHED) -> Link:
    """A measurement without error."""
    relative = relative_to(truth[parent : parent + 1], truth[child : child + 1])[0]
    return Link(parent, child, relative, SURE, kind)


def ring(count: int = 12, radius: float = 3.0) -> Floats:
    """Poses on a circle, m, each along it."""
    angles = np.arange(count) * (2.0 * np.pi / count)
    heading = np.remainder(angles + 1.5 * np.pi, 2.0 * np.pi) - np.pi
    return np.column_stack((radius * np.cos(angles), radius * np.sin(angles), heading))


def chain(truth: Floats) -> list[Link]:
    return [link(truth, at, at + 1, LinkKind.DRIVEN) for at in range(len(truth) - 1)]


def away(poses: Floats, truth: Floats) -> float:
    off = poses - truth
    off[:, 2:] = np.remainder(off[:, 2:] + np.pi, 2.0 * np.pi) - np.pi
    return float(np.abs(off).max())


@given(rows, rows)
def test_in_the_frame_of_another_and_back(parents: Floats, children: Floats) -> None:
    relative = relative_to(parents, children)
    assert away(composed(parents, relative), children) < 1e-9
    for parent, child, found in zip(parents, children, relative, strict=True):
        expected = Pose(*parent).inverse().compose(Pose(*child))
        assert found[:2] == pytest.approx((expected.x, expected.y))
        assert math.cos(found[2] - expected.theta) == pytest.approx(1.0)


@given(rows, st.integers(0, 2**31))
def test_links_that_agree_are_met_exactly(truth: Floats, seed: int) -> None:
    links = [*chain(truth), link(truth, 0, 3), link(truth, 3, 1)]
    noise = np.random.default_rng(seed).normal(0.0, 0.1, truth.shape)
    noise[0] = 0.0
    found = optimised(truth + noise, links)
    assert away(found, truth) < 1e-4


def test_the_first_pose_stays_and_nothing_that_was_given_changes() -> None:
    truth = ring()
    start = truth + np.random.default_rng(1).normal(0.0, 0.1, truth.shape)
    before = start.copy()
    found = optimised(start, [*chain(truth), link(truth, 11, 0)])
    assert (start == before).all()
    assert found[0] == pytest.approx(start[0])
    # All the others follow from it.
    expected = composed(
        np.broadcast_to(start[0], truth.shape),
        relative_to(np.broadcast_to(truth[0], truth.shape), truth),
    )
    assert away(found, expected) < 1e-4


def test_drift_around_a_loop_is_spread_over_it() -> None:
    """A quarter of a metre off after 47 m, as submaps drift, and where it began is seen again."""
    truth = ring(16, 7.5)
    drive = np.diag([0.035**-2, 0.035**-2, 0.017**-2])
    seen = np.diag([0.004**-2, 0.004**-2, 0.0015**-2])
    bent = np.array([0.005, 0.0, 0.002])
    links = [
        Link(at.parent, at.child, at.relative + bent, drive, LinkKind.DRIVEN) for at in chain(truth)
    ]
    drifted = [truth[:1]]
    for at in links:
        drifted.append(composed(drifted[-1], at.relative[None]))
    start = np.concatenate(drifted)
    assert away(start[:, :2], truth[:, :2]) > 0.2
    again = [link(truth, parent, child) for parent in (0, 1) for child in (14, 15)]
    links += [Link(at.parent, at.child, at.relative, seen) for at in again]
    found = optimised(start, links)
    assert away(found[-1:], truth[-1:]) < 0.01
    assert away(found[:, :2], truth[:, :2]) < 0.35 * away(start[:, :2], truth[:, :2])


@pytest.mark.parametrize("error", [0.5, 2.0])
def test_a_wrong_loop_is_outvoted(error: float) -> None:
    truth = ring()
    right = [link(truth, at, (at + 3) % 12) for at in range(12)]
    wrong = link(truth, 2, 8)
    wrong = Link(2, 8, wrong.relative + np.array([error, -error, 0.3]), SURE)
    start = truth + np.random.default_rng(2).normal(0.0, 0.02, truth.shape)
    start[0] = truth[0]
    assert away(optimised(start, [*chain(truth), *right, wrong]), truth) < 0.005
    # Were it beyond doubt it would bend everything.
    believed = Link(2, 8, wrong.relative, SURE, LinkKind.DRIVEN)
    assert away(optimised(start, [*chain(truth), *right, believed]), truth) > 0.05


def test_headings_beyond_half_a_turn_are_no_error() -> None:
    truth = np.array([[0.0, 0.0, 3.1], [1.0, 0.0, -3.1], [2.0, 0.1, -0.05]])
    # The last two look at each other: half a turn, measured to the one side or the other.
    links = [*chain(truth), link(truth, 0, 2)]
    assert abs(links[1].relative[2]) > 3.0
    found = optimised(truth + np.array([[0.0] * 3, [0.0, 0.0, 0.1], [0.0, 0.0, 0.2]]), links)
    assert away(found, truth) < 1e-4
    assert (np.abs(found[:, 2]) <= np.pi).all()


def test_a_pose_that_nothing_holds_stays() -> None:
    truth = ring(4)
    truth[:, 2] = wrap_angles(truth[:, 2])
    found = optimised(truth + 0.0, [link(truth, 0, 1)])
    assert found == pytest.approx(truth)
    assert optimised(truth, []) == pytest.approx(truth)
    one = np.array([[1.0, 2.0, 3.0]])
    assert (optimised(one, []) == one).all()


@pytest.mark.parametrize(("parent", "child"), [(0, 4), (4, 0), (-1, 2), (7, 9)])
def test_links_to_no_pose_are_refused(parent: int, child: int) -> None:
    with pytest.raises(ValueError, match="expected links between poses 0 to 3"):
        optimised(ring(4), [Link(parent, child, np.zeros(3), SURE)])


def test_thousands_of_poses_take_few_sparse_rounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """5000 poses on rows to and fro, each linked to the row before: work grows with the links."""
    solved: list[int] = []
    solve = scipy.sparse.linalg.spsolve

    def counted(matrix: csc_matrix, *args: object, **options: object) -> Floats:
        solved.append(matrix.nnz)
        result: Floats = solve(matrix, *args, **options)
        return result

    monkeypatch.setattr(scipy.sparse.linalg, "spsolve", counted)
    per_pose = []
    for rows in (10, 100):
        truth = np.array(
            [
                (column if row % 2 == 0 else 49 - column, row, 0.0 if row % 2 == 0 else np.pi)
                for row in range(rows)
                for column in range(50)
            ],
            float,
        )
        loops = [
            link(truth, 50 * row + at, 50 * row + 99 - at)
            for row in range(rows - 1)
            for at in range(0, 50, 5)
        ]
        links = [*chain(truth)[: len(truth) - 1], *loops]
        bent = np.array([0.002, 0.001, 0.0005])
        start = [truth[0]]
        for at in links[: len(truth) - 1]:
            start.append(composed(start[-1][None], (at.relative + bent)[None])[0])
        solved.clear()
        found = optimised(np.array(start), links)
        assert away(found, truth) < 0.01
        assert 0 < len(solved) <= 30
        per_pose.append(max(solved) / len(truth))
    # Numbers other than zero, for each pose: no more in the large graph than in the small one.
    assert per_pose[1] < 1.1 * per_pose[0] < 100.0
