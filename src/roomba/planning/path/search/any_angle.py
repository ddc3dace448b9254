"""Exact shortest any-angle paths over the cells that fit; the work arrays are kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.planning.path.search.fan_kernels import BEFORE_GOAL, EPOCH, GOAL_SQUARE, Work
from roomba.planning.path.search.floor_kernels import survey
from roomba.planning.path.search.path_kernels import FOUND, FULL, START, search

_INSIDE = 1e-6
"""cells; ends on an open square's rim are searched from this far inside it."""


@dataclass(frozen=True, eq=False)
class FreeSpace:
    """The survey of the cells that fit: uint8 arrays with a closed border of one cell around."""

    fits: NDArray[np.uint8]
    open_squares: NDArray[np.uint8]
    flags: NDArray[np.uint8]

    @classmethod
    def of(cls, fits: NDArray[np.bool_]) -> FreeSpace:
        """Survey bool [rows, columns]."""
        padded = np.pad(fits.astype(np.uint8), 1)
        floor = cls(padded, np.zeros_like(padded), np.zeros_like(padded))
        survey(floor.fits, floor.open_squares, floor.flags)
        return floor


@dataclass(frozen=True, eq=False)
class Joints:
    """How a point is joined to the floor: by straight ways to ``cells``, int [n, 2] (row, column),
    the nearest first, that are ``legs`` long, float64 [n], in cells."""

    cells: NDArray[np.int64]
    legs: NDArray[np.float64]

    def among(self, chosen: NDArray[np.bool_]) -> Joints:
        """Return those marked in bool [n]."""
        return Joints(self.cells[chosen], self.legs[chosen])


class AnyAngleSearch:
    """Finds shortest paths over floors of one shape, one at a time.

    Points are (x, y) in cells, (0, 0) the centre of cell (row 0, column 0).
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        """Make the work arrays for floors of ``shape``, (rows, columns)."""
        self._columns = shape[1] + 2
        size = (shape[0] + 2) * self._columns
        self._stamps = np.zeros(size, np.int32)
        self._costs = np.zeros(size, np.float64)
        self._before = np.zeros(size, np.int32)
        self._state = np.zeros(5, np.int64)
        self._ends = np.zeros(5, np.float64)
        self._make_room(16 * self._columns)

    def _make_room(self, capacity: int) -> None:
        self._keys = np.zeros(capacity, np.float64)
        self._items = np.zeros(capacity, np.int32)
        self._fan_roots = np.zeros(capacity, np.int32)
        self._fans = np.zeros((capacity, 7), np.float64)

    def shortest_path(
        self,
        floor: FreeSpace,
        start: tuple[float, float],
        start_joints: Joints,
        goal: tuple[float, float],
        goal_joints: Joints,
    ) -> NDArray[np.float64] | None:
        """Return the bends of the shortest path, float64 [n, 2] (x, y) in cells, without its ends.

        An end in an open square of the floor sees all around; any other is tied to its joints, of
        which those count that are on the floor. None when there is no way.
        """
        start_in = _inside_open_square(floor, start)
        goal_in = _inside_open_square(floor, goal)
        self._state[GOAL_SQUARE] = int(goal_in[1]) if goal_in else -1
        self._ends[:2] = start_in or (start[0] + 1.0, start[1] + 1.0)
        self._ends[2:4] = goal_in or (goal[0] + 1.0, goal[1] + 1.0)
        entries, entry_legs = self._roots(floor, start_joints, start_in is not None)
        exits, exit_legs = self._roots(floor, goal_joints, goal_in is not None)
        while True:
            self._state[EPOCH] += 1
            work = Work(
                floor.fits,
                floor.open_squares,
                floor.flags,
                self._stamps,
                self._costs,
                self._before,
                self._keys,
                self._items,
                self._fan_roots,
                self._fans,
                self._state,
                self._ends,
            )
            outcome = search(work, entries, entry_legs, exits, exit_legs, start_in is not None)
            if outcome != FULL:
                break
            self._make_room(2 * self._keys.size)
        if outcome != FOUND:
            return None
        bends = []
        root = int(self._state[BEFORE_GOAL])
        while root != START:
            bends.append((root % self._columns - 1, root // self._columns - 1))
            root = int(self._before[root])
        return np.array(bends[::-1], np.float64).reshape(-1, 2)

    def _roots(
        self, floor: FreeSpace, joints: Joints, inside: bool
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        padded = joints.cells + 1
        useful = floor.fits[padded[:, 0], padded[:, 1]].astype(np.bool_)
        if inside:
            useful[:] = False
        roots = padded[useful] @ np.array([self._columns, 1])
        return roots.astype(np.int32), joints.legs[useful]


def _inside_open_square(floor: FreeSpace, point: tuple[float, float]) -> tuple[float, float] | None:
    """Return the point in padded cells, strictly inside an open square, or None."""
    x, y = point[0] + 1.0, point[1] + 1.0
    rows, columns = floor.fits.shape
    for row in {int(y - _INSIDE), int(y + _INSIDE)}:
        for column in {int(x - _INSIDE), int(x + _INSIDE)}:
            if 0 <= row < rows and 0 <= column < columns and floor.open_squares[row, column]:
                return (
                    min(max(x, column + _INSIDE), column + 1.0 - _INSIDE),
                    min(max(y, row + _INSIDE), row + 1.0 - _INSIDE),
                )
    return None
