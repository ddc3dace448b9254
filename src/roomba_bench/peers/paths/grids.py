"""Code that the planning peers share: the case, and the measuring of their paths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from roomba_bench.peers.protocol import Parameters

Cell = tuple[int, int]


def grid_case(parameters: Parameters) -> tuple[NDArray[np.bool_], Cell, Cell]:
    """Return the cells that may be entered, bool [rows, columns], the start and the goal."""
    start, goal = parameters["start"], parameters["goal"]
    return np.load(parameters["fits"]), (start[0], start[1]), (goal[0], goal[1])


def path_facts(fits: NDArray[np.bool_], path: NDArray[np.int64]) -> dict[str, float]:
    """Return ``length`` in cells, and how many closed corners it cuts, of int [n, 2] cells."""
    if not fits[path[:, 0], path[:, 1]].all():
        raise ValueError("the path enters closed cells")
    steps = np.diff(path, axis=0)
    before, after = path[:-1], path[1:]
    is_cut = (np.abs(steps).sum(axis=1) == 2) & ~(
        fits[after[:, 0], before[:, 1]] & fits[before[:, 0], after[:, 1]]
    )
    length = float(np.hypot(steps[:, 0], steps[:, 1]).sum())
    return {"length": length, "corners cut": float(is_cut.sum())}


def links(
    fits: NDArray[np.bool_],
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Return all pairs of neighbouring cells (flat numbers) and their distance, each pair once.

    Diagonal neighbours are linked only where both cells beside the step are open.
    """
    number = np.arange(fits.size).reshape(fits.shape)
    low, high, every = slice(None, -1), slice(1, None), slice(None)
    first, second, cost = [], [], []
    for here, there, length in (
        ((every, low), (every, high), 1.0),
        ((low, every), (high, every), 1.0),
        ((low, low), (high, high), 2.0**0.5),
        ((low, high), (high, low), 2.0**0.5),
    ):
        open_ = fits[here] & fits[there]
        if length > 1.0:
            open_ &= fits[here[0], there[1]] & fits[there[0], here[1]]
        first.append(number[here][open_])
        second.append(number[there][open_])
        cost.append(np.full(len(first[-1]), length))
    return np.concatenate(first), np.concatenate(second), np.concatenate(cost)
