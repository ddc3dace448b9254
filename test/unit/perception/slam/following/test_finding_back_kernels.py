"""Which scans are searched for: those that fit nothing, and those that fit worse than is usual."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from roomba.configuration.mapping import FollowingConfig
from roomba.perception.slam.following.finding_back_kernels import FINDING, is_due, saw
from roomba.perception.slam.following.follow_kernels import FOLLOWER

USUAL, BAD = 0.9, 0.5


def is_searched_for(agreement: float, moved: float, *, is_sure: bool = True) -> bool:
    """Whether a scan is, taken ``moved``, m, after one that agreed as is usual."""
    config = FollowingConfig()
    finding: Any = np.zeros(1, FINDING).view(np.recarray)
    follower: Any = np.zeros(1, FOLLOWER).view(np.recarray)
    finding.doubtful, finding.pace_fades = config.doubtful, config.pace_fades
    finding.far_apart, finding.usual = config.far_apart, USUAL
    follower.points, follower.least_points = 100, config.least_points
    follower.is_sure, follower.met = True, 1.0
    follower.close = USUAL
    saw(finding, follower, 1.0)
    follower.is_sure, follower.close = is_sure, agreement
    follower.way += moved
    follower.reckoned[0, 0] += moved
    saw(finding, follower, 2.0)
    return is_due(finding)


@pytest.mark.parametrize("moved", [0.0, 0.2, 1.0])
def test_a_scan_that_agrees_as_is_usual_is_not(moved: float) -> None:
    assert not is_searched_for(USUAL, moved)


@pytest.mark.parametrize("moved", [0.0, 0.2, 1.0])
def test_a_scan_that_confirms_nothing_is(moved: float) -> None:
    assert is_searched_for(0.0, moved, is_sure=False)


@pytest.mark.parametrize(("moved", "searched"), [(0.0, True), (0.2, False), (1.0, True)])
def test_one_that_agrees_less_is_where_nothing_new_came_into_sight_or_it_may_be_elsewhere(
    moved: float, searched: bool
) -> None:
    """It may have been turned as it stood; far from the last scan it may fit at a wrong place."""
    assert is_searched_for(BAD, moved) is searched
