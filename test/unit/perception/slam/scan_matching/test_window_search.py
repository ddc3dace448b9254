"""The search finds the same as trying all poses of the window, also beside a pose to leave out."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from fixtures.robots.mapped import Floats
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.perception.slam.scan_matching.likelihood_field import (
    FULL,
    LikelihoodField,
    likelihood_field,
)
from roomba.perception.slam.scan_matching.window_search import search

AROUND = np.array([0.12, -0.07, 0.3])
WINDOW, TURN, STEP = 0.4, 0.05, 0.02
REACH, TURNS = 8, 3
"""Cells and steps of that window."""


def score(field: LikelihoodField, points: Floats, right: int, up: int, turn: int) -> float:
    """The mean likelihood of points at a pose of the window."""
    theta = AROUND[2] + turn * STEP
    rotation = np.array(((math.cos(theta), -math.sin(theta)), (math.sin(theta), math.cos(theta))))
    cells = np.floor((AROUND[:2] + points @ rotation.T - field.corner) / field.cell).astype(int)
    columns, rows = cells[:, 0] + right, cells[:, 1] + up
    grid = field.levels[0]
    is_inside = (rows >= 0) & (rows < grid.shape[0]) & (columns >= 0) & (columns < grid.shape[1])
    return float(grid[rows[is_inside], columns[is_inside]].sum()) / (FULL * len(points))


@given(st.integers(0, 10_000), st.integers(1, 12), st.booleans())
@settings(max_examples=examples(30), deadline=None)
def test_it_finds_the_best_of_all_poses(seed: int, count: int, is_beside: bool) -> None:
    random = np.random.default_rng(seed)
    field = likelihood_field(np.column_stack((random.uniform(-1.0, 1.0, (9, 2)), np.zeros((9, 2)))))
    points, found = random.uniform(-1.0, 1.0, (count, 2)), np.empty(4)
    beside = np.array([0.1, -0.05, 0.22 if is_beside else 0.0])
    scores = [
        score(field, points, right, up, turn)
        for right, up in product(range(-REACH, REACH + 1), repeat=2)
        for turn in range(-TURNS, TURNS + 1)
        if math.hypot(right * field.cell - 0.1, up * field.cell + 0.05) >= beside[2]
    ]
    is_found = search(field, points, AROUND, WINDOW, TURN, STEP, 0.0, beside, found)
    assert is_found == (max(scores) > 0.0)
    if not is_found:
        return
    assert found[3] == max(scores)
    right, up = np.round((found[:2] - AROUND[:2]) / field.cell).astype(int)
    assert score(field, points, right, up, round((found[2] - AROUND[2]) / STEP)) == found[3]
    assert math.hypot(*(found[:2] - AROUND[:2] - beside[:2])) >= beside[2] - 1e-9
    # What is not better than the least that is asked for is not found.
    assert not search(field, points, AROUND, WINDOW, TURN, STEP, found[3], beside, found)
