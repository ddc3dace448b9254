"""Dirty floor is swept once more: in passing, and at the end, where that is worth the way."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.driven_cleans import HERE, cleaning, context, drive

from roomba.configuration.mission import CleaningConfig, MissionConfig
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.perception.swept.dirt_map import DirtMap


def note_dirty_patch(dirt: DirtMap) -> None:
    """Six cells around (1.0, 0.5) are much dirtier than all others."""
    for x in (0.9, 1.1, 1.3):
        for y in (0.5, 0.7):
            dirt.note(x, y, 4000.0, 0.2)


def with_dirty_patch(config: CleaningConfig | None = None) -> Cleaning:
    """A clean that drove over all of HOME, and found six cells dirty."""
    place = context()
    dirt = DirtMap(place.occupancy)
    clean = cleaning(place=place, dirt=dirt, config=config)
    for y in np.arange(0.1, 2.4, 0.2):
        for x in np.arange(0.1, 2.9, 0.2):
            dirt.note(float(x), float(y), 20.0, 0.2)
    note_dirty_patch(dirt)
    points = clean.next_path(HERE, [])
    assert points is not None
    drive(clean, points)
    return clean


def test_where_it_was_very_dirty_it_cleans_once_more() -> None:
    clean = with_dirty_patch()
    again = clean.next_path(HERE, [])
    assert again is not None
    near = np.hypot(*(again - (1.0, 0.5)).T).min()
    assert near < 0.25
    assert float(np.hypot(*np.diff(again, axis=0).T).sum()) < 6.0
    drive(clean, again)
    # Once is enough.
    assert clean.next_path(HERE, []) is None


def test_dirty_floor_at_hand_is_cleaned_once_more_where_that_takes_the_least_way() -> None:
    clean = with_dirty_patch()
    swept, here, end = clean.ledger.coverage.fraction, Pose(1.0, 1.6, 0.0), (1.0, 2.2)
    rest = np.array([(1.0, 0.9), end])
    path = clean.dirty_at_hand(here, rest, [], 0.0)
    assert path is not None
    assert clean.ledger.coverage.fraction < swept
    assert path[0] == pytest.approx((here.x, here.y))
    assert path[-1] == pytest.approx(end)
    # It branches off after 0.7 m, where the path turns back, and not at once.
    assert (np.hypot(*(path - (1.0, 0.9)).T) < 0.05).sum() >= 2
    legs = float(np.hypot(*np.diff(path, axis=0).T).sum())
    assert 2.0 < legs < 2.0 + MissionConfig().cleaning.worth_way_again * 0.24
    drive(clean, path)
    assert clean.ledger.coverage.fraction == pytest.approx(swept, abs=0.001)
    # Neither again in passing nor at the end.
    assert clean.dirty_at_hand(here, rest, [], 0.0) is None
    assert clean.next_path(HERE, []) is None


def around_the_dirty_patch() -> list[RoundObstacle]:
    ring = [(x, y, 0.05) for x in np.arange(0.5, 1.8, 0.1) for y in (0.25, 1.05)]
    return ring + [(x, y, 0.05) for x in (0.5, 1.7) for y in np.arange(0.25, 1.1, 0.1)]


def test_dirty_floor_that_no_way_leads_to_is_left() -> None:
    here, rest = Pose(1.0, 1.6, 0.0), np.array([(1.0, 2.2)])
    clean = with_dirty_patch()
    assert clean.dirty_at_hand(here, rest, around_the_dirty_patch(), 0.0) is None
    clean = with_dirty_patch()
    swept = clean.ledger.coverage.fraction
    assert clean.next_path(here, around_the_dirty_patch()) is None
    assert clean.ledger.coverage.fraction == swept


def test_dirty_floor_that_is_not_worth_the_way_is_left_at_the_end() -> None:
    assert with_dirty_patch().next_path(HERE, []) is not None
    dear = MissionConfig().cleaning.model_copy(update={"worth_way_again": 0.1})
    assert with_dirty_patch(dear).next_path(HERE, []) is None
