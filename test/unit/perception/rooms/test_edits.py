"""Rooms joined and cut, against loops over all cells."""

from __future__ import annotations

import numpy as np
from fixtures.references.straight_ways import parts_of
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from roomba.perception.rooms.edits import are_touching, joined, split

Labels = NDArray[np.int16]


@st.composite
def labelled(draw: st.DrawFn) -> Labels:
    """Labels from 1 on without a gap between them, 0 for none."""
    cells = draw(arrays(np.int16, (7, 9), elements=st.integers(0, 4)))
    _, labels = np.unique(np.append(0, cells), return_inverse=True)
    gapless: Labels = labels[1:].reshape(cells.shape).astype(np.int16)
    return gapless


@given(labelled(), st.sets(st.integers(1, 4), min_size=1, max_size=3))
@settings(max_examples=examples(80))
def test_rooms_touch_when_their_cells_lead_from_one_to_the_next(
    labels: Labels, chosen: set[int]
) -> None:
    assume(max(chosen) <= labels.max())
    order = sorted(chosen)
    # Rooms count as whole, however many parts they have.
    links = set()
    for axis in (0, 1):
        one = np.delete(labels, -1, axis).ravel().tolist()
        other = np.delete(labels, 0, axis).ravel().tolist()
        links |= {pair for pair in zip(one, other, strict=True) if set(pair) <= chosen}
    reached = {order[0]}
    for _ in order:
        reached |= {label for pair in links if reached & set(pair) for label in pair}
    assert are_touching(labels, order) == (reached == chosen)


@given(labelled(), st.lists(st.integers(1, 4), min_size=1, max_size=3, unique=True))
@settings(max_examples=examples(80))
def test_joined_rooms_are_the_first_and_the_others_close_up(
    labels: Labels, chosen: list[int]
) -> None:
    assume(max(chosen) <= labels.max())
    found = joined(labels, chosen)
    kept = [label for label in range(1, int(labels.max()) + 1) if label not in chosen[1:]]
    for cell in np.ndindex(*labels.shape):
        label = int(labels[cell])
        expected = 0 if label == 0 else kept.index(chosen[0] if label in chosen else label) + 1
        assert found[cell] == expected


@given(
    labelled(),
    st.tuples(st.integers(0, 6), st.integers(0, 8), st.integers(0, 6), st.integers(0, 8)),
    st.integers(1, 6),
)
@settings(max_examples=examples(150))
def test_a_cut_room_falls_into_pieces_that_are_large_enough_and_loses_no_cell(
    labels: Labels, line: tuple[int, int, int, int], least: int
) -> None:
    assume(labels.max() >= 1)
    before = labels.copy()
    found = split(labels, 1, line, least)
    assert np.array_equal(labels, before)
    mask = labels == 1
    if found is None:
        # A line along one row or column is the cells between its ends.
        if line[0] == line[2] or line[1] == line[3]:
            left = mask.copy()
            rows, columns = sorted(line[::2]), sorted(line[1::2])
            left[rows[0] : rows[1] + 1, columns[0] : columns[1] + 1] = False
            assert sum(len(part) >= least for part in parts_of(left)) < 2
        return
    assert np.array_equal(found[~mask], labels[~mask])
    pieces = [1, *range(int(labels.max()) + 1, int(found.max()) + 1)]
    assert len(pieces) >= 2
    assert set(np.unique(found[mask]).tolist()) == set(pieces)
    assert all(np.count_nonzero(found[mask] == piece) >= least for piece in pieces)


def test_the_largest_piece_keeps_its_name_and_the_others_follow_by_size() -> None:
    labels = np.full((6, 30), 2, np.int16)
    labels[:, 20:] = 1
    first = split(labels, 2, (0, 4, 5, 4), 5)
    assert first is not None
    assert first[0, 10] == 2
    assert first[0, 0] == 3
    assert split(labels, 2, (0, 4, 5, 4), 25) is None
