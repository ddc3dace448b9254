"""The metric of relations: by hand, and beside a slow version of its own."""

from __future__ import annotations

import cmath
import itertools
import lzma
import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba_bench.slam.relations import errors, load_relations, relations_beside

Floats = NDArray[np.float64]

# Drives 1 m a second along x; at 2 s it turns left on the spot, by a quarter turn a second.
WAY = np.array(
    [(0.0, 0.0, 0.0, 0.0), (1.0, 1.0, 0.0, 0.0), (2.0, 2.0, 0.0, 0.0), (3.0, 2.0, 0.0, math.pi / 2)]
)


def slowly(trajectory: Floats, relations: Floats) -> list[tuple[float, float]]:
    """Return the errors of translation and rotation, pair by pair, in complex numbers."""

    def place(time: float) -> tuple[complex, complex]:
        for (t1, x1, y1, h1), (t2, x2, y2, h2) in itertools.pairwise(trajectory):
            if t1 <= time <= t2:
                share = (time - t1) / (t2 - t1)
                turn = cmath.phase(cmath.exp(1j * (h2 - h1)))
                here = complex(x1, y1) + share * complex(x2 - x1, y2 - y1)
                return here, cmath.exp(1j * (h1 + share * turn))
        raise AssertionError(time)

    found = []
    for t1, t2, x, y, yaw in relations:
        (here, heading), (there, later) = place(t1), place(t2)
        step, turn = (there - here) / heading, later / heading
        true_turn = cmath.exp(1j * yaw)
        found.append((abs((step - complex(x, y)) / true_turn), abs(cmath.phase(turn / true_turn))))
    return found


def test_what_is_right_has_no_error() -> None:
    relations = np.array([(0.0, 2.0, 2.0, 0.0, 0.0), (1.0, 3.0, 1.0, 0.0, math.pi / 2)])
    found = errors(WAY, relations)
    assert (found.count, found.skipped) == (2, 0)
    assert found.translation == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert found.rotation == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_errors_are_those_that_a_person_counts() -> None:
    relations = np.array(
        [
            (0.0, 2.0, 2.3, 0.4, 0.0),  # 0.3 m and 0.4 m off: 0.5 m
            (3.0, 0.0, 0.0, 2.0, 0.1 - math.pi / 2),  # 0.1 rad off, at the right place
            (0.5, 1.5, 1.0, 0.0, math.radians(20.0)),  # between the poses
        ]
    )
    found = errors(WAY, relations)
    assert found.translation == pytest.approx((0.5 / 3.0, math.sqrt(2.0) / 6.0, 0.5))
    turns = [0.0, 0.1, math.radians(20.0)]
    assert found.rotation == pytest.approx((sum(turns) / 3.0, float(np.std(turns)), turns[2]))


def test_headings_that_pass_half_a_turn_do_not_jump() -> None:
    way = np.array([(0.0, 0.0, 0.0, 3.1), (1.0, 0.0, 0.0, -3.1)])
    turned = 2.0 * math.pi - 6.2
    found = errors(way, np.array([(0.0, 0.5, 0.0, 0.0, 0.5 * turned)]))
    assert found.rotation[2] == pytest.approx(0.0, abs=1e-9)


@given(
    st.integers(2, 25),
    st.lists(st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)), min_size=1, max_size=20),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=examples(80), deadline=None)
def test_it_is_the_same_as_a_slow_version(
    poses: int, pairs: list[tuple[float, float]], seed: int
) -> None:
    generator = np.random.default_rng(seed)
    stamps = np.cumsum(generator.uniform(0.05, 0.9, poses))
    # Between two poses it turns by less than half a turn: else both ways are as likely.
    headings = np.cumsum(generator.uniform(-3.0, 3.0, poses))
    way = np.column_stack(
        (stamps, generator.normal(0.0, 5.0, (poses, 2)), np.angle(np.exp(1j * headings)))
    )
    times = stamps[0] + np.array(pairs) * (stamps[-1] - stamps[0])
    relations = np.column_stack((times, generator.normal(0.0, 2.0, (len(pairs), 3))))
    found, expected = errors(way, relations), np.array(slowly(way, relations))
    assert found.count == len(pairs)
    for (mean, deviation, largest), values in zip(
        (found.translation, found.rotation), expected.T, strict=True
    ):
        assert mean == pytest.approx(values.mean(), abs=1e-9)
        assert deviation == pytest.approx(values.std(), abs=1e-9)
        assert largest == pytest.approx(values.max(), abs=1e-9)


def test_relations_of_times_without_poses_are_skipped_and_counted() -> None:
    gap = np.vstack((WAY, WAY + np.array([60.0, 0.0, 0.0, 0.0])))
    relations = np.array(
        [
            (0.0, 1.0, 1.0, 0.0, 0.0),
            (-5.0, 1.0, 1.0, 0.0, 0.0),  # before
            (0.0, 99.0, 1.0, 0.0, 0.0),  # after
            (0.0, 30.0, 1.0, 0.0, 0.0),  # in the middle of the gap
            (0.0, 3.9, 2.0, 0.0, math.pi / 2),  # at its edge
        ]
    )
    found = errors(gap, relations)
    assert (found.count, found.skipped) == (2, 3)
    with pytest.raises(ValueError, match="expected a trajectory at the times of the relations"):
        errors(WAY + np.array([1e6, 0.0, 0.0, 0.0]), relations)


@pytest.mark.parametrize(
    ("log", "relations"),
    [
        ("made.bag", "made.relations"),
        ("made.bag.xz", "made.relations.xz"),
        ("made.gfs.log", "made.relations"),
        ("made.gfs.log", "made.gfs.relations.gz"),
        ("made", "made.relations"),
        ("made", None),
        ("other.bag", None),
    ],
)
def test_relations_stand_beside_their_log(tmp_path: Path, log: str, relations: str | None) -> None:
    (tmp_path / log).touch()
    (tmp_path / (relations or "made_too.relations")).touch()
    found = relations_beside(tmp_path / log)
    assert (None if found is None else found.name) == relations


def test_a_file_of_relations_is_read_packed_or_not(tmp_path: Path) -> None:
    text = "1.5 2.5 0.1 -0.2 0.3 0.01 0.02 -1.5\n2.0 3.0 1 2 0 0 0 0.5\n"
    (tmp_path / "a.relations").write_text(text, "utf-8")
    (tmp_path / "a.relations.xz").write_bytes(lzma.compress(text.encode()))
    for name in ("a.relations", "a.relations.xz"):
        assert load_relations(tmp_path / name).tolist() == [
            [1.5, 2.5, 0.1, -0.2, -1.5],
            [2.0, 3.0, 1.0, 2.0, 0.5],
        ]


@pytest.mark.parametrize("text", ["1 2 3\n", "1 2 3 4 5 6 7 nan\n", "a b c\n"])
def test_a_file_of_something_else_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.relations").write_text(text, "utf-8")
    with pytest.raises(ValueError, match=r"expected lines of 8|could not convert"):
        load_relations(tmp_path / "a.relations")
