"""The compiled steps of room segmentation over a floor, each against what it promises."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from roomba.perception.rooms.floor_kernels import (
    border_counts,
    clear_small_things,
    connected_parts,
    contacts,
    draw_line,
    grow,
)
from roomba.raster.regions import numbered_regions

Mask = NDArray[np.bool_]

CELLS = st.tuples(st.integers(0, 11), st.integers(0, 15))
GRIDS = hnp.arrays(np.int32, (8, 10), elements=st.integers(0, 3))


@given(CELLS, CELLS)
def test_no_step_over_a_side_leads_across_a_line(
    start: tuple[int, int], end: tuple[int, int]
) -> None:
    lines = np.zeros((12, 16), np.bool_)
    draw_line(lines, *start, *end)
    assert lines[start]
    assert lines[end]
    assert lines.sum() == max(abs(start[0] - end[0]), abs(start[1] - end[1])) + 1
    draw_line(lines, start[0], start[1], start[0], 0)
    draw_line(lines, end[0], end[1], end[0], 15)
    lines[start[0], : start[1] + 1] = lines[end[0], end[1] :] = True
    if start[1] <= end[1]:
        regions = numbered_regions(~lines)
        above, below = set(regions[-1].tolist()) - {0}, set(regions[0].tolist()) - {0}
        assert not above & below


def test_a_line_that_leaves_the_grid_is_drawn_as_far_as_it_goes() -> None:
    lines = np.zeros((4, 4), np.bool_)
    draw_line(lines, 1, -3, 1, 9)
    assert lines[1].all()
    assert lines.sum() == 4


def test_small_things_are_cleared_and_walls_are_not() -> None:
    solid = np.zeros((20, 20), np.bool_)
    solid[0, :] = True  # at the border
    solid[5:8, 5:8] = True
    solid[8, 8] = True  # touches it at the corner: four rows and columns in all
    solid[12, 3:9] = True
    solid[19, 18] = True
    kept = solid.copy()
    kept[5:9, 5:9] = False
    cleared = solid.copy()
    clear_small_things(cleared, 4)
    assert np.array_equal(cleared, kept)
    cleared = solid.copy()
    clear_small_things(cleared, 3)
    assert np.array_equal(cleared, solid)


@given(GRIDS, hnp.arrays(np.bool_, (8, 10)), st.integers(0, 4))
def test_labels_grow_by_steps_over_allowed_cells(
    labels: NDArray[np.int32], allowed: Mask, reach: int
) -> None:
    expected = labels != 0
    for _ in range(reach):
        padded = np.pad(expected, 1)
        beside = padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
        expected |= beside & allowed
    grown = labels.copy()
    grow(grown, allowed, reach)
    assert np.array_equal(grown != 0, expected)
    assert np.array_equal(grown[labels != 0], labels[labels != 0])


@given(GRIDS)
def test_parts_are_the_regions_of_each_label(labels: NDArray[np.int32]) -> None:
    parts = connected_parts(labels)
    assert np.array_equal(parts > 0, labels > 0)
    for part in range(1, int(parts.max()) + 1):
        assert len(set(labels[parts == part].tolist())) == 1
        assert numbered_regions(parts == part).max() == 1
    count = sum(int(numbered_regions(labels == label).max()) for label in (1, 2, 3))
    assert parts.max() == count


@given(GRIDS)
def test_contacts_are_where_labels_touch(labels: NDArray[np.int32]) -> None:
    touching = contacts(labels)
    pairs = set()
    for one, other in ((labels[1:], labels[:-1]), (labels[:, 1:], labels[:, :-1])):
        for first, second in zip(one.ravel().tolist(), other.ravel().tolist(), strict=True):
            if first and second and first != second:
                pairs.add((min(first, second), max(first, second)))
    # Where three meet at one cell, one of two contacts stands for both.
    assert {tuple(pair) for pair in touching[:, :2].tolist()} <= pairs
    assert bool(pairs) == bool(len(touching))
    for first, second, row, column, _ in touching.tolist():
        assert labels[row, column] in (first, second)


def test_two_doors_between_two_rooms_are_two_openings() -> None:
    labels = np.ones((20, 9), np.int32)
    labels[:, 5:] = 2
    labels[8:12, 4] = 0
    touching = contacts(labels)
    assert len(touching) == 16
    assert touching[:, 4].tolist() == [0] * 8 + [1] * 8


def test_openings_to_two_rooms_side_by_side_are_two() -> None:
    labels = np.ones((20, 9), np.int32)
    labels[:10, 5:], labels[10:, 5:] = 2, 3
    openings = {tuple(contact[:2]): contact[4] for contact in contacts(labels).tolist()}
    assert openings.keys() == {(1, 2), (1, 3), (2, 3)}
    assert len(set(openings.values())) == 3


def test_borders_are_counted_by_what_is_behind_them() -> None:
    labels = np.zeros((4, 5), np.int32)
    labels[0:2, 1:3] = 1
    unknown = np.zeros(labels.shape, np.bool_)
    unknown[:, 3] = True
    to_unknown, to_known = border_counts(labels, unknown, 1)
    assert to_unknown[1] == 2 + 2  # two columns end at the map's border, two rows at the unknown
    assert to_known[1] == 4
