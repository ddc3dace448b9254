"""Breadth-first search."""

from __future__ import annotations

from collections import deque
from typing import Any

Cell = tuple[int, int]


def shortest_path(free: Any, start: Cell, goal: Cell) -> list[Cell] | None:
    came: dict[Cell, Cell | None] = {start: None}
    todo = deque([start])
    while todo and goal not in came:
        row, column = todo.popleft()
        for near in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            inside = 0 <= near[0] < free.shape[0] and 0 <= near[1] < free.shape[1]
            if inside and free[near] and near not in came:
                came[near] = (row, column)
                todo.append(near)
    if goal not in came:
        return None
    way, at = [], goal
    while at is not None:
        way.append(at)
        at = came[at]  # type: ignore[assignment]
    return way[::-1]
