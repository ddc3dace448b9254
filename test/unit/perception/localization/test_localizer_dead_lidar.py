"""A robot whose lidar is silent: how it reports that, and how uncertain it is."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.located import (
    CONFIG,
    HASTY,
    START,
    TWO_ROOMS,
    WORST_ERROR,
    Located,
    started,
    steps,
)

from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer
from roomba.world.observation import Observation


def wander(robot: Located, seconds: float, seed: int) -> list[Observation]:
    """Drive at random, back from what is in the way."""
    random = np.random.default_rng(seed)
    wanted, seen = Twist(), []
    for step in steps(seconds):
        if step % 40 == 0:
            wanted = Twist(float(random.uniform(0.0, 0.3)), float(random.uniform(-1.0, 1.0)))
        seen.append(robot.step(wanted))
        if seen[-1].bumper.pressed:
            wanted = Twist(-0.2, 0.5)
    return seen


@pytest.mark.parametrize("dies", ["silent", "blind"])
def test_without_scans_it_says_so_and_how_unsure_it_is(dies: str) -> None:
    inside = total = 0
    for seed in range(12):
        robot = started(seed=seed)
        robot.see_as = lambda ranges: None if dies == "silent" else np.full_like(ranges, np.inf)
        # A scan in which nothing came back says so at once, silence after a while.
        robot.stay(CONFIG.localization.scan_timeout + 0.2 if dies == "silent" else 0.15)
        assert robot.estimate.knowledge is Knowledge.ROUGH
        said = "the lidar sends no scans" if dies == "silent" else "the lidar sees next to nothing"
        assert said in robot.estimate.reason
        before = robot.estimate.position_deviation
        for _ in range(12):
            wander(robot, 1.0, seed + total)
            estimate = robot.estimate
            assert estimate.knowledge is Knowledge.ROUGH
            inside += robot.error < 3.0 * estimate.position_deviation
            inside += robot.turn_error < 3.0 * estimate.heading_deviation
            total += 2
        driven = robot.world.numbers["distance"]
        assert estimate.position_deviation > before
        # Honest both ways: after some metres it is not unsure by more than it must be.
        assert estimate.position_deviation < 0.02 + 0.05 * driven
        assert robot.error > 0.0
    assert inside >= 0.95 * total


def test_a_dead_lidar_is_lost_in_the_end_and_comes_back_with_its_scans() -> None:
    robot = Located(TWO_ROOMS, START, localization=HASTY, deviation=(0.01, 0.01))
    robot.stay(0.5)
    robot.see_as = lambda ranges: None
    knowledge = []
    for _ in steps(20.0):
        robot.step(Twist(0.2, 0.8))
        knowledge.append(robot.estimate.knowledge)
    assert knowledge[0] is Knowledge.KNOWN
    assert list(dict.fromkeys(knowledge)) == [Knowledge.KNOWN, Knowledge.ROUGH, Knowledge.LOST]
    assert "the lidar sends no scans, for too long" in robot.estimate.reason
    robot.see_as = lambda ranges: ranges
    robot.stay(0.5)
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_scans_that_come_back_after_a_long_blind_drive_find_it() -> None:
    """Far from where it believes to be, and as unsure as that."""
    robot = started()
    robot.see_as = lambda ranges: None
    off = robot.world.pose.compose(Pose(0.5, 0.3, 0.4))
    robot.localizer.told(off, (0.6, 0.4))
    robot.stay(1.0)
    robot.see_as = lambda ranges: ranges
    robot.stay(0.5)
    for _ in steps(3.0):
        robot.look()
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


@pytest.mark.parametrize("off", [Pose(0.4, 0.3, 0.3), Pose(-0.3, 0.6, -0.4), Pose(0.6, 0.0, 0.2)])
def test_after_a_long_blind_drive_no_wrong_place_is_known_even_for_a_moment(off: Pose) -> None:
    """Wheels so bad that half a metre of error is what is to be expected."""
    bad = CONFIG.localization.model_copy(
        update={"way_noise": 0.5, "side_noise": 0.5, "wheel_turn_noise": 0.3, "gyro_drift": 0.2}
    )
    robot = Located(TWO_ROOMS, START, localization=bad)
    robot.stay(0.5)
    robot.see_as = lambda ranges: None
    for _ in steps(4.0):
        robot.step(Twist(0.15, 0.5))
    assert robot.estimate.position_deviation > 0.3
    here = robot.world.pose
    robot.world.put(Pose(here.x + off.x, here.y + off.y, here.theta + off.theta))
    robot.see_as = lambda ranges: ranges
    for _ in steps(2.0):
        robot.step(Twist())
        assert not robot.is_wrong
    assert robot.estimate.knowledge is Knowledge.KNOWN
    assert robot.error < WORST_ERROR


def test_silence_is_told_by_the_time_alone() -> None:
    robot = started()
    robot.localizer.pass_time(robot.world.time + 5.0)
    assert robot.estimate.knowledge is Knowledge.ROUGH
    assert "the lidar sends no scans" in robot.estimate.reason
    fresh = Localizer(TWO_ROOMS.map, CONFIG.localization, CONFIG.gyro, 0.17, START)
    fresh.pass_time(5.0)
    assert fresh.estimate.knowledge is Knowledge.ROUGH
