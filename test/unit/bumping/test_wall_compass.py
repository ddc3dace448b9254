"""Heading by walls: on a way with wheels that differ, and in a simulated home."""

from __future__ import annotations

import math

import pytest
from fixtures.bumping import BumpingHome
from fixtures.thoroughness import core_first

from roomba.bumping.sweeping import BumpMove
from roomba.bumping.wall_compass import WallCompass
from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose

STEP = 0.01
"""m a tick."""
CONFIG = BumpingConfig()


class Veering:
    """A robot that drives along walls of a square room, 3 m each, and turns left by itself."""

    def __init__(self, veer: float) -> None:
        self.compass = WallCompass(CONFIG)
        self.true, self.told, self.veer = Pose(), Pose(), veer
        self.compass.take(self.told, is_along=False)
        self.compass.stand_square()

    def drive(self, way: float, *, is_along: bool) -> int:
        """Drive straight on; what it is told turns right by the same. Return what it learned."""
        learned = 0
        for _ in range(round(way / STEP)):
            self.true = self.true.compose(Pose(STEP, 0.0, 0.0))
            self.told = self.told.compose(Pose(STEP, 0.0, self.veer * STEP))
            learned += self.compass.take(self.told, is_along=is_along)
        return learned

    def turn(self, angle: float) -> None:
        self.true = self.true.compose(Pose(0.0, 0.0, angle))
        self.told = self.told.compose(Pose(0.0, 0.0, angle))
        self.compass.take(self.told, is_along=False)

    @property
    def wrong(self) -> float:
        return abs(math.remainder(self.compass.pose.theta - self.true.theta, math.tau))


@pytest.mark.parametrize("veer", [0.01, -0.01])
def test_walls_put_heading_and_place_right_and_tell_how_the_wheels_differ(veer: float) -> None:
    robot = Veering(veer)
    for _ in range(12):
        robot.drive(10.0, is_along=False)
        assert robot.drive(2.0, is_along=True) >= 1
        robot.turn(0.5 * math.pi)
    assert abs(robot.told.theta) > 1.0
    assert robot.wrong < 0.03
    assert robot.compass.pose.distance_to(robot.true.x, robot.true.y) < 0.5
    assert robot.told.distance_to(robot.true.x, robot.true.y) > 5.0
    assert robot.compass.veer == pytest.approx(veer, rel=0.15)


def test_a_wall_far_off_square_and_a_bend_tell_nothing() -> None:
    robot = Veering(0.0)
    robot.turn(0.6)
    assert robot.drive(3.0, is_along=True) == 0
    for _ in range(200):
        robot.turn(0.02)
        assert robot.drive(STEP, is_along=True) == 0
    assert robot.wrong < 1e-9


def test_a_wall_is_due_after_a_way_or_turns_without_one() -> None:
    robot = Veering(0.0)
    assert robot.compass.is_due, "none has told it anything yet"
    robot.drive(2.0, is_along=True)
    assert not robot.compass.is_due
    robot.drive(CONFIG.compass_due + 0.1, is_along=False)
    assert robot.compass.is_due
    robot.drive(2.0, is_along=True)
    assert not robot.compass.is_due
    for _ in range(10):
        robot.turn(2.0)
    assert robot.compass.is_due


def test_on_its_station_it_knows_where_it_is() -> None:
    robot = Veering(0.01)
    robot.drive(5.0, is_along=False)
    robot.compass.stand_at(Pose(1.0, 2.0, 0.3))
    assert robot.compass.pose == Pose(1.0, 2.0, 0.3)
    robot.drive(1.0, is_along=False)
    assert robot.compass.pose.distance_to(1.0, 2.0) == pytest.approx(1.0, abs=0.01)


def test_along_a_real_wall_it_sways_by_a_centimetre_alone() -> None:
    home = BumpingHome("empty", 1)
    home.brain.clean()
    stint: list[tuple[float, float]] = []
    while len(stint) < 80 or math.dist(stint[40], stint[-40]) < 1.5:
        assert home.body.seen.time < 400.0, "expected a way along a wall"
        home.tick()
        if home.brain.move is not BumpMove.WALL:
            stint = []
        else:
            pose = home.body.seen.pose
            stint.append((pose.x, pose.y))
    aside = min(max(each) - min(each) for each in zip(*stint[40:-40], strict=True))
    assert aside < 0.03


@pytest.mark.parametrize("name", core_first(["flat", "apartment"], ["flat"]))
def test_after_ten_minutes_it_knows_where_its_station_is(name: str) -> None:
    home = BumpingHome(name, 3)
    home.brain.clean()
    home.pass_time(600.0)
    station, told = home.brain.station, home.brain.compass.pose
    assert station is not None
    found = home.body.seen.pose.compose(told.inverse().compose(station))
    true = home.body.simulator.home.station
    # By its wheels alone it was off by metres, and 36 degrees.
    assert found.distance_to(true.x, true.y) < 0.8
    assert abs(math.remainder(found.theta - true.theta, math.tau)) < 0.2
