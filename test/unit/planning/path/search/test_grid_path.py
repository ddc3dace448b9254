"""Shortest paths over a grid, against a plain Dijkstra."""

from __future__ import annotations

import heapq
import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.planning.path.search.grid_path import GridSearch, shortest_grid_path

Mask = NDArray[np.bool_]
Cell = tuple[int, int]


def distances(fits: Mask, start: Cell) -> dict[Cell, float]:
    rows, columns = fits.shape
    found = {start: 0.0}
    heap = [(0.0, start)]
    while heap:
        cost, (row, column) = heapq.heappop(heap)
        if cost > found[row, column]:
            continue
        for up in (-1, 0, 1):
            for right in (-1, 0, 1):
                to = (row + up, column + right)
                if not (0 <= to[0] < rows and 0 <= to[1] < columns):
                    continue
                if fits[to] and fits[to[0], column] and fits[row, to[1]]:
                    reached = cost + math.hypot(up, right)
                    if reached < found.get(to, math.inf):
                        found[to] = reached
                        heapq.heappush(heap, (reached, to))
    return found


@pytest.mark.parametrize("columns", [1, 9, 61, 62, 63, 64, 130])
@pytest.mark.parametrize("closed", [0.05, 0.2, 0.35])
def test_paths_are_legal_and_as_short_as_dijkstras(columns: int, closed: float) -> None:
    random = np.random.default_rng([columns, int(100 * closed)])
    search = GridSearch()
    for _ in range(6):
        fits = random.random((int(random.integers(1, 22)), columns)) > closed
        cells = [(int(row), int(column)) for row, column in np.argwhere(fits)]
        if not cells:
            continue
        start = cells[random.integers(len(cells))]
        expected = distances(fits, start)
        for index in random.integers(len(cells), size=30):
            goal = cells[index]
            path = search.shortest_path(fits, start, goal)
            if goal not in expected:
                assert path is None
                continue
            assert path is not None
            assert path.length == pytest.approx(expected[goal], abs=1e-6)
            walked = path.cells
            assert (tuple(walked[0]), tuple(walked[-1])) == (start, goal)
            steps = np.diff(walked, axis=0)
            assert np.abs(steps).max(initial=0) <= 1
            assert np.hypot(steps[:, 0], steps[:, 1]).sum() == pytest.approx(path.length)
            before = walked[:-1]
            assert fits[walked[:, 0], walked[:, 1]].all()
            assert fits[before[:, 0] + steps[:, 0], before[:, 1]].all()
            assert fits[before[:, 0], before[:, 1] + steps[:, 1]].all()


def test_a_closed_end_has_no_path() -> None:
    fits = np.ones((4, 4), np.bool_)
    fits[3, 3] = False
    assert shortest_grid_path(fits, (0, 0), (3, 3)) is None
    assert shortest_grid_path(fits, (3, 3), (0, 0)) is None


def test_the_start_itself_is_a_path_of_no_length() -> None:
    path = shortest_grid_path(np.ones((4, 4), np.bool_), (1, 2), (1, 2))
    assert path is not None
    assert path.length == 0.0
    assert path.cells.tolist() == [[1, 2]]


def test_the_work_arrays_grow_with_the_grid_and_with_the_heap() -> None:
    search = GridSearch()
    assert search.shortest_path(np.ones((2, 2), np.bool_), (0, 0), (1, 1)) is not None
    random = np.random.default_rng(7)
    fits = random.random((300, 300)) > 0.3
    fits[0, 0] = fits[-1, -1] = True
    fits[0] = fits[:, -1] = True
    path = search.shortest_path(fits, (0, 0), (299, 299))
    assert path is not None
    assert path.length == pytest.approx(distances(fits, (0, 0))[299, 299])


def test_a_cell_off_the_grid_is_refused() -> None:
    with pytest.raises(ValueError, match="expected a goal on the grid"):
        shortest_grid_path(np.ones((4, 4), np.bool_), (0, 0), (4, 0))
    with pytest.raises(ValueError, match="expected a start on the grid"):
        shortest_grid_path(np.ones((4, 4), np.bool_), (0, -1), (3, 0))
