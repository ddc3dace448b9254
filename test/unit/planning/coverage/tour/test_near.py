"""The nearest places by the way that the middle has to go: in sight, and around walls."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.planning.coverage.tour.near import neighbours, places_over, search_over
from roomba.planning.coverage.tour.net import net_over


def test_on_open_floor_they_are_the_nearest_as_the_crow_flies() -> None:
    net = net_over(np.ones((300, 400), np.bool_))
    at = np.random.default_rng(3).uniform(5.0, 295.0, (60, 2))
    nearest, lengths = neighbours(net, search_over(net), places_over(net, at), 6, 250.0)
    away = np.hypot(*(at[:, None] - at).transpose(2, 0, 1))
    np.fill_diagonal(away, np.inf)
    assert np.array_equal(nearest, np.argsort(away, axis=1)[:, :6])
    assert lengths == pytest.approx(np.sort(away, axis=1)[:, :6])


def test_a_wall_makes_the_way_longer_and_what_is_too_far_is_left_out() -> None:
    fits = np.ones((200, 200), np.bool_)
    fits[:160, 90:110] = False
    net = net_over(fits)
    at = np.array([[80.0, 100.0], [120.0, 100.0], [80.0, 20.0], [195.0, 5.0]])
    nearest, lengths = neighbours(net, search_over(net), places_over(net, at), 3, 190.0)
    assert nearest[0].tolist() == [2, 1, -1]
    assert lengths[0, 0] == pytest.approx(80.0)
    assert 2 * np.hypot(10.0, 60.0) + 20.0 <= lengths[0, 1] < 170.0
    assert lengths[1, nearest[1].tolist().index(0)] == lengths[0, 1]
