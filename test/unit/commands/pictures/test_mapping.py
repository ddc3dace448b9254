"""The strip of a growing map: it grows, and the last picture is the finished map."""

from __future__ import annotations

import numpy as np
import pytest

from roomba.commands.map import runs
from roomba.commands.pictures import mapping
from roomba.commands.pictures.mapping import picture_of_map_errors, picture_of_mapping
from roomba.commands.trials.warm import closet
from roomba.grid import UNKNOWN


def test_a_strip_shows_a_map_that_grows() -> None:
    looks, way = mapping.explored(closet(), seed=1)
    known = [np.count_nonzero(look.occupancy.values != UNKNOWN) for look in looks]
    assert known[-1] > known[0]
    assert looks[-1].goal is None
    assert any(look.goal is not None for look in looks)
    assert [look.time for look in looks] == sorted(look.time for look in looks)
    assert way[-1, 0] == pytest.approx(looks[-1].time, abs=1.01)


def test_the_strip_is_a_picture_of_a_page_s_width() -> None:
    picture = picture_of_mapping(closet())
    assert picture.dtype == np.uint8
    height, width, _ = picture.shape
    assert 800 <= width <= 1200
    assert 300 <= height <= 1000
    # Each of the four panels has walls in it, and around them the unknown.
    plans = picture[height // 8 : height * 3 // 4]
    for panel in np.array_split(plans, len(mapping.SHARES), axis=1):
        assert (panel < 80).all(axis=2).sum() > 100
        assert (panel == round(0.86 * 255)).all(axis=2).sum() > 1000


def test_errors_are_drawn_beside_those_of_odometry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "home_of", lambda trial, body: closet())
    assert picture_of_map_errors(closet()).shape[1] == 1200
