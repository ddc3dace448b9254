"""The planner: shortest, clear of walls, and honest about what cannot be reached."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.planned_rooms import (
    CHORD,
    CLEARANCE,
    RADIUS,
    SAGITTA,
    TIGHT,
    occupancy,
    planner_for,
    room,
    samples,
    two_rooms,
)
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from roomba.geometry import Point
from roomba.grid import OccupancyMap
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.joining import join_goal, join_start
from roomba.planning.path.planner import NoPathError, NoPathReason, Path, PathPlanner
from roomba.planning.path.search.grid_path import shortest_grid_path
from roomba_bench.shortest import ShortestWays

BOXES = st.lists(
    st.tuples(
        st.floats(-1.0, 2.5), st.floats(-2.0, 1.5), st.floats(0.05, 1.0), st.floats(0.05, 1.0)
    ).map(lambda box: (box[0], box[1], min(box[0] + box[2], 3.0), min(box[1] + box[3], 2.0))),
    max_size=7,
)
POINTS = st.tuples(st.floats(-0.9, 2.9), st.floats(-1.9, 1.9))


@given(
    BOXES, POINTS, POINTS, st.lists(st.tuples(*[st.floats(-1, 2)] * 2, st.just(0.06)), max_size=3)
)
@settings(max_examples=examples(200), deadline=None)
def test_a_path_fits_everywhere_has_exact_ends_and_is_as_long_backwards(
    boxes: list[tuple[float, float, float, float]],
    start: Point,
    goal: Point,
    obstacles: list[tuple[float, float, float]],
) -> None:
    map = room(*boxes)
    planner = planner_for(map)
    tight = FitMap.build(map, RADIUS, TIGHT, obstacles)
    assume(tight.fits_at(*start))
    try:
        path = planner.plan(start, goal, obstacles)
    except NoPathError as error:
        refusal = error
    else:
        check_path(map, start, goal, obstacles, path)
        return
    assert refusal.reason is not NoPathReason.GOAL_OFF_MAP
    in_obstacle = join_goal(tight, goal) is None
    assert (refusal.reason is NoPathReason.GOAL_IN_OBSTACLE) == in_obstacle
    assert str(refusal).startswith(f"({goal[0]:.2f}, {goal[1]:.2f}) cannot be reached: ")
    if refusal.nearest is None:
        assert not len(join_start(tight, start).legs)
    else:
        assert tuple(planner.plan(start, refusal.nearest, obstacles).points[-1]) == refusal.nearest


def check_path(
    map: OccupancyMap,
    start: Point,
    goal: Point,
    obstacles: list[tuple[float, float, float]],
    path: Path,
) -> None:
    tight = FitMap.build(map, RADIUS, TIGHT, obstacles)
    planner = planner_for(map)
    assert tuple(path.points[0]) == start
    assert tuple(path.points[-1]) == goal
    for x, y in samples(path):
        assert tight.room_along((x, y), (x, y)) >= RADIUS + TIGHT - SAGITTA - 1e-6
    assert planner.plan(goal, start, obstacles).length == pytest.approx(path.length, rel=0.01)
    assert np.array_equal(planner.plan(start, goal, obstacles).points, path.points)


@given(
    st.lists(st.tuples(st.floats(-0.5, 2.3), st.floats(-1.5, 1.3)), max_size=6),
    POINTS,
    POINTS,
)
@settings(max_examples=examples(100), deadline=None)
def test_among_pillars_a_path_is_as_short_as_a_disc_can_go(
    pillars: list[Point], start: Point, goal: Point
) -> None:
    """Where all gaps are as wide as cells can tell, it is the shortest between the walls."""
    map = room(*[(x, y, x + 0.2, y + 0.2) for x, y in pillars])
    wide = FitMap.build(map, RADIUS, CLEARANCE + 0.05)
    assume(wide.fits_at(*start) and wide.fits_at(*goal))
    exact = ShortestWays(map.solid, map.frame, RADIUS + CLEARANCE + 0.05).length(start, goal)
    assume(math.isfinite(exact))
    ways = ShortestWays(map.solid, map.frame, RADIUS + CLEARANCE)
    length = planner_for(map).plan(start, goal).length
    assert ways.length(start, goal) * 0.995 <= length <= exact * 1.002 + 1e-9


def test_where_there_is_room_the_path_keeps_comfortably_clear() -> None:
    map = room((0.5, -0.5, 1.5, 0.5))
    path = planner_for(map).plan((0.0, 0.0), (2.0, 0.1))
    comfortable = FitMap.build(map, RADIUS, CLEARANCE)
    least = (RADIUS + CLEARANCE - SAGITTA) * (1.0 - CHORD)
    assert len(path.points) > 2
    for point in samples(path):
        assert comfortable.room_along(point, point) >= least


def test_a_gap_too_narrow_for_comfort_is_passed_tightly_and_only_there() -> None:
    map = two_rooms(gap=0.45)
    path = PathPlanner(map, RADIUS, 0.06, TIGHT).plan((0.0, -1.5), (2.0, -1.5))
    comfortable = FitMap.build(map, RADIUS, 0.06 - SAGITTA)
    uncomfortable = [point for point in samples(path) if not comfortable.fits_along(point, point)]
    assert uncomfortable
    assert all(0.7 < x < 1.3 and -0.2 < y < 0.6 for x, y in uncomfortable)


def test_only_narrow_places_that_cannot_be_avoided_are_passed() -> None:
    """Two walls with a narrow gap each, and only the first has a wide one as well."""
    map = room(
        (0.9, -2.0, 1.1, 0.0), (0.9, 0.45, 1.1, 1.2), (2.0, -2.0, 2.1, 0.0), (2.0, 0.45, 2.1, 2.0)
    )
    path = PathPlanner(map, RADIUS, 0.06, TIGHT).plan((0.0, 0.2), (2.6, 0.2))
    assert min(y for x, y in samples(path) if 0.9 < x < 1.1) > 1.2


def test_a_wide_way_around_is_preferred_to_a_narrow_gap() -> None:
    map = room((0.9, -2.0, 1.1, -0.4), (0.9, 0.0, 1.1, 1.2))
    path = planner_for(map).plan((0.0, -0.2), (2.0, -0.2))
    assert max(y for _, y in samples(path)) > 1.2


@pytest.mark.parametrize("gap", [0.35, 0.2])
def test_a_gap_too_narrow_for_the_body_is_no_way(gap: float) -> None:
    with pytest.raises(NoPathError) as refused:
        planner_for(two_rooms(gap)).plan((0.0, -1.5), (2.0, -1.5))
    assert refused.value.reason is NoPathReason.GOAL_UNREACHABLE


@pytest.mark.parametrize("offset", [0.0, 0.01, 0.025, 0.04])
def test_a_goal_one_centimetre_from_a_wall_is_accepted(offset: float) -> None:
    edge = -0.95 + RADIUS + TIGHT
    path = planner_for(room()).plan((1.0, 0.0), (edge, 0.3 + offset))
    assert tuple(path.points[-1]) == (edge, 0.3 + offset)
    assert path.length < math.dist((1.0, 0.0), (edge, 0.3 + offset)) * 1.01 + 0.01


def test_docked_with_the_nose_close_to_the_station() -> None:
    map = room((-0.8, -0.2, -0.7, 0.2))
    docked = (-0.7 + RADIUS + 0.03, 0.0)
    planner = planner_for(map)
    out, home = planner.plan(docked, (1.0, 1.0)), planner.plan((1.0, 1.0), docked)
    assert out.length == pytest.approx(math.dist(docked, (1.0, 1.0)), rel=0.01)
    assert home.length == pytest.approx(out.length, rel=1e-6)


def test_after_a_bump_it_leaves_straight_and_goes_around() -> None:
    """Three round things touch the body's front, as the bumper reports it."""
    reach = RADIUS + 0.06
    felt = [(reach * math.cos(a), reach * math.sin(a), 0.06) for a in (-0.45, 0.0, 0.45)]
    path = planner_for(room()).plan((0.0, 0.0), (2.0, 0.0), felt)
    fit = FitMap.build(room(), RADIUS, 0.0, felt)
    assert tuple(path.points[0]) == (0.0, 0.0)
    for point in samples(path):
        assert fit.room_along(point, point) >= RADIUS - 1e-9
    assert path.length < 2.6


def test_a_body_that_overlaps_a_wall_leaves_it_and_never_goes_deeper() -> None:
    map = room()
    start = (-0.95 + RADIUS - 0.02, 0.0)
    path = planner_for(map).plan(start, (-0.7, 1.5))
    fit = FitMap.build(map, RADIUS, TIGHT)
    for point in samples(path):
        assert fit.room_along(point, point) >= fit.room_along(start, start) - 1e-9


def test_a_body_stuck_between_walls_is_not_led_through_one() -> None:
    """Beyond the thin wall there is room, on this side there is none."""
    planner = planner_for(room((0.0, -2.0, 0.6, 2.0), (0.9, -2.0, 0.95, 2.0)))
    with pytest.raises(NoPathError) as refused:
        planner.plan((0.897, 0.025), (2.0, 0.0))
    assert refused.value.reason is NoPathReason.START_BLOCKED


def test_next_door_along_a_wall_it_goes_straight() -> None:
    beside = -0.95 + RADIUS + 0.012
    path = planner_for(room()).plan((beside, 0.0), (beside, 0.15))
    assert path.length == pytest.approx(0.15)


def test_the_point_where_it_stands_is_a_path_of_no_length() -> None:
    path = planner_for(room()).plan((0.3, 0.3), (0.3, 0.3))
    assert path.points.tolist() == [[0.3, 0.3]]


def test_a_goal_off_the_map() -> None:
    with pytest.raises(NoPathError, match="the map ends before it") as refused:
        planner_for(room()).plan((0.0, 0.0), (1e6, 0.0))
    assert refused.value.reason is NoPathReason.GOAL_OFF_MAP
    assert refused.value.nearest is not None
    assert refused.value.nearest[0] > 2.7


def test_a_goal_in_a_wall_names_the_nearest_point_that_can_be_reached() -> None:
    with pytest.raises(NoPathError) as refused:
        planner_for(room((0.5, -0.5, 1.5, 0.5))).plan((0.0, 0.0), (0.6, 0.02))
    assert refused.value.reason is NoPathReason.GOAL_IN_OBSTACLE
    assert refused.value.nearest == pytest.approx((0.275, 0.025))
    assert str(refused.value) == (
        "(0.60, 0.02) cannot be reached: the body does not fit there; "
        "nearest reachable point: (0.28, 0.02)"
    )


def test_the_nearest_point_lies_on_this_side_of_the_wall() -> None:
    with pytest.raises(NoPathError) as refused:
        planner_for(two_rooms(0.0)).plan((0.0, 0.0), (1.4, 0.5))
    assert refused.value.reason is NoPathReason.GOAL_UNREACHABLE
    assert refused.value.nearest is not None
    assert refused.value.nearest[0] < 0.9


def test_a_start_deep_in_a_wall_or_off_the_map_is_blocked() -> None:
    planner = planner_for(room((-1.0, -2.0, 1.0, 0.0)))
    for start in ((0.0, -1.0), (-50.0, 0.0)):
        with pytest.raises(NoPathError) as refused:
            planner.plan(start, (2.0, 1.0))
        assert refused.value.reason is NoPathReason.START_BLOCKED
        assert refused.value.nearest is None
        with pytest.raises(NoPathError):
            planner.reachable(start)


@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.inf), (-math.inf, math.nan)])
def test_numbers_that_are_not_finite_are_refused(bad: Point) -> None:
    planner = planner_for(room())
    with pytest.raises(ValueError, match="expected a goal of two finite numbers, m, got"):
        planner.plan((0.0, 0.0), bad)
    with pytest.raises(ValueError, match="expected a start of two finite numbers, m, got"):
        planner.plan(bad, (0.0, 0.0))
    with pytest.raises(ValueError, match="expected a start of two finite numbers, m, got"):
        planner.reachable(bad)


def test_comfort_below_the_tight_clearance_is_refused() -> None:
    with pytest.raises(ValueError, match="expected a clearance of tight_clearance"):
        PathPlanner(room(), RADIUS, 0.01, 0.04)


def test_reachable_is_the_near_side_of_a_wall() -> None:
    map = two_rooms(0.0)
    planner = planner_for(map)
    mask = planner.reachable((0.0, 0.0))
    assert mask.shape == map.frame.shape
    assert mask[map.frame.cell_of(0.0, 1.0)]
    assert not mask[map.frame.cell_of(2.0, 1.0)]
    assert planner.reachable((0.1, 0.3)) is mask


def test_obstacles_count_for_one_plan_only() -> None:
    planner = planner_for(two_rooms(0.5))
    ends = ((0.0, 0.25), (2.0, 0.25))
    free = planner.plan(*ends)
    with pytest.raises(NoPathError):
        planner.plan(*ends, [(1.0, 0.25, 0.1)])
    assert np.array_equal(planner.plan(*ends).points, free.points)


def test_other_obstacles_take_the_place_of_the_last_ones() -> None:
    planner = planner_for(two_rooms(0.9))
    ends = ((0.0, 0.4), (2.0, 0.4))
    for obstacle in ((0.7, 0.3, 0.1), (1.0, 0.1, 0.1)):
        expected = planner_for(two_rooms(0.9)).plan(*ends, [obstacle])
        assert np.array_equal(planner.plan(*ends, [obstacle]).points, expected.points)


def test_long_searches_make_their_arrays_larger() -> None:
    """Rubble between two far corners: far more fans than a planner has room for at first."""
    solid = np.random.default_rng(3).random((150, 150)) < 0.3
    solid[:2] = solid[:, -2:] = False
    planner = PathPlanner(occupancy(solid, 1.0), 0.2, 0.0, 0.0)
    ends = (-0.5, -1.5), (148.5, 147.5)
    length = planner.plan(*ends).length
    assert planner.plan(ends[1], ends[0]).length == pytest.approx(length)
    over_cells = shortest_grid_path(~solid, (0, 0), (149, 149))
    assert over_cells is not None
    # Eight directions make a path at most 1 / cos(22.5 degrees) times as long.
    assert 0.92 * over_cells.length < length < over_cells.length


@given(st.tuples(st.floats(-0.7, 2.7), st.floats(-1.7, 1.7)))
@settings(max_examples=examples(40))
def test_a_way_is_free_where_the_body_fits_all_along(bend: tuple[float, float]) -> None:
    """Tight clearance counts: nearer to a box the body stands nowhere, farther it may."""
    box = (0.5, -0.6, 1.1, 0.4)
    planner = planner_for(room(box))
    points = np.array([(-0.5, -1.5), bend, (2.5, 1.5)])
    along = np.concatenate(
        [np.linspace(points[at], points[at + 1], 400) for at in range(len(points) - 1)]
    )
    aside = np.maximum(np.maximum(box[:2] - along, along - box[2:]), 0.0)
    to_walls = np.minimum(along - (-0.95, -1.95), (2.95, 1.95) - along).min()
    gap = min(float(np.hypot(*aside.T).min()), float(to_walls))
    assume(abs(gap - (RADIUS + TIGHT)) > 0.03)
    assert planner.is_free(points) == (gap > RADIUS + TIGHT)


def test_planned_ways_are_free_until_a_wall_comes_up() -> None:
    free, shut = two_rooms(0.9), two_rooms(0.0)
    path = planner_for(free).plan((0.0, 0.4), (2.0, 0.4))
    assert planner_for(free).is_free(path.points)
    assert not planner_for(shut).is_free(path.points)
    # Comfort is not asked for: here it has the tight clearance, and little more.
    narrow = room((-0.9, -1.9, 2.9, -0.6), (-0.9, -0.2, 2.9, 1.9))
    between = np.array([(-0.7, -0.4), (2.7, -0.4)])
    assert planner_for(narrow).is_free(between)
    assert not PathPlanner(narrow, RADIUS, 0.04, 0.03).is_free(between)
    # What was driven already counts no more.
    assert planner_for(shut).is_free(np.array([(1.6, 0.4), (2.0, 0.4)]))
    assert planner_for(shut).is_free(np.array([(1.6, 0.4)]))
    assert not planner_for(free).is_free(np.array([(0.0, 0.4), (-9.0, 0.4)]))
