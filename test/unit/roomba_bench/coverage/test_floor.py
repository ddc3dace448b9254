"""The evaluator of coverage, against one that looks at each cell by itself."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.grid import GridFrame
from roomba_bench.coverage.floor import (
    REACH,
    TOOL,
    Disc,
    Reachable,
    exact_share,
    first_swept,
    length,
    patches,
    reachable,
    share_over_time,
    swept_share,
    turning,
    turning_at_corners,
)

Mask = NDArray[np.bool_]


def frame_of(rows: int, columns: int) -> GridFrame:
    return GridFrame(0.05, -0.3, 0.7, rows, columns)


def room(rows: int, columns: int) -> Mask:
    """A room with a wall of one cell around it."""
    solid = np.ones((rows, columns), np.bool_)
    solid[1:-1, 1:-1] = False
    return solid


def by_hand(solid: Mask, frame: GridFrame, start: tuple[float, float], things: list[Disc]) -> Mask:
    """The floor that can be swept, cell by cell: what :func:`reachable` must find."""
    cell = frame.resolution / 5
    fine = np.kron(solid, np.ones((5, 5), np.bool_)).astype(bool)
    walls = np.argwhere(np.pad(fine, 1, constant_values=True)) - 1
    fits = np.zeros(fine.shape, np.bool_)
    for row, column in np.argwhere(~fine):
        x = frame.origin_x + (column + 0.5) * cell
        y = frame.origin_y + (row + 0.5) * cell
        away = np.sqrt(((walls - (row, column)) ** 2).sum(axis=1).min()) * cell
        free = all(math.hypot(x - a, y - b) >= r + REACH - 0.5 * cell for a, b, r in things)
        fits[row, column] = away >= REACH - 1e-9 and free
    here = min(
        np.argwhere(fits).tolist(),
        key=lambda at: math.hypot(
            frame.origin_x + (at[1] + 0.5) * cell - start[0],
            frame.origin_y + (at[0] + 0.5) * cell - start[1],
        ),
    )
    reached, todo = {tuple(here)}, [tuple(here)]
    while todo:
        row, column = todo.pop()
        for at in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if fits[at] and at not in reached:
                reached.add(at)
                todo.append(at)
    middles = np.array(sorted(reached))
    floor = np.zeros(fine.shape, np.bool_)
    for row, column in np.argwhere(~fine):
        nearest = np.sqrt(((middles - (row, column)) ** 2).sum(axis=1).min()) * cell
        floor[row, column] = nearest <= TOOL / 2 + 1e-9
    return floor


def swept_by_hand(floor: Reachable, points: NDArray[np.float64]) -> NDArray[np.int32]:
    """When each cell is first swept, cell by cell."""
    first = np.full(floor.frame.shape, -1, np.int32)
    legs = [(points[0], points[0]), *pairwise(points)]
    for row in range(floor.frame.rows):
        for column in range(floor.frame.columns):
            at = np.array(floor.frame.centre_of(row, column))
            for number, (begin, end) in enumerate(legs):
                along = end - begin
                square = float(along @ along)
                share = min(max(float((at - begin) @ along) / square, 0.0), 1.0) if square else 0.0
                if np.hypot(*(at - begin - share * along)) <= TOOL / 2 + 1e-9:
                    first[row, column] = number
                    break
    return first


@pytest.mark.parametrize("seed", range(2))
def test_floor_is_that_found_cell_by_cell(seed: int) -> None:
    random = np.random.default_rng(seed)
    solid = room(15, 18)
    solid[tuple(random.integers(1, 14, (2, 3)))] = True
    frame = frame_of(*solid.shape)
    found = reachable(solid, frame, (0.0, 1.0))
    np.testing.assert_array_equal(found.floor, by_hand(solid, frame, (0.0, 1.0), []))


def test_thing_takes_its_place_and_the_floor_beside_it_counts() -> None:
    solid = room(20, 20)
    frame = frame_of(*solid.shape)
    thing = (0.2, 1.2, 0.05)
    found = reachable(solid, frame, (0.0, 1.0), [thing])
    np.testing.assert_array_equal(found.floor, by_hand(solid, frame, (0.0, 1.0), [thing]))
    row, column = found.frame.cell_of(0.2, 1.2)
    # The body keeps 0.165 from the rim, the tool reaches 0.10 towards it.
    assert not found.floor[row, column + 9]
    assert found.floor[row, column + 13]


def test_other_side_of_a_wall_cannot_be_reached() -> None:
    solid = room(20, 40)
    solid[:, 20] = True
    frame = frame_of(*solid.shape)
    left, right = reachable(solid, frame, (0.2, 1.2)), reachable(solid, frame, (1.3, 1.2))
    assert left.area > 0.3
    assert right.area > 0.3
    assert not (left.floor & right.floor).any()


@pytest.mark.parametrize(("gap", "is_way"), [(0.35, False), (0.40, True)])
def test_way_beside_what_the_map_does_not_show_wants_more_room(gap: float, is_way: bool) -> None:
    solid = room(20, 60)
    unknown = np.zeros_like(solid)
    cells = round(gap / 0.05)
    unknown[1 : 19 - cells, 30] = True
    frame = frame_of(*solid.shape)
    known = reachable(solid | unknown, frame, (0.2, 1.2))
    found = reachable(solid | unknown, frame, (0.2, 1.2), (), unknown)
    assert known.floor[:, 200:].any()
    assert found.floor[:, 200:].any() == is_way
    if is_way:
        np.testing.assert_array_equal(found.floor, known.floor)


def test_no_floor_is_an_error() -> None:
    with pytest.raises(ValueError, match="expected a floor"):
        reachable(np.ones((9, 9), np.bool_), frame_of(9, 9), (0.0, 1.0))


@pytest.mark.parametrize("seed", range(3))
def test_cells_are_swept_when_their_middle_is_met(seed: int) -> None:
    floor = reachable(room(10, 12), frame_of(10, 12), (0.0, 0.9))
    points = np.random.default_rng(seed).uniform((-0.4, 0.6), (0.4, 1.3), (6, 2))
    points[3] = points[2]
    np.testing.assert_array_equal(first_swept(floor.frame, points), swept_by_hand(floor, points))


def test_share_grows_to_all_of_the_floor() -> None:
    floor = reachable(room(20, 20), frame_of(20, 20), (0.0, 1.0))
    x, y = np.meshgrid(np.arange(-0.1, 0.51, 0.01), np.arange(0.9, 1.51, 0.05))
    x[1::2] = x[1::2, ::-1]
    points = np.column_stack([x.ravel(), y.ravel()])
    shares = share_over_time(floor, points)
    assert (np.diff(shares) >= 0.0).all()
    assert shares[-1] == pytest.approx(swept_share(floor, points), abs=0.002)
    assert exact_share(floor, points) > 0.95
    assert shares[-1] > 0.98
    assert shares[0] < 0.2
    assert len(shares) == len(points)


def test_drawn_way_is_half_a_cell_off_at_most() -> None:
    floor = reachable(room(20, 20), frame_of(20, 20), (0.0, 1.0))
    points = np.random.default_rng(1).uniform((-0.1, 0.9), (0.5, 1.5), (30, 2))
    narrow = np.count_nonzero((first_swept(floor.frame, points, TOOL - 0.015) >= 0) & floor.floor)
    wide = np.count_nonzero((first_swept(floor.frame, points, TOOL + 0.015) >= 0) & floor.floor)
    swept = swept_share(floor, points) * np.count_nonzero(floor.floor)
    assert narrow <= swept <= wide


def test_way_and_turns() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert length(square) == pytest.approx(3.0)
    assert turning_at_corners(square) == pytest.approx(math.pi)
    assert turning(np.array([3.1, -3.1, 3.1])) == pytest.approx(2.0 * (2.0 * math.pi - 6.2))


def test_patches_are_those_that_are_large_enough() -> None:
    mask = np.zeros((20, 20), np.bool_)
    mask[2:6, 2:6] = mask[10:12, 10:20] = mask[18, 18] = True
    frame = GridFrame(0.01, 1.0, 2.0, 20, 20)
    found = patches(frame, mask, 0.001)
    assert [round(patch.area, 6) for patch in found] == [0.002, 0.0016]
    assert (found[1].x, found[1].y) == pytest.approx((1.04, 2.04))
