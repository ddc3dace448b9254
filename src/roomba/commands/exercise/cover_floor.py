"""Checks ``coverage_path(free, start)``: whether the way stays on the floor, and what it swept."""

from __future__ import annotations

import itertools
import sys
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.commands.exercise.verdict import NotYetError, expect, function_of, judged
from roomba.raster.regions import dilated, numbered_regions

_WIDTH: Final = 5
"""Cells of 5 cm, the tool's width: the middle cell and two on each side."""
_SHARE: Final = 0.98
"""0..1; the share of the floor within the tool's reach that must be swept."""
_MOST: Final = 2.0
"""The longest way that passes, as a factor of the least: the floor's area by the tool's width."""
_STEPS: Final = 4
"""Points of the way that are checked per cell."""


def floors() -> dict[str, Mask]:
    """Return floors by name: where the robot's middle may be, bool [rows, columns]."""
    room = np.zeros((50, 60), np.bool_)
    room[2:-2, 2:-2] = True
    table = room.copy()
    table[18:32, 20:40] = False
    rooms = np.zeros((50, 110), np.bool_)
    rooms[2:-2, 2:52] = True
    rooms[2:30, 58:-2] = True
    rooms[14:20, 52:58] = True
    return {"an empty room": room, "a room with a table": table, "two rooms with a door": rooms}


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    plan = function_of(file, "coverage_path")
    told = []
    for name, free in floors().items():
        way = np.array([tuple(map(float, cell)) for cell in plan(free.copy(), (3, 3))])
        expect(way.ndim == 2 and way.shape[1:] == (2,), f"{name}: expected (row, column) of cells")
        expect(bool((way[0] == 3.0).all()), f"{name}: expected it to begin at (3, 3)")
        passed = _cells_of(way)
        for row, column in passed:
            inside = 0 <= row < free.shape[0] and 0 <= column < free.shape[1]
            expect(
                inside and bool(free[row, column]),
                f"{name}: the middle may not be at cell ({row}, {column}), which the way crosses",
            )
        floor, swept = dilated(free, _tool()), _swept(free, passed)
        share, length = swept.sum() / floor.sum(), float(np.hypot(*np.diff(way, axis=0).T).sum())
        if share < _SHARE:
            raise NotYetError(
                f"{name}: {share:.1%} of the floor are swept, expected {_SHARE:.0%}; the largest "
                f"part that is left is in {_largest(floor & ~swept)}"
            )
        ratio = length * _WIDTH / int(floor.sum())
        expect(ratio <= _MOST, f"{name}: {ratio:.2f} times the least way, {_MOST} are allowed")
        told.append(f"{name}: {share:.1%} by {ratio:.2f} times the least way")
    return "; ".join(told)


def _tool() -> Mask:
    away = np.arange(_WIDTH) - _WIDTH // 2
    disc: Mask = away[:, None] ** 2 + away[None, :] ** 2 <= (_WIDTH / 2.0) ** 2
    return disc


def _cells_of(way: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the cells that a way goes through, int64 [n, 2]."""
    parts = [way[:1]]
    for one, other in itertools.pairwise(way):
        count = max(1, int(np.ceil(np.abs(other - one).max() * _STEPS)))
        parts.append(one + (other - one) * (np.arange(1, count + 1) / count)[:, None])
    cells: NDArray[np.int64] = np.rint(np.concatenate(parts)).astype(np.int64)
    return np.unique(cells, axis=0)


def _swept(free: Mask, passed: NDArray[np.int64]) -> Mask:
    """Return what the tool passed over."""
    at = np.zeros_like(free)
    at[passed[:, 0], passed[:, 1]] = True
    return dilated(at, _tool())


def _largest(left: Mask) -> str:
    """Return in words where the largest connected part of some cells is; there is one at least."""
    parts = numbered_regions(left)
    rows, columns = np.nonzero(parts == np.bincount(parts[left]).argmax())
    return f"rows {rows.min()} to {rows.max()}, columns {columns.min()} to {columns.max()}"


if __name__ == "__main__":
    sys.exit(judged(check))
