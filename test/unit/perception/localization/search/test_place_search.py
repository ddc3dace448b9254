"""Searching a map: where it looks, what a place scores, and that the right one is found."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.robots.located import CONFIG, FURNISHED, LIDAR, SQUARE, TWO_ROOMS, Eye, free_poses
from numpy.typing import NDArray

from roomba.geometry import Pose, wrap_angle
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba.perception.localization.search import place_search
from roomba.perception.localization.search.place_search import BEAMS, STEP, TURN, PlaceSearch
from roomba.perception.localization.search.search_kernels import score_heading
from roomba.perception.matching.surface_field import SurfaceField
from roomba.world.home.home import Home

RADIUS = CONFIG.body.radius


def search(home: Home, pose: Pose, most: int = 30) -> NDArray[np.float64]:
    view = LIDAR.view(Eye(home).scan(pose))
    searched = PlaceSearch(SurfaceField.of(home.map), view.ends, RADIUS)
    for _ in range(1000):
        if searched.advance():
            return searched.best(most)
    raise AssertionError("the search does not end")


def nearest(found: NDArray[np.float64], pose: Pose) -> int:
    """Return the rank of the first place from which a match finds its way to a pose."""
    for rank, (x, y, theta) in enumerate(found.tolist()):
        if pose.distance_to(x, y) < STEP and abs(wrap_angle(theta - pose.theta)) < TURN:
            return rank
    return len(found)


@pytest.mark.parametrize("home", [FURNISHED, TWO_ROOMS])
def test_the_right_place_is_among_the_best(home: Home) -> None:
    for pose in free_poses(home, 8, np.random.default_rng(5)):
        assert nearest(search(home, pose), pose) < 10


def test_in_a_square_all_four_sides_are_among_the_best() -> None:
    found = search(SQUARE, Pose(1.0, 1.2, 0.3))
    middle = Pose(1.5, 1.5, 0.0)
    for quarter in range(4):
        turn = Pose(0.0, 0.0, 0.5 * math.pi * quarter)
        there = middle.compose(turn).compose(middle.inverse()).compose(Pose(1.0, 1.2, 0.3))
        assert nearest(found, there) < 15


def test_the_best_comes_first_and_no_more_than_asked_for() -> None:
    pose = Pose(1.2, 1.0, 0.3)
    few, many = search(FURNISHED, pose, most=5), search(FURNISHED, pose, most=100_000)
    assert few.shape == (5, 3)
    assert few.tolist() == many[:5].tolist()
    assert 100 < len(many) < 1000


def test_only_places_with_room_for_the_body_are_tried_and_narrow_ones_too() -> None:
    """A passage of 40 cm, one cell wide for the body's middle, however the blocks of cells lie."""
    for shift in range(4):
        values = np.full((30, 60), OCCUPIED, np.int8)
        values[8 + shift : 16 + shift, 2:-2] = FREE
        frame = GridFrame(0.05, 0.0, 0.0, 30, 60)
        field = SurfaceField.of(OccupancyMap(frame, values))
        ends = LIDAR.view(np.full(360, 0.3, np.float32)).ends
        searched = PlaceSearch(field, ends, RADIUS)
        while not searched.advance():
            pass
        found = searched.best(1000)
        low, high = (8 + shift) * 0.05, (16 + shift) * 0.05
        assert found[:, 1].min() >= low + 0.9 * RADIUS - 0.03
        assert found[:, 1].max() <= high - 0.9 * RADIUS + 0.03
        along = np.sort(found[:, 0])
        assert along[0] < 0.5
        assert along[-1] > 2.5
        assert np.diff(along).max() < 2.5 * STEP


def test_without_room_or_beams_nothing_is_found() -> None:
    solid = np.full((20, 20), OCCUPIED, np.int8)
    field = SurfaceField.of(OccupancyMap(GridFrame(0.05, 0.0, 0.0, 20, 20), solid))
    ends = LIDAR.view(np.ones(360, np.float32)).ends
    searched = PlaceSearch(field, ends, RADIUS)
    assert searched.advance()
    assert searched.best(10).shape == (0, 3)


def test_where_no_beam_ends_near_a_surface_nothing_is_found() -> None:
    view = LIDAR.view(np.full(360, 11.0, np.float32))
    searched = PlaceSearch(SurfaceField.of(SQUARE.map), view.ends, RADIUS)
    while not searched.advance():
        pass
    assert searched.best(10).shape == (0, 3)


def test_a_search_in_many_pieces_finds_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    pose = Pose(1.2, 1.0, 2.9)
    at_once = search(FURNISHED, pose)
    monkeypatch.setattr(place_search, "PIECE", 4000)
    assert search(FURNISHED, pose).tolist() == at_once.tolist()
    view = LIDAR.view(Eye(FURNISHED).scan(pose))
    searched = PlaceSearch(SurfaceField.of(FURNISHED.map), view.ends, RADIUS)
    advances = 1
    while not searched.advance():
        advances += 1
    assert advances > 10


def scores(
    spots: list[tuple[float, float]], theta: float, ends: NDArray[np.float64]
) -> list[float]:
    field = SurfaceField.of(SQUARE.map)
    found = np.zeros(len(spots), np.float32)
    headings = np.zeros(len(spots), np.float32)
    chosen = np.arange(len(ends))
    score_heading(
        field.values, field.place, ends, chosen, np.array(spots), theta, 0.35, found, headings
    )
    return list(found)


def test_a_beam_counts_the_less_the_farther_off_a_surface_it_ends() -> None:
    """From the middle of a room of 3 m, one beam ahead: at 25 mm from the wall in the last cell."""
    for length, expected in ((1.475, 0.025), (1.375, 0.125), (1.225, 0.275), (1.525, 0.025)):
        ends = np.array([[length, 0.0, 1.0, 0.0]])
        assert scores([(1.5, 1.51)], 0.0, ends)[0] == pytest.approx(1.0 - expected / 0.35, abs=1e-3)
    assert scores([(1.5, 1.51)], 0.0, np.array([[0.9, 0.0, 1.0, 0.0]])) == [0.0]
    assert scores([(1.5, 1.51)], 0.0, np.array([[90.0, 0.0, 1.0, 0.0]])) == [0.0]


def test_where_the_scan_was_taken_nearly_all_beams_count_in_full() -> None:
    pose = Pose(1.1, 1.3, 0.4)
    view = LIDAR.view(Eye(SQUARE).scan(pose))
    ends = view.ends[np.linspace(0, len(view) - 1, BEAMS).astype(int)]
    right, turned, beside = (
        scores([(1.1, 1.3)], 0.4, ends)[0],
        scores([(1.1, 1.3)], 0.9, ends)[0],
        scores([(1.7, 1.9)], 0.4, ends)[0],
    )
    assert right > 0.85 * BEAMS
    assert max(turned, beside) < 0.6 * BEAMS


def test_the_best_heading_so_far_is_kept() -> None:
    field = SurfaceField.of(SQUARE.map)
    view = LIDAR.view(Eye(SQUARE).scan(Pose(1.1, 1.3, 0.4)))
    kept, headings = np.zeros(1, np.float32), np.zeros(1, np.float32)
    chosen = np.arange(0, len(view), 8)
    best = []
    for theta in (0.1, 0.4, 0.7, 2.5):
        score_heading(
            field.values,
            field.place,
            view.ends,
            chosen,
            np.array([[1.1, 1.3]]),
            theta,
            0.35,
            kept,
            headings,
        )
        best.append(float(kept[0]))
    assert best == sorted(best)
    assert headings[0] == pytest.approx(0.4)
