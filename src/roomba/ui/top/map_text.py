"""The map in characters: walls, floor, what was swept, the way ahead, the station, the robot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from rich.text import Text

from roomba.ui.top.grids import Grid

UNKNOWN, FREE, SWEPT, WAY, WALL, STATION = " ", ".", "▒", "·", "█", "S"
ROBOT: Final = ("▶", "◥", "▲", "◤", "◀", "◣", "▼", "◢")
"""By the heading, in eighths of a turn counter-clockwise from the x axis."""
LEGEND: Final = f"{WALL} wall  {FREE} floor  {SWEPT} swept  {WAY} way  {STATION} station  ▲ robot"
_STYLES: Final = {
    FREE: "bright_black",
    SWEPT: "green",
    WAY: "cyan",
    WALL: "grey50",
    STATION: "bold yellow",
    **dict.fromkeys(ROBOT, "bold red"),
}
_ASPECT: Final = 2.0
"""How many times a character is higher than it is wide."""
_WALL_CELL, _FREE_CELL = 2, 1
"""Codes of the layer of the map."""


class _Canvas:
    """Characters over a part of the floor; each is ``step`` m wide, and twice as high."""

    def __init__(self, grid: Grid, columns: int, rows: int) -> None:
        """Choose the scale at which all that is known fits."""
        x, y = grid.centres(grid.cells != 0)
        half = 0.5 * grid.resolution
        self.left, self.top = float(x.min()) - half, float(y.max()) + half
        width, height = float(x.max()) + half - self.left, self.top - float(y.min()) + half
        self.step = max(width / columns, height / (_ASPECT * rows), 0.5 * grid.resolution)
        self.columns = max(1, min(columns, math.ceil(width / self.step - 1e-9)))
        self.rows = max(1, min(rows, math.ceil(height / (_ASPECT * self.step) - 1e-9)))
        self.characters = np.full((self.rows, self.columns), UNKNOWN)

    def places(
        self, x: NDArray[np.float64], y: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return row and column of points, m; of those that are on it."""
        columns = np.floor((x - self.left) / self.step).astype(np.int64)
        rows = np.floor((self.top - y) / (_ASPECT * self.step)).astype(np.int64)
        inside = (columns >= 0) & (columns < self.columns) & (rows >= 0) & (rows < self.rows)
        return rows[inside], columns[inside]

    def counts(self, grid: Grid, chosen: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Return how many of the chosen cells each character has, int64 [rows, columns]."""
        rows, columns = self.places(*grid.centres(chosen))
        found = np.bincount(rows * self.columns + columns, minlength=self.rows * self.columns)
        return found.reshape(self.rows, self.columns)

    def put(self, x: float, y: float, character: str) -> None:
        """Draw one character at a point, m, if it is on it."""
        rows, columns = self.places(np.array([x]), np.array([y]))
        self.characters[rows, columns] = character


def map_text(
    grids: Mapping[str, Grid],
    state: Mapping[str, Any],
    home: Mapping[str, Any],
    size: tuple[int, int],
) -> Text:
    """Return the map in ``size`` columns and rows at most; says so while there is none.

    ``state`` and ``home`` are those of the API.
    """
    grid = grids.get("map")
    if grid is None or not grid.cells.any() or min(size) < 1:
        return Text("no map yet")
    canvas = _Canvas(grid, *size)
    free = canvas.counts(grid, grid.cells == _FREE_CELL)
    canvas.characters[free > 0] = FREE
    coverage = grids.get("coverage")
    if coverage is not None:
        cells = coverage.cells > 0
        share = canvas.counts(coverage, cells) * coverage.resolution**2
        canvas.characters[2.0 * share >= np.maximum(free, 1) * grid.resolution**2] = SWEPT
    way = np.array(state.get("path") or [], np.float64).reshape(-1, 2) / 100.0
    canvas.characters[canvas.places(way[:, 0], way[:, 1])] = WAY
    canvas.characters[canvas.counts(grid, grid.cells == _WALL_CELL) > 0] = WALL
    if home.get("station"):
        canvas.put(home["station"][0], home["station"][1], STATION)
    if state.get("pose"):
        x, y, heading = state["pose"]
        canvas.put(x, y, ROBOT[round(heading / (math.tau / len(ROBOT))) % len(ROBOT)])
    return _styled(canvas.characters)


def _styled(characters: NDArray[np.str_]) -> Text:
    text = Text(no_wrap=True)
    for number, row in enumerate(characters.tolist()):
        text.append("\n" if number else "")
        for character in row:
            text.append(character, _STYLES.get(character, ""))
    return text
