"""The compiled string pulling by itself: which corners there are, and what is taut."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.planning.path.string_kernels import FULL, QUARTER, Pegs, String, mark_corners, pull

Floats = NDArray[np.float64]
ANGLES = np.arange(4 * QUARTER) * (0.5 * math.pi / QUARTER)
ARC = np.column_stack((np.cos(ANGLES), np.sin(ANGLES)))
SOLIDS = arrays(np.bool_, st.tuples(st.integers(1, 6), st.integers(1, 6)))
WAYS = st.lists(
    st.tuples(st.floats(0.0, 30.0), st.floats(0.0, 30.0)), min_size=2, max_size=6, unique=True
)
CIRCLES = st.lists(
    st.tuples(st.floats(2.0, 28.0), st.floats(2.0, 28.0), st.floats(0.5, 4.0)), max_size=5
)


def corners_of(solid: NDArray[np.bool_]) -> NDArray[np.uint8]:
    corners = np.zeros(np.array(solid.shape) + 1, np.uint8)
    mark_corners(solid, corners)
    return corners


def string_of(way: Floats, capacity: int = 512) -> String:
    string = String(
        np.zeros((capacity, 2)),
        np.zeros(capacity, np.uint8),
        np.zeros((capacity, 2)),
        np.zeros((capacity, 2)),
    )
    string.points[: len(way)] = way
    string.pinned[[0, len(way) - 1]] = 1
    return string


def pegs_of(circles: list[tuple[float, float, float]]) -> Pegs:
    nothing = np.zeros((31, 31), np.uint8)
    return Pegs(nothing, 1.0, np.array(circles, np.float64).reshape(-1, 3), ARC)


def length_of(way: Floats) -> float:
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


@given(SOLIDS)
@settings(max_examples=examples(200), deadline=None)
def test_corners_are_where_a_cell_sticks_out(solid: NDArray[np.bool_]) -> None:
    fenced = np.pad(solid, 1, constant_values=True)
    for y, x in np.ndindex(*(np.array(solid.shape) + 1)):
        around = {1: (1, 1), 2: (1, 0), 4: (0, 0), 8: (0, 1)}
        expected = 0
        for bit, (up, right) in around.items():
            beside, over = fenced[y + up, x + 1 - right], fenced[y + 1 - up, x + right]
            if fenced[y + up, x + right] and not beside and not over:
                expected |= bit
        assert corners_of(solid)[y, x] == expected


def turns_around(way: Floats, other: Floats, x: float, y: float) -> float:
    """How often the loop of a way and back by another one goes around a point."""
    spokes = np.concatenate((way, other[::-1])) - (x, y)
    angles = np.unwrap(np.arctan2(*np.concatenate((spokes, spokes[:1])).T[::-1]))
    return float(round((angles[-1] - angles[0]) / (2.0 * math.pi), 6))


@given(WAYS, CIRCLES)
@settings(max_examples=examples(300), deadline=None)
def test_it_ends_where_it_bends_only_around_points_that_it_passes_on_the_same_side(
    way: list[tuple[float, float]], circles: list[tuple[float, float, float]]
) -> None:
    """Among points a way that only bends around them is the shortest one on these sides."""
    begun = np.array(way)
    pegs = [(x + room * c, y + room * s) for x, y, room in circles for c, s in ARC.tolist()]
    line = shapely.LineString(begun)
    assume(all(line.distance(shapely.Point(x, y)) > room + 1e-4 for x, y, room in circles))
    string = string_of(begun)
    size = pull(string, len(way), pegs_of(circles))
    assert size >= 2
    pulled = string.points[:size]
    assert length_of(pulled) <= length_of(begun) + 1e-9
    assert np.array_equal(pulled[[0, -1]], begun[[0, -1]])
    bends = [tuple(bend) for bend in pulled[1:-1].tolist()]
    assert all(min(math.dist(bend, peg) for peg in pegs) < 1e-9 for bend in bends)
    for before, bend, after in zip(pulled, pulled[1:], pulled[2:], strict=False):
        inwards = [(end - bend) / math.dist(end, bend) for end in (before, after)]
        x, y = bend + 1e-5 * (inwards[0] + inwards[1])
        assert turns_around(begun, pulled, x, y) == 0.0
    line = shapely.LineString(pulled)
    for peg in pegs:
        if line.distance(shapely.Point(peg)) > 1e-6:
            assert turns_around(begun, pulled, *peg) == 0.0


def test_without_pegs_it_becomes_straight() -> None:
    way = np.array(((1.0, 1.0), (9.0, 3.0), (4.0, 20.0), (20.0, 20.0)))
    string = string_of(way)
    assert pull(string, 4, pegs_of([])) == 2
    assert np.array_equal(string.points[:2], way[[0, 3]])


def test_pinned_points_stay() -> None:
    way = np.array(((1.0, 1.0), (9.0, 3.0), (4.0, 20.0), (20.0, 20.0)))
    string = string_of(way)
    string.pinned[2] = 1
    assert pull(string, 4, pegs_of([])) == 3
    assert np.array_equal(string.points[:3], way[[0, 2, 3]])


@pytest.mark.parametrize("capacity", [3, 8, 12])
def test_a_string_that_is_too_small_is_asked_to_grow(capacity: int) -> None:
    way = np.array(((1.0, 10.0), (15.0, 29.0), (29.0, 10.0)))
    circle = [(15.0, 10.0, 8.0)]
    assert pull(string_of(way, capacity), 3, pegs_of(circle)) == FULL
    assert pull(string_of(way), 3, pegs_of(circle)) > 12


@pytest.mark.parametrize("bit", range(4))
def test_of_a_corner_only_the_arc_outside_of_its_cell_holds(bit: int) -> None:
    """A way around all of a corner's points is as far from it as a circle, but for its cell."""
    corners = np.zeros((31, 31), np.uint8)
    corners[15, 15] = 1 << bit
    angle = (0.25 + 0.5 * bit) * math.pi
    # From beside the cell around its tip and back on the other side.
    turned = np.array(((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))))
    way = np.array(((8.0, 5.0), (-9.0, 5.0), (-9.0, -5.0), (8.0, -5.0))) @ turned + 15.0
    string = string_of(way)
    size = pull(string, 4, Pegs(corners, 4.0, np.zeros((0, 3)), ARC))
    reach = np.hypot(*(string.points[1 : size - 1] - 15.0).T)
    assert size - 2 == QUARTER + 1
    assert np.allclose(reach, 4.0)
