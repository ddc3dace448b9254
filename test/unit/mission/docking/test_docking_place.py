"""Docking while the robot's place is lost, or after it was taken away."""

from __future__ import annotations

import math

import pytest
from fixtures.robots.docking_rig import CONFIG, STATION, Rig

from roomba.geometry import Pose, Twist
from roomba.mission.docking.docking import DockState, Trouble


@pytest.mark.parametrize("after", [0.3, 1.0, 3.0])
def test_when_its_place_is_lost_it_goes_on_by_the_beams(after: float) -> None:
    for seed in range(5):
        rig = Rig(Pose(-0.68, 0.04, -0.3), wrong=Pose(0.03, 0.04, 0.05), seed=seed)
        rig.stay(after)
        rig.is_known = False
        step = rig.run(40.0)
        assert step.state is DockState.DOCKED


def test_when_its_place_is_lost_between_attempts_beams_are_enough() -> None:
    rig = Rig()
    rig.put_obstacle(-0.1, 0.0)
    rig.run_until(lambda step: step.state is DockState.BACKING_OFF)
    rig.run_until(lambda step: rig.pose.x < -0.6)
    rig.is_known = False
    rig.world.remove_obstacles()
    assert rig.run(20.0).state is DockState.DOCKED


def test_without_place_and_beams_it_waits_a_little_and_gives_up() -> None:
    rig = Rig(Pose(-1.5, 0.5, 0.0))
    rig.is_known = False
    step = rig.run(20.0)
    assert step.trouble is Trouble.LOST
    assert rig.seconds == pytest.approx(CONFIG.lost_timeout, abs=0.3)
    # A place that is no place at all is none either.
    rig = Rig(Pose(-1.5, 0.5, 0.0), wrong=Pose(math.nan, 0.0, 0.0))
    assert rig.run(20.0).trouble is Trouble.LOST
    # Beams do not say which way the robot looks.
    rig = Rig(wrong=Pose(math.nan, 0.0, 0.0))
    assert rig.run(20.0).trouble is Trouble.LOST
    assert {step.twist for step in rig.steps} == {Twist()}


def test_its_place_found_again_it_goes_on() -> None:
    rig = Rig(Pose(-1.2, 0.6, 2.0), delay=0)
    rig.is_known = False
    rig.stay(5.0)
    assert rig.pose.distance_to(-1.2, 0.6) < 0.01
    rig.is_known = True
    assert rig.run(40.0).state is DockState.DOCKED


def test_taken_away_it_comes_back_or_says_that_it_is_too_far() -> None:
    rig = Rig()
    rig.stay(2.0)
    rig.world.put(STATION.compose(Pose(-1.4, 0.5, 2.0)))
    assert rig.run(60.0).state is DockState.DOCKED
    rig = Rig()
    rig.stay(2.0)
    rig.world.put(STATION.compose(Pose(-3.2, 0.5, 2.0)))
    step = rig.run(5.0)
    assert step.trouble is Trouble.FAR
    assert "3.2 m" in step.reason


def test_taken_away_unnoticed_it_ends() -> None:
    rig = Rig()
    rig.stay(2.0)
    rig.is_known = False
    rig.world.put(STATION.compose(Pose(-1.4, 0.5, 2.0)))
    assert rig.run(60.0).state is DockState.FAILED
