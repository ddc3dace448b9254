"""Homes that are not as their map shows them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.world.engine.state.arrays import MOST_DISCS
from roomba.world.home.home import Door, Home, Rectangle
from roomba_bench.coverage.changes import Change, changed, pushed_by, row_across
from roomba_bench.coverage.clean import home_named, true_floor


@pytest.fixture(scope="module")
def flat() -> Home:
    return home_named("flat")


@pytest.mark.parametrize("change", list(Change))
def test_seed_decides(flat: Home, change: Change) -> None:
    one, again, other = (changed(flat, change, seed) for seed in (3, 3, 4))
    assert one.things == again.things
    assert one.what == again.what
    np.testing.assert_array_equal(one.home.solid, again.home.solid)
    assert one.what != other.what


@pytest.mark.parametrize("change", list(Change))
@pytest.mark.parametrize("seed", range(3))
def test_map_stays_and_truth_changes(flat: Home, change: Change, seed: int) -> None:
    other = changed(flat, change, seed)
    assert other.home.map is flat.map
    assert other.things or not np.array_equal(other.home.solid, flat.solid)
    assert len(other.things) <= MOST_DISCS
    for x, y, radius in other.things:
        away = math.hypot(x - flat.station.x, y - flat.station.y) - radius
        assert away > 0.9
    for x, y, _ in other.things:
        assert not flat.map.solid[flat.frame.cell_of(x, y)]


def test_moved_furniture_keeps_about_its_size(flat: Home) -> None:
    for seed in range(2):
        solid = changed(flat, Change.FURNITURE, seed).home.solid
        new, gone = solid & ~flat.solid, flat.solid & ~solid
        assert new.any()
        assert gone.any()
        assert not (gone & flat.walls).any()


def test_pushed_piece_is_rigid(flat: Home) -> None:
    piece = next(piece for piece in flat.furniture if piece.kind == "chair")
    there = pushed_by(piece, 0.3, -0.2, 0.5)
    assert (there.pose.x, there.pose.y) == pytest.approx((piece.pose.x + 0.3, piece.pose.y - 0.2))
    for box, moved in zip(piece.boxes, there.boxes, strict=True):
        before = math.hypot(box.x - piece.pose.x, box.y - piece.pose.y)
        after = math.hypot(moved.x - there.pose.x, moved.y - there.pose.y)
        assert after == pytest.approx(before)
        assert moved.theta == pytest.approx(box.theta + 0.5)


@pytest.mark.parametrize("opening", [(1.0, 2.0, 1.9, 2.1), (1.0, 2.0, 1.1, 2.9)])
def test_no_robot_passes_between_things_across_a_doorway(
    opening: tuple[float, float, float, float],
) -> None:
    things = row_across(Door("door", Rectangle(*opening), True))
    along_x = opening[2] - opening[0] > 0.5
    at = sorted((x, radius) if along_x else (y, radius) for x, y, radius in things)
    ends = (opening[0], opening[2]) if along_x else (opening[1], opening[3])
    edges = [ends[0], *(edge for place, r in at for edge in (place - r, place + r)), ends[1]]
    gaps = [right - left for left, right in zip(edges[::2], edges[1::2], strict=True)]
    assert max(gaps) < 0.3


def test_shut_doors_cut_floor_off(flat: Home) -> None:
    staging = (0.65, 0.0)
    whole = true_floor(flat, staging).area
    for seed in range(2):
        other = changed(flat, Change.DOORS, seed)
        assert true_floor(other.home, staging, other.things).area < 0.9 * whole
