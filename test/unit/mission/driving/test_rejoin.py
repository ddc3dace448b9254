"""The way around what stands on a path: where it leads, and when there is none."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from fixtures.robots.missions import HOME
from numpy.typing import NDArray

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.control.path_tracker import PathTracker
from roomba.geometry import Pose, RoundObstacle
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.rejoin import Rejoin
from roomba.mission.driving.trail import Trail
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Senses
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.things.layer import ThingLayer
from roomba.planning.path.planner import NoPathError

CONFIG = RobotConfig()
BODY = CONFIG.body.radius
DRIVING = MissionConfig().driving
CONTEXT = PlanningContext(HOME.map, HOME.station, CONFIG, MissionConfig(), DockingConfig())
PATH = np.array([(0.6, 0.5), (2.6, 0.5), (2.6, 2.0)])


class Standing(Obstacles):
    """These things, and as large as they are."""

    def __init__(self, *things: RoundObstacle) -> None:
        super().__init__(ThingLayer(SurfaceField.of(HOME.map)), CONFIG.walk, CONFIG.body, DRIVING)
        self.things = list(things)

    def standing(self, now: float) -> list[RoundObstacle]:
        return self.things

    def at_least(self, now: float) -> list[RoundObstacle]:
        return self.things


def way(
    pose: Pose, *things: RoundObstacle, trail: Trail | None = None
) -> tuple[NDArray[np.float64] | None, float, Rejoin]:
    tracker = PathTracker(PATH, CONFIG.tracking, CONFIG.body, CONFIG.timing.tick)
    tracker.tick(Pose(0.9, 0.5, 0.0), 0.3)
    rejoin = Rejoin(CONTEXT, BODY, DRIVING)
    points, back = rejoin.way(Senses(0.0, pose), tracker, Standing(*things), trail or Trail())
    return points, back, rejoin


def gap_to(points: NDArray[np.float64], x: float, y: float) -> float:
    """Return how near a way comes to a point, m."""
    shares = np.linspace(0.0, 1.0, 200)
    along = np.concatenate([a + shares[:, None] * (b - a) for a, b in itertools.pairwise(points)])
    return float(np.hypot(along[:, 0] - x, along[:, 1] - y).min())


def length(points: NDArray[np.float64]) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def test_with_nothing_in_the_way_it_goes_to_the_path_and_on() -> None:
    points, back, _ = way(Pose(0.9, 0.8, 0.0))
    assert points is not None
    assert back == 0.0
    assert points[0] == pytest.approx((0.9, 0.8))
    assert points[-2:] == pytest.approx(PATH[-2:])
    # Nothing of what is left is left out but what is beside it.
    assert gap_to(points, 1.3, 0.5) < 0.01


def test_around_a_thing_it_leaves_the_path_and_joins_it_behind() -> None:
    points, back, _ = way(Pose(0.9, 0.5, 0.0), (1.4, 0.5, 0.05))
    assert points is not None
    assert back == 0.0
    assert points[-2:] == pytest.approx(PATH[-2:])
    assert gap_to(points, 1.4, 0.5) >= BODY + 0.05
    for x in (1.8, 2.2):
        assert gap_to(points, x, 0.5) < 0.01


def test_a_thing_far_ahead_does_not_cut_the_path_before_it() -> None:
    points, _, _ = way(Pose(0.9, 0.5, 0.0), (2.3, 0.5, 0.05))
    assert points is not None
    assert gap_to(points, 1.5, 0.5) < 0.01


def test_what_is_left_that_cannot_be_reached_is_told() -> None:
    # A fence all around the robot.
    fence = [(0.9 + 0.4 * np.cos(a), 0.5 + 0.4 * np.sin(a), 0.1) for a in np.arange(0.0, 6.2, 0.25)]
    points, back, rejoin = way(Pose(0.9, 0.5, 0.0), *((float(x), float(y), r) for x, y, r in fence))
    assert points is None or len(points) >= 2
    if points is None:
        assert back == 0.0
        assert rejoin.trouble


def test_behind_a_fence_nothing_can_be_reached() -> None:
    fence = [(1.4, float(y), 0.05) for y in np.arange(0.0, 2.6, 0.1)]
    tracker = PathTracker(PATH[1:], CONFIG.tracking, CONFIG.body, CONFIG.timing.tick)
    rejoin = Rejoin(CONTEXT, BODY, DRIVING)
    senses = Senses(0.0, Pose(0.9, 0.5, 0.0))
    points, back = rejoin.way(senses, tracker, Standing(*fence), Trail())
    assert (points, back) == (None, 0.0)
    assert "no way leads there" in rejoin.trouble


def test_out_of_a_pocket_it_goes_back_as_it_came() -> None:
    # It stands in a nook of things, too near to them to turn; the way in is behind it.
    nook = [
        (1.10, 0.5, 0.05),
        (0.9, 0.70, 0.05),
        (0.9, 0.30, 0.05),
        (0.75, 0.68, 0.05),
        (0.75, 0.32, 0.05),
    ]
    trail = Trail()
    for step in range(40):
        trail.add(0.9, 2.1 - 0.04 * step)
    points, back, _ = way(Pose(0.9, 0.5, 0.0), *nook, trail=trail)
    assert points is not None
    assert points[0] == pytest.approx((0.9, 0.5), abs=0.06)
    assert points[-1] == pytest.approx(PATH[-1])
    if back > 0.0:
        assert length(points) > back


def test_where_it_cannot_move_it_goes_back_to_where_it_can() -> None:
    trail = Trail()
    for step in range(26):
        trail.add(1.9 - 0.04 * step, 0.5)
    # So large a thing is felt where it stands that it fits nowhere near.
    thing = (0.9, 0.5, 0.5)
    assert way(Pose(0.9, 0.5, 0.0), thing)[0] is None
    points, back, _ = way(Pose(0.9, 0.5, 0.0), thing, trail=trail)
    assert points is not None
    assert back > 0.5
    assert points[0] == pytest.approx((0.9, 0.5), abs=0.06)
    assert points[-1] == pytest.approx(PATH[-1])
    assert length(points) > back


def test_the_last_point_counts_even_if_only_that_is_free() -> None:
    things = [(2.6, float(y), 0.05) for y in np.arange(0.6, 1.7, 0.1)]
    points, _, _ = way(Pose(2.2, 0.5, 0.0), (2.5, 0.5, 0.05), *things)
    if points is not None:
        assert points[-1] == pytest.approx(PATH[-1])


@pytest.mark.parametrize("beside", [0.0, 0.1])
def test_onto_a_thing_on_the_end_of_a_path_no_way_leads(beside: float) -> None:
    path = np.array([(2.6, 1.5), (2.6, 2.0)])
    tracker = PathTracker(path, CONFIG.tracking, CONFIG.body, CONFIG.timing.tick)
    rejoin = Rejoin(CONTEXT, BODY, DRIVING)
    senses, thing = Senses(0.0, Pose(2.6, 1.4, np.pi / 2)), (2.6 + beside, 2.0, 0.06)
    assert rejoin.way(senses, tracker, Standing(thing), Trail()) == (None, 0.0)
    assert "the body does not fit there" in rejoin.trouble


STAGING = (CONTEXT.staging.x, CONTEXT.staging.y)


def home(pose: Pose, *things: RoundObstacle, trail: Trail | None = None) -> NDArray[np.float64]:
    return Rejoin(CONTEXT, BODY, DRIVING).way_home(
        Senses(0.0, pose), Standing(*things), trail or Trail()
    )


def test_the_way_home_ends_before_the_station() -> None:
    points = home(Pose(2.6, 0.5, 0.0))
    assert points[0] == pytest.approx((2.6, 0.5))
    assert points[-1] == pytest.approx(STAGING)


@pytest.mark.parametrize("beside", [0.0, 0.1])
def test_with_a_thing_before_the_station_there_is_no_way_home(beside: float) -> None:
    with pytest.raises(NoPathError):
        home(Pose(2.6, 0.5, 0.0), (STAGING[0], STAGING[1] + beside, 0.06))


def test_out_of_a_cage_it_goes_home_as_it_came_in() -> None:
    trail = Trail()
    for step in range(26):
        trail.add(1.9 - 0.04 * step, 0.5)
    thing = (0.9, 0.5, 0.5)
    with pytest.raises(NoPathError):
        home(Pose(0.9, 0.5, 0.0), thing)
    points = home(Pose(0.9, 0.5, 0.0), (0.9, 0.5, 0.3), trail=trail)
    assert points[0] == pytest.approx((0.9, 0.5), abs=0.06)
    assert points[-1] == pytest.approx(STAGING)


def test_the_way_out_is_the_first_of_the_way_home() -> None:
    pose = Pose(2.6, 0.5, 0.0)
    rejoin = Rejoin(CONTEXT, BODY, DRIVING)
    points = rejoin.way_out(Senses(0.0, pose), Standing(), Trail())
    assert points is not None
    assert points[0] == pytest.approx((2.6, 0.5))
    assert length(points) == pytest.approx(1.0)
    near = rejoin.way_out(Senses(0.0, Pose(STAGING[0] + 0.3, STAGING[1], 0.0)), Standing(), Trail())
    assert near is not None
    assert near[-1] == pytest.approx(STAGING)
    cage = (2.6, 0.5, 0.5)
    assert rejoin.way_out(Senses(0.0, pose), Standing(cage), Trail()) is None
