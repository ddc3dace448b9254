"""The floor that the robot remembers by odometry."""

from __future__ import annotations

import math

import pytest

from roomba.bumping.felt_floor import FeltFloor
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose

CONFIG = BumpingConfig()


def test_what_was_swept_is_new_no_more_and_nothing_is_new_behind_what_was_felt() -> None:
    floor = FeltFloor(CONFIG, 0.2)
    here = Pose(0.0, 0.0, 0.0)
    assert floor.new_ahead(here, 0.0, 2.0) == pytest.approx(2.0, abs=0.06)
    floor.sweep(here)
    for step in range(21):
        floor.sweep(Pose(0.05 * step, 0.0, 0.0))
    assert floor.coverage.swept_area == pytest.approx(1.0 * 0.2 + math.pi * 0.01, rel=0.1)
    assert floor.new_ahead(here, 0.0, 2.0) == pytest.approx(0.9, abs=0.11)
    assert floor.new_ahead(here, math.pi, 2.0) == pytest.approx(1.9, abs=0.11)
    floor.feel(Pose(1.3, 0.0, 0.0), 0.17)
    assert floor.new_ahead(here, 0.0, 2.0) == pytest.approx(0.35, abs=0.11)
    floor.forget()
    assert floor.coverage.swept_area == 0.0
    assert not floor.felt.any()


def test_beyond_what_it_remembers_nothing_is_noted() -> None:
    floor = FeltFloor(CONFIG, 0.2)
    far = Pose(100.0, 0.0, 0.0)
    floor.sweep(far)
    floor.feel(far, 0.17)
    assert floor.coverage.swept_area == 0.0
    assert floor.new_ahead(far, 0.0, 2.0) == 0.0
