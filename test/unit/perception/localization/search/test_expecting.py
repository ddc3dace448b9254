"""Where the robot is expected when places are compared."""

from __future__ import annotations

import pytest
from fixtures.robots.located import CONFIG

from roomba.geometry import Pose
from roomba.perception.localization.search.expecting import (
    searched_for,
    where_found_near,
    where_known,
    where_told,
)

HERE = Pose(1.0, 2.0, 0.5)
LOCALIZATION = CONFIG.localization


def test_the_less_sure_it_was_told_the_wider_it_is_looked_for() -> None:
    sure = where_told(HERE, (0.01, 0.01), LOCALIZATION)
    unsure = where_told(HERE, (0.5, 0.3), LOCALIZATION)
    assert sure.is_met(Pose(1.3, 2.0, 0.5))
    assert not sure.is_met(Pose(2.2, 2.0, 0.5))
    assert unsure.is_met(Pose(2.2, 2.0, 0.5))
    assert (unsure.radius, unsure.turn) == pytest.approx((1.5, 0.9))


def test_where_it_was_it_is_expected_closely_and_all_the_more_if_it_was_not_carried() -> None:
    still, moved = (where_known(HERE, LOCALIZATION, is_still=each) for each in (True, False))
    assert still.is_met(Pose(1.03, 2.0, 0.5))
    assert not still.is_met(Pose(1.1, 2.0, 0.5))
    assert still.evidence > moved.evidence > LOCALIZATION.needed_evidence


def test_a_place_found_near_by_has_less_evidence_than_one_that_was_known() -> None:
    found, known = (
        where_found_near(HERE, LOCALIZATION),
        where_known(HERE, LOCALIZATION, is_still=False),
    )
    assert found.is_met(HERE)
    assert not found.is_met(Pose(1.1, 2.0, 0.5))
    assert 0.0 < found.evidence < known.evidence


def test_the_longer_it_looks_around_the_wider() -> None:
    before = where_known(HERE, LOCALIZATION, is_still=False)
    after = searched_for(before, Pose(3.0, 2.0, 0.5), 10.0, LOCALIZATION)
    assert after.is_met(Pose(3.1, 2.0, 0.5))
    assert not after.is_met(HERE)
    assert after.evidence == before.evidence
