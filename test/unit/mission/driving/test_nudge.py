"""A path that is moved aside a little: how far it keeps from things, and when it is left alone."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.robots.missions import HOME
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.driving.nudge import nudged
from roomba.mission.inputs.planning_context import PlanningContext

CONFIG = RobotConfig()
FLOOR = PlanningContext(HOME.map, HOME.station, CONFIG, MissionConfig(), DockingConfig()).floor
PATH = np.array([(0.6, 0.6), (2.6, 0.6), (2.6, 2.0)])
KEEP = 0.165


def nudge(*things: RoundObstacle, points: NDArray[np.float64] = PATH) -> NDArray[np.float64] | None:
    tracker = PathTracker(points, CONFIG.tracking, CONFIG.body, CONFIG.timing.tick)
    tracker.tick(Pose(0.9, float(points[0, 1]), 0.0), 0.3)
    return nudged(tracker, FLOOR, things, KEEP, most=0.08)


def gaps(points: NDArray[np.float64], thing: RoundObstacle) -> NDArray[np.float64]:
    """Return how far each point is from a thing's rim, m."""
    away: NDArray[np.float64] = np.hypot(points[:, 0] - thing[0], points[:, 1] - thing[1])
    return away - thing[2]


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_it_goes_past_a_thing_as_near_as_it_may(side: float) -> None:
    thing = (1.4, 0.6 + side * 0.15, 0.02)
    points = nudge(thing)
    assert points is not None
    assert gaps(points, thing).min() == pytest.approx(KEEP, abs=0.004)
    # To the other side, no farther than it takes, and then on as before.
    assert np.abs(points[points[:, 0] < 2.5, 1] - 0.6).max() < 0.04
    assert side * (points[:, 1] - 0.6)[points[:, 0] < 2.5].max() < 0.001 + 0.04 * (side < 0)
    assert points[-2:] == pytest.approx(PATH[-2:])
    assert points[0] == pytest.approx((0.9, 0.6), abs=0.01)


def test_between_two_things_it_keeps_to_the_middle_if_there_is_room() -> None:
    low, high = (1.4, 0.41, 0.02), (1.4, 0.79, 0.02)
    points = nudge(low, high)
    assert points is not None
    for thing in (low, high):
        assert gaps(points, thing).min() > KEEP - 0.004


@pytest.mark.parametrize(
    "things",
    [
        [],
        [(0.9, 2.2, 0.1)],
        [(1.4, 0.6, 0.02)],
        [(1.4, 0.45, 0.02), (1.4, 0.75, 0.02)],
        [(1.9, 0.45, 0.02)],
    ],
    ids=["nothing", "far away", "in the middle of it", "no room between", "where it goes on"],
)
def test_it_is_left_alone_where_that_does_not_help(things: list[RoundObstacle]) -> None:
    points = nudge(*things)
    if points is not None:
        # What is far away changes nothing.
        assert gaps(points, things[0]).min() > 1.0
        assert np.abs(points[points[:, 0] < 2.5, 1] - 0.6).max() < 1e-9


def test_walls_are_no_way_out() -> None:
    beside_wall = np.array([(0.6, 0.17), (2.6, 0.17)])
    assert nudge((1.4, 0.33, 0.02), points=beside_wall) is None
    away_from_wall = nudge((1.4, 0.01, 0.02), points=beside_wall)
    assert away_from_wall is not None
    assert away_from_wall[:, 1].max() > 0.19
