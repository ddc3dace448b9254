from __future__ import annotations

import math

import pytest

from roomba.shares import share_of, whole_percent


@pytest.mark.parametrize(
    ("part", "whole", "share"),
    [(1.0, 4.0, 0.25), (4.0, 4.0, 1.0), (4.1, 4.0, 1.0), (0.0, 0.0, 1.0), (-0.1, 2.0, 0.0)],
)
def test_a_share_is_never_more_than_all(part: float, whole: float, share: float) -> None:
    assert share_of(part, whole) == share


def test_what_is_not_known_stays_so() -> None:
    assert math.isnan(share_of(math.nan, 1.0))
    assert math.isnan(share_of(1.0, math.nan))


@pytest.mark.parametrize(
    ("share", "percent"),
    [(0.0, 0), (0.291, 29), (0.29, 29), (0.9999, 99), (1.0, 100), (1.013, 100), (-0.2, 0)],
)
def test_a_hundred_percent_is_all_and_the_most(share: float, percent: int) -> None:
    assert whole_percent(share) == percent
