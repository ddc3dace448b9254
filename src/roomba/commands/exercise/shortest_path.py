"""Checks ``shortest_path(free, start, goal)``: on floors of a few cells, and on a home's map."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from roomba.arrays import Mask
from roomba.commands.exercise.verdict import NotYetError, expect, function_of, judged
from roomba.configuration.body import BodyConfig
from roomba.files.shipped import HOMES
from roomba.world.home.raster import where_body_fits
from roomba.world.layers.layer import load_home

Cell: TypeAlias = tuple[int, int]

_SMALL: Final = (
    ("a straight row", ["....."], (0, 0), (0, 4)),
    ("around a wall", [".....", "###..", ".....", "....."], (0, 0), (2, 0)),
    ("start and goal are one", ["..", ".."], (1, 1), (1, 1)),
    ("a maze", ["......", "#####.", "......", ".#####", "......"], (0, 0), (4, 5)),
)
_SHUT: Final = ("no way there", ["..#..", "..#..", "..#.."], (0, 0), (2, 4))
_TRIES: Final = 20


def check(file: Path) -> str:
    """Return what is right; raises NotYetError."""
    answer = function_of(file, "shortest_path")
    for name, rows, start, goal in _SMALL:
        _compare(answer, name, _floor(rows), start, goal)
    name, rows, start, goal = _SHUT
    came = answer(_floor(rows), start, goal)
    expect(came is None, f"{name}: expected None, got {came!r}")
    home = load_home("studio", HOMES)
    fits = where_body_fits(home.frame, home.solid, BodyConfig().diameter / 2.0)
    cells = [(int(row), int(column)) for row, column in np.argwhere(fits)]
    random = np.random.default_rng(4)
    for _ in range(_TRIES):
        one, other = (cells[int(number)] for number in random.integers(len(cells), size=2))
        if np.isfinite(_least(fits, one, other)):
            _compare(answer, f"in the home studio from {one} to {other}", fits, one, other)
    return f"{len(_SMALL) + 1} small floors and {_TRIES} ways through a home"


def _floor(rows: list[str]) -> Mask:
    return np.array([[sign == "." for sign in row] for row in rows])


def _compare(answer: Callable[..., Any], name: str, free: Mask, start: Cell, goal: Cell) -> None:
    """Raise NotYetError unless the answer is a way of the least number of steps."""
    way = answer(free.copy(), start, goal)
    if way is None:
        raise NotYetError(f"{name}: expected a way, got None")
    cells = [(int(row), int(column)) for row, column in way]
    expect(bool(cells) and cells[0] == start, f"{name}: expected it to begin at {start}")
    expect(cells[-1] == goal, f"{name}: expected it to end at {goal}, got {cells[-1]}")
    for one, other in itertools.pairwise(cells):
        step = abs(one[0] - other[0]) + abs(one[1] - other[1])
        expect(step == 1, f"{name}: {one} and {other} are no neighbours")
    for row, column in cells:
        inside = 0 <= row < free.shape[0] and 0 <= column < free.shape[1]
        expect(inside and bool(free[row, column]), f"{name}: {(row, column)} is not free")
    least = int(_least(free, start, goal))
    steps = len(cells) - 1
    expect(steps == least, f"{name}: {least} steps are enough, yours has {steps}")


def _least(free: Mask, start: Cell, goal: Cell) -> float:
    """Return the least number of steps, by the graph algorithms of scipy; infinite for no way."""
    numbers = np.arange(free.size).reshape(free.shape)
    pairs = [
        (numbers[:-1][free[:-1] & free[1:]], numbers[1:][free[:-1] & free[1:]]),
        (numbers[:, :-1][free[:, :-1] & free[:, 1:]], numbers[:, 1:][free[:, :-1] & free[:, 1:]]),
    ]
    one, other = (np.concatenate(each) for each in zip(*pairs, strict=True))
    graph = coo_matrix((np.ones(len(one)), (one, other)), shape=(free.size, free.size))
    lengths = dijkstra(graph.tocsr(), directed=False, indices=numbers[start], unweighted=True)
    return float(lengths[numbers[goal]])


if __name__ == "__main__":
    sys.exit(judged(check))
