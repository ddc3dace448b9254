"""Rows five apart, the nearest end next, by shortest ways."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np

_spec = importlib.util.spec_from_file_location("way", Path(__file__).with_name("shortest_path.py"))
assert _spec is not None
assert _spec.loader is not None
_way = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_way)

Cell = tuple[int, int]


def coverage_path(free: Any, start: Cell) -> list[Cell]:
    rows = np.flatnonzero(free.any(axis=1))
    chosen = sorted({*range(int(rows[0]), int(rows[-1]), 5), int(rows[-1])})
    pieces = []
    for row in chosen:
        columns = np.flatnonzero(free[row])
        for part in np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1):
            pieces.append([(row, int(part[0])), (row, int(part[-1]))])
    pieces += edges_of(free)
    way: list[Cell] = [start]
    while pieces:
        ends = [
            (abs(end[0] - way[-1][0]) + abs(end[1] - way[-1][1]), number, which)
            for number, piece in enumerate(pieces)
            for which, end in ((0, piece[0]), (1, piece[-1]))
        ]
        _, number, which = min(ends)
        piece = pieces.pop(number)[:: 1 if which == 0 else -1]
        way += _way.shortest_path(free, way[-1], piece[0])[1:] + piece[1:]
    return way


def edges_of(free: Any) -> list[list[Cell]]:
    """Return columns along whose sides what is not free begins: ends of rows leave it."""
    pieces = []
    for column in range(1, free.shape[1] - 1):
        for beside in (-1, 1):
            edge = free[:, column] & ~free[:, column + beside]
            cells = np.flatnonzero(edge)
            for part in np.split(cells, np.flatnonzero(np.diff(cells) > 1) + 1):
                if len(part) > 4:
                    pieces.append([(int(part[0]), column), (int(part[-1]), column)])
    return pieces
