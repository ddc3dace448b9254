"""Carpets that the brush felt: votes of places, outlines, and how both change."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from roomba.geometry import Pose
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.rooms.felt_carpets import MOST_CORNERS, CarpetVotes, FeltCarpets

FLOOR = OccupancyMap(GridFrame(0.05, -1.0, -0.5, 80, 120), np.zeros((80, 120), np.int8))
"""6 x 4 m."""
CARPET = (1.0, 0.6, 2.4, 1.4)
"""m; lowest x and y, highest x and y: on the sides of cells."""
TICK = 0.015
"""m between two ticks at 0.3 m/s."""


def swaths(x_min: float, x_max: float) -> list[NDArray[np.float64]]:
    """The floor driven in rows 0.2 m apart: each tick's place."""
    x = np.arange(x_min, x_max, TICK)
    rows = np.arange(0.1, 2.0, 0.2)
    return [np.column_stack((x, np.full(x.shape, y))) for y in rows]


def drive(votes: CarpetVotes, carpet: tuple[float, float, float, float] | None = CARPET) -> None:
    """Drive over the floor; what is felt changes where the carpet begins and ends."""
    for places in swaths(-0.5, 4.0):
        is_on = np.zeros(len(places), np.bool_)
        if carpet is not None:
            x, y = places.T
            x_min, y_min, x_max, y_max = carpet
            is_on = (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
        for part in np.split(np.arange(len(places)), np.flatnonzero(np.diff(is_on)) + 1):
            votes.note(places[part], is_on=bool(is_on[part[0]]))


def overlap(felt: FeltCarpets, carpet: tuple[float, float, float, float] = CARPET) -> float:
    """The share of floor in one of both that is in both."""
    outline = shapely.union_all([shapely.Polygon(corners) for corners in felt.all])
    true = shapely.box(*carpet)
    return float(outline.intersection(true).area / outline.union(true).area)


def test_a_carpet_is_known_to_a_cell_once_it_was_driven_over() -> None:
    votes = CarpetVotes(FLOOR)
    assert votes.felt == FeltCarpets()
    drive(votes)
    assert len(votes.felt.all) == 1
    assert overlap(votes.felt) > 0.85


def test_one_that_was_taken_away_is_forgotten_and_another_is_found() -> None:
    votes = CarpetVotes(FLOOR)
    drive(votes)
    moved = (2.6, 0.2, 3.6, 1.6)
    for _ in range(3):
        drive(votes, moved)
    assert len(votes.felt.all) == 1
    assert overlap(votes.felt, moved) > 0.85
    for _ in range(3):
        drive(votes, None)
    # It is noticed when the robot leaves a carpet next.
    votes.note(np.array([[3.8, 0.1]]), is_on=True)
    votes.note(np.array([[3.9, 0.1]]), is_on=False)
    assert votes.felt.all == ()


def test_what_is_known_is_the_same_object_until_it_changes() -> None:
    votes = CarpetVotes(FLOOR)
    drive(votes)
    first = votes.felt
    drive(votes)
    assert votes.felt is first


def test_a_sill_is_no_carpet() -> None:
    votes = CarpetVotes(FLOOR)
    drive(votes, (1.0, 0.0, 1.1, 0.5))
    assert votes.felt.all == ()


def test_former_lives_count_until_they_are_voted_down() -> None:
    before = CarpetVotes(FLOOR)
    drive(before)
    votes = CarpetVotes(FLOOR)
    votes.recall(before.felt)
    assert votes.felt is before.felt
    drive(votes)
    assert overlap(votes.felt) > 0.85
    votes.recall(FeltCarpets())
    for _ in range(4):
        drive(votes, None)
    votes.note(np.array([[3.8, 0.1]]), is_on=True)
    votes.note(np.array([[3.9, 0.1]]), is_on=False)
    assert votes.felt.all == ()


def test_they_go_over_to_another_map_of_the_home() -> None:
    votes = CarpetVotes(FLOOR)
    drive(votes)
    other = OccupancyMap(GridFrame(0.05, 1.0, -0.5, 80, 120), np.zeros((80, 120), np.int8))
    carried = votes.carried_to(other, Pose(2.0, 0.0, 0.0))
    assert overlap(carried.felt, (3.0, 0.6, 4.4, 1.4)) > 0.85


def test_places_off_the_map_are_passed_over() -> None:
    votes = CarpetVotes(FLOOR)
    for far in (-50.0, 50.0):
        votes.note(np.array([[far, 0.0], [0.0, far]]), is_on=True)
    assert not votes.votes.any()


def test_of_an_outline_with_very_many_corners_the_box_around_it_is_told() -> None:
    size = 4 * MOST_CORNERS
    frame = GridFrame(0.05, 0.0, 0.0, 40, 2 * size)
    votes = CarpetVotes(OccupancyMap(frame, np.zeros(frame.shape, np.int8)))
    # A comb.
    votes.votes[0:2] = 10
    votes.votes[2:10, ::4] = votes.votes[2:10, 1::4] = 10
    votes.note(np.array([[0.5, 1.9]]), is_on=True)
    votes.note(np.array([[0.5, 1.9]]), is_on=False)
    (corners,) = votes.felt.all
    assert len(corners) == 4
    assert shapely.Polygon(corners).area == pytest.approx(1.0 * 0.1 * size, rel=0.02)
