"""The home as a mission plans in it."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager

import numpy as np
import pytest
import shapely
from fixtures.homes.rooms import room_home
from fixtures.robots.missions import DEN, HALL, HOME, STATION, TABLE, TWO_ROOMS, WALL_X, two_rooms

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoomsError
from roomba.geometry import Pose
from roomba.headless.plan_watch import PlanWatch
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.planning.coverage.planner import UNWATCHED
from roomba.planning.path.planner import NoPathError, NoPathReason
from roomba.world.home.home import Home

ROBOT = RobotConfig()


def context(
    home: Home = HOME,
    zones: Zones | None = None,
    plan_watch: AbstractContextManager[object] = UNWATCHED,
) -> PlanningContext:
    rooms = two_rooms() if home is TWO_ROOMS else None
    parts = ROBOT, MissionConfig(), DockingConfig(), rooms, zones
    return PlanningContext(home.map, home.station, *parts, plan_watch=plan_watch)


def wall(x: float) -> Zones:
    return Zones((Zone("wall", ZoneKind.WALL, ((x, 0.0), (x, 2.5))),))


def test_the_staging_place_is_in_front_of_the_station() -> None:
    staging = context().staging
    assert staging.x == pytest.approx(STATION.x + DockingConfig().staging_distance)
    assert staging.y == pytest.approx(STATION.y)


@pytest.mark.parametrize("width", [0.75, 0.85, 1.0])
def test_where_a_wall_is_near_the_staging_place_is_nearer_to_the_station(width: float) -> None:
    station = Pose(0.2, 0.5, math.pi)
    staging = context(room_home(width, 1.0, station=station)).staging
    assert 0.0 < width - ROBOT.body.radius - staging.x < 0.03
    assert (staging.y, staging.theta) == pytest.approx((0.5, math.pi))


def test_where_it_is_nowhere_free_the_staging_place_is_as_told() -> None:
    """And a way there is refused."""
    station = Pose(0.2, 0.5, math.pi)
    staging = context(room_home(0.4, 1.0, station=station)).staging
    assert staging.x == pytest.approx(station.x + DockingConfig().staging_distance)


def test_what_zones_keep_from_it_cannot_be_cleaned_nor_reached() -> None:
    bare, walled = context(), context(zones=wall(1.5))
    column = bare.frame.cell_of(1.5, 1.0)[1]
    assert bare.coverable()[:, column:].any()
    assert not walled.coverable()[:, column:].any()
    assert (walled.coverable()[:, : column - 40] == bare.coverable()[:, : column - 40]).all()
    with pytest.raises(NoPathError):
        walled.paths.plan((1.0, 0.5), (2.5, 0.5))
    assert (walled.occupancy.values == HOME.map.values).all()


def test_beyond_a_step_the_floor_around_it_can_be_cleaned_as_well() -> None:
    walled, beyond = context(zones=wall(1.5)), Pose(2.5, 0.6, 0.0)
    column = walled.frame.cell_of(1.5, 1.0)[1]
    home, both = walled.coverable(), walled.coverable(beyond)
    assert (both[:, :column] == home[:, :column]).all()
    assert both[walled.frame.cell_of(beyond.x, beyond.y)]
    # From its station, and where a way leads there, nothing is added.
    for here in (STATION, Pose(0.8, 0.6, 0.0)):
        assert (walled.coverable(here) == home).all()
    # Neither in furniture, nor off the map.
    for here in (Pose(0.5 * (TABLE[0] + TABLE[2]), 1.25, 0.0), Pose(-9.0, 0.6, 0.0)):
        assert (context().coverable(here) == context().coverable()).all()


def test_a_plan_of_coverage_begins_here_and_is_counted() -> None:
    watch = PlanWatch()
    home = context(plan_watch=watch)
    todo = home.coverable()
    plan = home.plan_coverage((1.0, 0.5), todo, [], edges_only=False)
    assert plan.points[0] == pytest.approx((1.0, 0.5))
    assert plan.points[-1] == pytest.approx((home.staging.x, home.staging.y))
    area = np.count_nonzero(todo) * home.frame.resolution**2
    assert plan.length > 0.9 * area / home.tool_width
    edges = home.plan_coverage((1.0, 0.5), todo, [], edges_only=True)
    assert edges.length < 0.7 * plan.length
    assert watch.plans == 2
    assert watch.seconds > 0.0


def test_a_plan_that_fails_is_counted_too() -> None:
    watch = PlanWatch()
    home = context(plan_watch=watch)
    around = [(1.0 + 0.2 * x, 0.5 + 0.2 * y, 0.1) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    with pytest.raises(NoPathError):
        home.plan_coverage((1.0, 0.5), home.coverable(), around, edges_only=False)
    assert watch.plans == 1


def test_all_plans_of_its_planners_are_counted() -> None:
    watch = PlanWatch()
    home = context(plan_watch=watch)
    at, todo = (1.0, 0.5), home.coverable()
    home.coverage.plan(at, None, todo)
    home.growing_coverage.plan(at, None, todo)
    home.squeeze(at, (1.5, 1.25), [])
    assert watch.plans == 3


def test_it_squeezes_through_where_paths_keep_away() -> None:
    home = context()
    # A fence with a gap that is a little wider than the body and its clearance.
    half = home.reach + 0.007
    away = np.arange(half + 0.05, 1.4, 0.06)
    things = [(1.2, 1.25 + side, 0.05) for side in (*away.tolist(), *(-away).tolist())]
    with pytest.raises(NoPathError):
        home.paths.plan((0.85, 1.25), (1.5, 1.25), things)
    points = home.squeeze((0.85, 1.25), (1.5, 1.25), things)
    assert points[0] == pytest.approx((0.85, 1.25))
    assert points[-1] == pytest.approx((1.5, 1.25))
    with pytest.raises(NoPathError):
        home.squeeze((0.85, 1.25), (1.5, 1.25), [*things, (1.2, 1.25, 0.05)])


def test_it_squeezes_to_where_the_body_fits_alone() -> None:
    home, here, there = context(), (0.85, 0.5), (2.0, 0.5)
    with pytest.raises(NoPathError) as refused:
        home.squeeze(here, there, [(*there, 0.06)])
    assert refused.value.reason is NoPathReason.GOAL_IN_OBSTACLE
    assert refused.value.nearest is not None
    least = home.reach + 0.06
    assert least - 0.02 <= math.dist(refused.value.nearest, there) <= least + 0.05
    # A little too near to a thing does not count.
    points = home.squeeze(here, there, [(there[0], there[1] + least - 0.02, 0.06)])
    assert math.dist(points[-1], there) < home.staging_tolerance


def test_rooms_are_known_by_name_and_by_place() -> None:
    home = context(TWO_ROOMS)
    assert home.room_at(0.5, 0.5) == HALL
    assert home.room_at(3.0, 0.5) == DEN
    assert home.room_at(-5.0, 0.5) == ""
    assert context().room_at(0.5, 0.5) == ""
    den, hall = home.in_room(DEN), home.in_room(HALL)
    assert den.shape == hall.shape == home.frame.shape
    assert not (den & hall).any()
    assert den[home.frame.cell_of(3.0, 0.5)]
    assert hall[home.frame.cell_of(0.5, 0.5)]
    assert np.count_nonzero(den) * home.frame.resolution**2 == pytest.approx(
        (3.6 - WALL_X - 0.05) * 2.4, abs=0.1
    )
    with pytest.raises(RoomsError):
        home.in_room("cellar")


def test_a_mask_of_the_map_is_laid_over_the_fine_grid() -> None:
    home = context()
    coarse = np.zeros(HOME.map.frame.shape, np.bool_)
    coarse[3, 7] = True
    fine = home.fine(coarse)
    factor = home.frame.rows // HOME.map.frame.rows
    assert fine.shape == home.frame.shape
    assert fine.sum() == factor**2
    x, y = HOME.map.frame.centre_of(3, 7)
    assert fine[home.frame.cell_of(x, y)]


def test_in_a_map_that_grows_paths_keep_farther_away() -> None:
    """What has only just been seen may stand a little elsewhere."""
    exploring, driving = MissionConfig().exploring, MissionConfig().driving
    assert exploring.clearance > driving.way_clearance
    grows = PlanningContext(
        HOME.map, STATION, ROBOT, MissionConfig(), DockingConfig(), is_growing=True
    )
    assert (grows.is_growing, context().is_growing) == (True, False)
    table = shapely.box(*TABLE)
    gaps = []
    for home in (context(), grows):
        points = home.paths.plan((1.2, 1.25), (2.65, 1.3)).points
        gaps.append(shapely.LineString(points).distance(table) - ROBOT.body.radius)
    assert gaps[0] == pytest.approx(driving.way_clearance, abs=0.03)
    assert exploring.clearance - 0.01 < gaps[1] < exploring.clearance + 0.05
    # But it passes what a clean passes: it is to see all that can be cleaned.
    ends = ((0.85, 1.25), (1.5, 1.25))
    half = ROBOT.body.radius + 0.036
    away = np.arange(half + 0.05, 1.4, 0.06)
    fence = [(1.2, 1.25 + side, 0.05) for side in (*away.tolist(), *(-away).tolist())]
    assert len(context().paths.plan(*ends, fence).points)
    assert len(grows.paths.plan(*ends, fence).points)


def test_around_a_robot_that_stands_too_near_a_wall_the_nearest_narrow_place_is_another_cells() -> (
    None
):
    home = context()
    narrow = home.narrow_floor((0.85, 1.25), [])
    row, column = np.argwhere(~narrow.places)[0]
    beside = narrow.frame.centre_of(int(row), int(column))
    x, y = narrow.fine_frame.centres(*np.nonzero(narrow.fine))
    nearest = float(np.hypot(x - beside[0], y - beside[1]).min())
    assert math.dist(narrow.place_near(beside), beside) == pytest.approx(nearest)
    inside = narrow.frame.centre_of(*np.argwhere(narrow.places)[0].tolist())
    assert narrow.frame.cell_of(*narrow.place_near(inside)) == narrow.frame.cell_of(*inside)
