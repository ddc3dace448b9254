"""What a tool sweeps, and what a change of its way would leave: against counting all cells."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.planning.coverage.passes.sweep import (
    left_without,
    room_for_legs,
    set_leg,
    sweep_leg,
    unswept,
)

Floats = NDArray[np.float64]
RADIUS = 5.0


def counted(legs: Floats, shape: tuple[int, int]) -> NDArray[np.int16]:
    counts = np.zeros(shape, np.int16)
    for x, y, to_x, to_y in legs.tolist():
        sweep_leg(counts, x, y, to_x, to_y, RADIUS, 1)
    return counts


@pytest.mark.parametrize(
    "leg", [(10, 12, 31, 20.5), (31, 20.5, 10, 12), (20.3, 9, 20.3, 30), (25, 17.4, 25, 17.4)]
)
def test_a_leg_sweeps_the_cells_within_reach_of_it(leg: tuple[float, ...]) -> None:
    counts = counted(np.array([leg]), (40, 50))
    from_x, from_y, to_x, to_y = leg
    y, x = np.mgrid[:40, :50].astype(float)
    square = max((to_x - from_x) ** 2 + (to_y - from_y) ** 2, 1e-9)
    along = (x - from_x) * (to_x - from_x) + (y - from_y) * (to_y - from_y)
    share = np.clip(along / square, 0.0, 1.0)
    away = np.hypot(x - from_x - share * (to_x - from_x), y - from_y - share * (to_y - from_y))
    assert np.array_equal(counts > 0, away <= RADIUS + 1e-6)


def test_what_no_line_sweeps_is_left() -> None:
    need = np.zeros((30, 30), np.bool_)
    need[5, 5] = need[25, 25] = True
    left = unswept(need, [np.array([[4.0, 2.0], [4.0, 20.0]])], RADIUS)
    assert np.argwhere(left).tolist() == [[25, 25]]


@pytest.mark.parametrize("seed", range(20))
def test_what_a_change_leaves_is_what_counting_anew_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = (60, 70)
    need = rng.random(shape) < 0.7
    others, old, new = (rng.uniform(0.0, 60.0, (n, 4)) for n in (3, 2, 2))
    counts = counted(np.concatenate((others, old)), shape)
    legs = room_for_legs()
    for at, (x, y, to_x, to_y) in enumerate(np.concatenate((old, new)).tolist()):
        set_leg(legs, at, x, y, to_x, to_y)
    before = need & (counts == 0)
    after = need & (counted(np.concatenate((others, new)), shape) == 0)
    expected = int(after.sum()) - int(before.sum())
    assert left_without(need, counts, legs, 2, 4, RADIUS, np.inf) == expected
