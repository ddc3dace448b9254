"""The order of pieces, against all orders of few of them, and over floors of all kinds."""

from __future__ import annotations

import math
from itertools import pairwise, permutations, product

import numpy as np
import pytest
from fixtures.references.straight_ways import Mask, connected_to, turning_of
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.arrays import Floats, Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.planning.coverage.tour.net import net_over
from roomba.planning.coverage.tour.order import ordered

TURNING = 6.0


def cost(start: Floats, pieces: list[Polyline], end: Floats | None) -> float:
    """Of the connections on open floor: straight, and the turns at their ends."""
    stops = [start[None], *pieces] if end is None else [start[None], *pieces, end[None]]
    total = 0.0
    for one, other in pairwise(stops):
        way = np.concatenate((one[-2:], other[:2]))
        total += math.dist(one[-1].tolist(), other[0].tolist()) + TURNING * turning_of(way)
    return total


@st.composite
def few_pieces(draw: st.DrawFn) -> tuple[list[Polyline], Polyline, Polyline | None]:
    """Up to five straight pieces on open floor, where the way begins, and where it ends."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    pieces = [random.integers(2, 200, (2, 2)).astype(float) for _ in range(draw(st.integers(1, 5)))]
    assume(all(not np.array_equal(piece[0], piece[1]) for piece in pieces))
    start, end = random.integers(2, 200, (2, 2)).astype(float)
    return pieces, start, end if draw(st.booleans()) else None


@given(few_pieces())
@settings(max_examples=examples(40))
def test_few_pieces_are_ordered_hardly_worse_than_in_the_best_of_all_orders(
    drawn: tuple[list[Polyline], Polyline, Polyline | None],
) -> None:
    pieces, start, end = drawn
    net = net_over(np.ones((204, 204), np.bool_))
    found = ordered(net, pieces, start, end, CoverageConfig(turning=TURNING))
    assert names(found) == names(pieces)
    best = min(
        cost(start, [piece[::flip] for piece, flip in zip(order, flips, strict=True)], end)
        for order in permutations(pieces)
        for flips in product((1, -1), repeat=len(pieces))
    )
    # Fewer than four pieces are improved move by move, and not searched on.
    assert best - 0.1 <= cost(start, found, end) <= 1.25 * best + 0.1


def names(pieces: list[Polyline]) -> list[list[list[float]]]:
    """Pieces, whichever way round and in whichever order."""
    return sorted(min(piece.tolist(), piece[::-1].tolist()) for piece in pieces)


@given(st.integers(0, 2**32 - 1), st.integers(0, 40), st.booleans())
@settings(max_examples=examples(25))
def test_each_piece_is_driven_once_on_floors_of_all_kinds(
    seed: int, count: int, has_end: bool
) -> None:
    """Among boxes; some ends are seen from nowhere, because the floor is thin there."""
    random = np.random.default_rng(seed)
    fits = np.ones((90, 120), np.bool_)
    for _ in range(12):
        row, column = random.integers(0, (85, 115)).tolist()
        fits[row : row + 20, column : column + int(random.integers(1, 20))] = False
    part = one_part(fits)
    assume(part is not None)
    assert part is not None
    cells = np.argwhere(part)[:, ::-1].astype(float)
    pieces = [
        cells[random.integers(len(cells), size=int(random.integers(2, 4)))] for _ in range(count)
    ]
    start, end = cells[random.integers(len(cells), size=2)]
    found = ordered(net_over(part), pieces, start, end if has_end else None, CoverageConfig())
    assert names(found) == names(pieces)


def one_part(fits: Mask) -> Mask | None:
    """The part of a floor that is connected to its first cell."""
    cells = np.argwhere(fits).tolist()
    if not cells:
        return None
    row, column = cells[0]
    part = np.zeros_like(fits)
    for cell in connected_to(fits, (row, column)):
        part[cell] = True
    return part


@pytest.mark.parametrize("turning", [0.0, 6.0])
def test_the_same_pieces_come_in_the_same_order_each_time(turning: float) -> None:
    random = np.random.default_rng(8)
    pieces = [random.uniform(5.0, 195.0, (2, 2)) for _ in range(30)]
    net = net_over(np.ones((200, 200), np.bool_))
    start = np.array([3.0, 3.0])
    first, again = (
        ordered(net, pieces, start, None, CoverageConfig(turning=turning)) for _ in range(2)
    )
    assert all(np.array_equal(one, other) for one, other in zip(first, again, strict=True))


def test_without_pieces_there_is_no_order() -> None:
    assert (
        ordered(net_over(np.ones((9, 9), np.bool_)), [], np.zeros(2), None, CoverageConfig()) == []
    )
