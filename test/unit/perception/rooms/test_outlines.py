"""Outlines of rooms and back, against every cell and every side of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.references.straight_ways import Mask, parts_of
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.grid import GridFrame
from roomba.perception.rooms.outlines import cells_inside, line_on, outline_of

MASKS = arrays(np.bool_, st.tuples(st.integers(1, 8), st.integers(1, 8)))


def frame_of(mask: Mask) -> GridFrame:
    rows, columns = mask.shape
    return GridFrame(0.1, -1.3, 2.0, rows, columns)


@given(MASKS)
@settings(max_examples=examples(80))
def test_an_outline_has_the_area_the_borders_and_the_parts_of_its_cells(mask: Mask) -> None:
    outline = outline_of(mask, frame_of(mask))
    padded = np.pad(mask, 1)
    sides = sum(
        int(padded[row + 1, column + 1] != padded[row + 1 + down, column + 1 + right])
        for row, column in np.argwhere(mask).tolist()
        for down, right in ((0, 1), (0, -1), (1, 0), (-1, 0))
    )
    assert outline.area == pytest.approx(0.01 * mask.sum())
    assert outline.length == pytest.approx(0.1 * sides)
    # Where parts touch at corners alone they are apart.
    assert len(shapely.get_parts(outline)) == len(parts_of(mask))
    for row, column in np.ndindex(*mask.shape):
        centre = shapely.Point(frame_of(mask).centre_of(row, column))
        assert outline.contains(centre) == mask[row, column]


@given(MASKS)
@settings(max_examples=examples(60))
def test_the_cells_inside_of_an_outline_are_those_that_it_was_made_of(mask: Mask) -> None:
    assert np.array_equal(cells_inside(outline_of(mask, frame_of(mask)), frame_of(mask)), mask)


@given(st.lists(st.tuples(st.floats(-2.5, 0.5), st.floats(1.5, 3.5)), min_size=3, max_size=5))
@settings(max_examples=examples(80))
def test_a_cell_is_inside_when_its_middle_is(corners: list[tuple[float, float]]) -> None:
    frame = GridFrame(0.1, -1.3, 2.0, 9, 7)
    shape = shapely.MultiPoint(corners).convex_hull
    found = cells_inside(shape, frame)
    for row, column in np.ndindex(*frame.shape):
        middle = shapely.Point(frame.centre_of(row, column))
        if shape.boundary.is_empty or shape.boundary.distance(middle) > 1e-9:
            assert found[row, column] == shape.contains(middle)


@given(*[st.tuples(st.floats(-3.0, 1.5), st.floats(1.0, 4.0))] * 2)
@settings(max_examples=examples(80))
def test_a_line_is_told_as_far_as_it_is_on_the_grid(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    frame = GridFrame(0.1, -1.3, 2.0, 9, 7)
    found = line_on(frame, start, end)
    shares = np.linspace(0.0, 1.0, 2001).tolist()
    places = [
        (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        for share in shares
    ]
    inside = [place for place in places if frame.contains(*place)]
    if found is None:
        # At most a corner of the grid may lie between two of the places.
        assert len(inside) <= 1 or start == end
        return
    if inside:
        for cell, place in zip((found[:2], found[2:]), (inside[0], inside[-1]), strict=True):
            assert math.dist(cell, frame.cell_of(*place)) <= math.sqrt(2.0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_line_without_ends_is_nowhere(value: float) -> None:
    frame = GridFrame(0.1, 0.0, 0.0, 9, 9)
    assert line_on(frame, (0.1, value), (0.5, 0.5)) is None
    assert line_on(frame, (0.1, 0.1), (value, 0.5)) is None
