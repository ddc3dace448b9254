"""Peers that drive over a floor: lanes, bounce, and the robot that they drive."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from roomba.commands.trials.warm import closet
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.home.home import Home
from roomba_bench.coverage.bounce import bounce
from roomba_bench.coverage.clean import true_floor
from roomba_bench.coverage.floor import Reachable, length
from roomba_bench.coverage.lanes import Order, boustrophedon, lanes_on, way_over
from roomba_bench.coverage.peer import PeerRobot
from roomba_bench.coverage.peers import context_of, drive_bounce, drive_lanes, planned, shares_at
from roomba_bench.coverage.recorded import FAILED, recorded

START = Pose(1.2, 0.9, 0.0)


@pytest.fixture(scope="module")
def home() -> Home:
    return closet()


@pytest.fixture(scope="module")
def floor(home: Home) -> Reachable:
    return true_floor(home, (START.x, START.y))


def test_lanes_are_a_tool_apart_and_end_where_floor_does() -> None:
    fits = np.ones((11, 7), np.bool_)
    fits[4, 3] = False
    lanes = lanes_on(fits, GridFrame(0.05, 0.0, 0.0, 11, 7))
    assert [line[0][0][0] for line in lanes.lines] == [0, 4, 8, 10]
    assert lanes.lines[0] == [((0, 0), (0, 6))]
    assert lanes.lines[1] == [((4, 0), (4, 2)), ((4, 4), (4, 6))]


@pytest.mark.parametrize("order", list(Order))
def test_way_goes_over_all_lanes_and_stays_where_the_body_fits(order: Order) -> None:
    fits = np.ones((25, 31), np.bool_)
    fits[5:14, 12:20] = False
    lanes = lanes_on(fits, GridFrame(0.05, 0.0, 0.0, 25, 31))
    way = way_over(lanes, (3, 3), order)
    assert way[0] == (3, 3)
    driven = set()
    for (row, column), (to_row, to_column) in pairwise(way):
        down, right = to_row - row, to_column - column
        assert down == 0 or right == 0 or abs(down) == abs(right)
        steps = max(abs(down), abs(right))
        assert steps > 0
        driven |= {
            (row + step * down // steps, column + step * right // steps)
            for step in range(steps + 1)
        }
    assert all(fits[cell] for cell in driven)
    for line in lanes.lines:
        for (row, first), (_, last) in line:
            assert {(row, column) for column in range(first, last + 1)} <= driven


def test_nearest_lane_next_is_not_longer_where_walls_part_lanes() -> None:
    solid = np.ones((60, 62), np.bool_)
    solid[1:-1, 1:30] = solid[1:-1, 32:-1] = False
    solid[50:58, 30:32] = False
    frame = GridFrame(0.05, 0.0, 0.0, 60, 62)
    in_order, nearest = (boustrophedon(solid, frame, (0.3, 0.3), order) for order in Order)
    assert length(nearest) <= length(in_order)


def test_robot_gets_to_the_points_that_it_is_told(home: Home) -> None:
    robot = PeerRobot(home, START)
    points = np.array([[1.0, 0.9], [1.0, 0.6], [1.6, 0.5]])
    assert robot.follow(points) == 0
    for point in points:
        away = np.hypot(*(robot.poses[:, 1:3] - point).T)
        assert away.min() < 0.01
    assert robot.hits == 0
    assert robot.time < 30.0


def test_robot_goes_on_from_what_it_cannot_get_to(home: Home) -> None:
    robot = PeerRobot(home, START)
    assert robot.follow(np.array([[3.5, 0.9], [1.2, 0.9]])) == 1
    assert robot.pose.distance_to(1.2, 0.9) < 0.02


def test_bounce_turns_away_from_what_it_bumps_into(home: Home, floor: Reachable) -> None:
    robot = PeerRobot(home, START)
    bounce(robot, 120.0, seed=1)
    assert robot.hits > 5
    assert 120.0 <= robot.time < 125.0
    driven = drive_bounce(home, START, floor, 120.0, seed=1)
    np.testing.assert_array_equal(driven.poses, robot.poses)
    assert 20.0 < driven.coverage <= 100.0


def test_lanes_cover_most_of_a_closet(home: Home, floor: Reachable) -> None:
    driven = drive_lanes(home, START, floor, Order.NEAREST)
    assert driven.name == "boustrophedon, nearest lane next"
    assert driven.coverage > 85.0
    assert driven.hits == 0.0
    shares = shares_at(floor, driven.poses, (0, 1, 1000))
    assert shares == sorted(shares)
    assert 100.0 * shares[-1] == pytest.approx(driven.coverage, abs=0.2)


def test_plan_of_ours_is_judged_by_the_same_evaluator(home: Home) -> None:
    context = context_of(home)
    floor = true_floor(home, (context.staging.x, context.staging.y))
    plan = planned(home, context, floor, rounds=1)
    assert plan.share > 0.98
    assert 0.8 < plan.ratio < 3.0
    assert 0.0 < plan.cpu < math.inf


def test_recorded_planners_are_those_of_the_map() -> None:
    assert len(recorded("apartment")) == 6
    assert [one.turning for one in recorded("lab_ipa")] == [None] * 3
    assert all(name not in [one.name for one in recorded("lab_ipa")] for name in FAILED["lab_ipa"])
    assert recorded("flat") == []
