"""Edits of labelled rooms: joining and cutting. No cell is lost, and labels stay contiguous."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.perception.rooms.floor_kernels import connected_parts, contacts, draw_line, grow

RoomLabels = NDArray[np.int16]


def are_touching(labels: RoomLabels, chosen: Sequence[int]) -> bool:
    """Whether each chosen label can be reached from each other through chosen labels alone."""
    pairs = contacts(np.where(np.isin(labels, chosen), labels, 0).astype(np.int32))[:, :2]
    reached = {chosen[0]}
    for _ in chosen:
        reached |= {label for pair in pairs.tolist() if reached & set(pair) for label in pair}
    return reached >= set(chosen)


def joined(labels: RoomLabels, chosen: Sequence[int]) -> RoomLabels:
    """Return labels with all chosen ones made the first of them; the others close the gaps."""
    number = np.arange(int(labels.max()) + 1)
    number[list(chosen)] = chosen[0]
    kept, closed_up = np.unique(number, return_inverse=True)
    assert kept[0] == 0
    joined_labels: RoomLabels = closed_up.astype(np.int16)[labels]
    return joined_labels


def split(
    labels: RoomLabels, label: int, line: tuple[int, int, int, int], least: int
) -> RoomLabels | None:
    """Return labels with one cut along a line of cells; None if it does not fall into pieces.

    ``line`` is row and column of both ends. A piece has ``least`` cells or more; smaller parts go
    to the piece beside them. The largest piece keeps the label, the others get labels after the
    last one, by size.
    """
    mask = labels == label
    cut = mask.copy()
    barrier = np.zeros(labels.shape, np.bool_)
    draw_line(barrier, *line)
    cut &= ~barrier
    parts = connected_parts(cut.astype(np.int32))
    sizes = np.bincount(parts.ravel())
    sizes[0] = 0
    pieces = [part for part in np.argsort(-sizes, kind="stable").tolist() if sizes[part] >= least]
    if len(pieces) < 2:
        return None
    number = np.zeros(sizes.size, np.int32)
    number[pieces] = [label, *range(int(labels.max()) + 1, int(labels.max()) + len(pieces))]
    cells = number[parts]
    grow(cells, mask, labels.size)
    cut_labels: RoomLabels = labels.copy()
    cut_labels[mask] = np.where(cells[mask] > 0, cells[mask], label)
    return cut_labels
