"""Coverage plans: driven clear of all that is solid, over all the floor that can be swept."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from fixtures.homes.turned_rooms import turned_room
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.configuration.coverage import CoverageConfig
from roomba.geometry import Point, RoundObstacle
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.coverage.planner import CoverageFloor, CoveragePlan, CoveragePlanner
from roomba.planning.coverage.stages import OUR_STAGES
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.planner import NoPathError, NoPathReason

REACH, TOOL, CONFIG = 0.169, 0.2, CoverageConfig()
SHARP = 0.5
"""rad; sharper corners of a line become bends."""
TOLERANCE = 0.0015


def room(width: float, height: float, *things: tuple[float, float, float, float]) -> OccupancyMap:
    """A room from (0, 0) on, with things given as x, y, width and height; all in m."""
    values = np.full((round(height / 0.05) + 2, round(width / 0.05) + 2), OCCUPIED, np.int8)
    values[1:-1, 1:-1] = FREE
    for x, y, wide, high in things:
        row, column = round(y / 0.05) + 1, round(x / 0.05) + 1
        values[row : row + round(high / 0.05), column : column + round(wide / 0.05)] = OCCUPIED
    return OccupancyMap(GridFrame(0.05, -0.05, -0.05, *values.shape), values)


def swept(plan: CoveragePlan, frame: GridFrame, tool_width: float = TOOL) -> Mask:
    """The cells with centres within half the tool's width of the way: slow and independent."""
    line = shapely.LineString(np.repeat(plan.points, 2 if len(plan.points) == 1 else 1, axis=0))
    x = frame.origin_x + (np.arange(frame.columns) + 0.5) * frame.resolution
    y = frame.origin_y + (np.arange(frame.rows) + 0.5) * frame.resolution
    disc = line.buffer(tool_width / 2 + 1e-3, quad_segs=32)
    shapely.prepare(disc)
    inside: Mask = shapely.contains_xy(disc, *np.meshgrid(x, y))
    return inside


def share_swept(
    plan: CoveragePlan, need: Mask, frame: GridFrame, tool_width: float = TOOL
) -> float:
    return float((swept(plan, frame, tool_width) & need).sum() / need.sum())


def least_room(
    plan: CoveragePlan,
    map: OccupancyMap,
    obstacles: tuple[RoundObstacle, ...] = (),
    reach: float = REACH,
) -> float:
    fit = FitMap.build(map, reach, 0.0, obstacles)
    points = [(float(x), float(y)) for x, y in plan.points]
    return min(fit.room_along(*leg) for leg in pairwise(points))


FLAT = room(3.0, 2.4, (1.2, 0.9, 0.05, 0.05), (2.2, 0.0, 0.5, 0.8))
START = (0.4, 0.3)


@st.composite
def cluttered_rooms(draw: st.DrawFn) -> OccupancyMap:
    things = draw(
        st.lists(
            st.tuples(st.integers(0, 36), st.integers(0, 30), st.integers(1, 9), st.integers(1, 9)),
            max_size=6,
        )
    )
    return room(2.0, 1.7, *((x * 0.05, y * 0.05, w * 0.05, h * 0.05) for x, y, w, h in things))


@given(cluttered_rooms(), st.floats(0.1, 1.9), st.floats(0.1, 1.6), st.booleans())
@settings(max_examples=examples(50), derandomize=True, deadline=None)
def test_sweeps_all_that_can_be_reached_and_keeps_clear_of_walls(
    map: OccupancyMap, x: float, y: float, comes_back: bool
) -> None:
    reach, tool = 0.11, 0.14
    planner = CoveragePlanner(map, reach, tool, SHARP, CONFIG)
    assume(FitMap.build(map, reach, 0.0).fits_at(x, y))
    end = (x, y) if comes_back else None
    try:
        plan = planner.plan((x, y), end)
    except NoPathError:
        assume(False)
    need = planner.floor.coverable((x, y))
    # Seams of a fifth of a cell count whole cells here, and the rooms are tiny.
    assert share_swept(plan, need, planner.floor.frame, tool) >= 0.99
    if len(plan.points) > 1:
        assert least_room(plan, map, (), reach) >= reach - TOLERANCE
    assert tuple(plan.points[0]) == (x, y)
    if comes_back:
        assert tuple(plan.points[-1]) == (x, y)


def test_an_empty_room_is_swept_with_little_more_than_the_least_way() -> None:
    map = room(5.0, 4.0)
    planner = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG)
    plan = planner.plan((2.5, 0.3), (2.5, 0.3))
    need = planner.floor.coverable((2.5, 0.3))
    least = float(need.sum()) * planner.floor.frame.resolution**2 / TOOL
    assert share_swept(plan, need, planner.floor.frame) >= 0.995
    assert plan.length < 1.12 * least
    assert plan.turning < 90.0


def test_length_and_turning_are_those_of_the_way() -> None:
    plan = CoveragePlan(np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (0.0, 0.0)]))
    assert plan.length == pytest.approx(12.0)
    assert plan.turning == pytest.approx(math.pi / 2 + math.pi - math.atan2(3.0, 4.0))


def test_ends_where_it_is_asked_to() -> None:
    plan = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG).plan(START, (2.7, 2.1))
    assert tuple(plan.points[0]) == START
    assert tuple(plan.points[-1]) == (2.7, 2.1)


@pytest.mark.parametrize("end", [(2.7, 2.35), (2.75, 2.4 - REACH + 0.02), (2.95, 2.4)])
def test_ends_clear_of_walls_where_it_is_asked_to_end_at_one(end: Point) -> None:
    plan = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG).plan(START, end)
    assert math.dist(plan.points[-1], end) < 0.25
    assert least_room(plan, FLAT) >= REACH - TOLERANCE


def test_the_same_input_gives_the_same_plan_whatever_was_planned_before() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    first = planner.plan(START, START)
    planner.plan((2.5, 1.5), obstacles=[(1.0, 1.5, 0.1)])
    assert np.array_equal(planner.plan(START, START).points, first.points)
    other = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG).plan(START, START)
    assert np.array_equal(other.points, first.points)


def test_sweeps_patches_with_a_short_way() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    coverable = planner.floor.coverable(START)
    todo = np.zeros_like(coverable)
    for x, y in ((0.3, 2.0), (1.5, 1.5), (1.6, 0.1)):
        row, column = planner.floor.frame.cell_of(x, y)
        todo[row : row + 12, column : column + 8] = True
    plan = planner.plan(START, START, todo=todo)
    assert share_swept(plan, todo & coverable, planner.floor.frame) >= 0.97
    assert plan.length < 9.0
    assert least_room(plan, FLAT) >= REACH - TOLERANCE


@pytest.mark.parametrize(
    ("end", "expected"), [(None, [START]), (START, [START]), ((1.0, 2.0), [START, (1.0, 2.0)])]
)
def test_nothing_to_do_is_no_way_but_to_the_end(end: Point | None, expected: list[Point]) -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    plan = planner.plan(START, end, todo=np.zeros(planner.floor.frame.shape, np.bool_))
    assert [tuple(point) for point in plan.points] == expected


def test_keeps_clear_of_obstacles_that_the_map_does_not_show() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    obstacles = ((0.9, 1.6, 0.12), (1.9, 1.7, 0.05))
    plan = planner.plan(START, START, obstacles=obstacles)
    assert least_room(plan, FLAT, obstacles) >= REACH - TOLERANCE
    need = planner.floor.with_obstacles(obstacles).coverable(START)
    assert share_swept(plan, need, planner.floor.frame) >= 0.995
    assert least_room(planner.plan(START, START), FLAT, obstacles) < REACH - TOLERANCE


def test_edges_only_stays_along_walls_and_furniture() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    plan = planner.plan(START, START, edges_only=True)
    done = swept(plan, planner.floor.frame)
    frame = planner.floor.frame
    assert done[frame.cell_of(0.09, 1.2)]
    assert done[frame.cell_of(1.5, 2.31)]
    assert not done[frame.cell_of(1.8, 1.5)]
    assert not plan.swaths
    assert plan.length < 0.6 * planner.plan(START, START).length


def test_rooms_without_a_way_to_them_do_not_count() -> None:
    map = room(4.0, 2.0, (1.9, 0.0, 0.1, 2.0))
    planner = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG)
    need = planner.floor.coverable((0.5, 0.5))
    assert not need[planner.floor.frame.cell_of(3.0, 1.0)]
    plan = planner.plan((0.5, 0.5))
    assert plan.points[:, 0].max() < 1.9
    assert share_swept(plan, need, planner.floor.frame) >= 0.995
    with pytest.raises(NoPathError) as refusal:
        planner.plan((0.5, 0.5), (3.0, 1.0))
    assert refusal.value.reason is NoPathReason.GOAL_UNREACHABLE


def test_a_start_in_the_station_counts_as_just_in_front_of_it() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    plan = planner.plan((0.05, 1.0), (0.05, 1.0))
    assert tuple(plan.points[0]) == (0.05, 1.0)
    assert math.dist(plan.points[-1], (0.05, 1.0)) < 0.13
    need = planner.floor.coverable((0.05, 1.0))
    assert share_swept(plan, need, planner.floor.frame) >= 0.995


@pytest.mark.parametrize("start", [(9.0, 9.0), (2.45, -0.5), (-3.0, 1.0)])
def test_a_robot_that_cannot_move_gets_no_plan(start: Point) -> None:
    with pytest.raises(NoPathError) as refusal:
        CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG).plan(start)
    assert refusal.value.reason is NoPathReason.START_BLOCKED


def test_a_station_behind_a_thin_wall_is_not_in_this_room() -> None:
    map = room(3.0, 2.0, (1.0, 0.0, 0.05, 2.0), (0.0, 0.3, 1.0, 0.05))
    floor = CoverageFloor.build(map, REACH, TOOL, CONFIG)
    assert not floor.middles((0.9, 0.15)).any()


def test_unknown_floor_is_solid() -> None:
    map = room(2.0, 2.0)
    map.values[:, 20:] = UNKNOWN
    need = CoverageFloor.build(map, REACH, TOOL, CONFIG).coverable((0.5, 1.0))
    assert need.any()
    assert not need[:, 95:].any()


@pytest.mark.parametrize("length", [0.0, -0.1, math.nan, math.inf])
def test_lengths_that_make_no_sense_are_refused(length: float) -> None:
    with pytest.raises(ValueError, match="reach"):
        CoveragePlanner(FLAT, length, TOOL, SHARP, CONFIG)
    with pytest.raises(ValueError, match="tool_width"):
        CoveragePlanner(FLAT, REACH, length, SHARP, CONFIG)


def test_points_masks_and_obstacles_that_make_no_sense_are_refused() -> None:
    planner = CoveragePlanner(FLAT, REACH, TOOL, SHARP, CONFIG)
    with pytest.raises(ValueError, match="finite"):
        planner.plan((math.nan, 1.0))
    with pytest.raises(ValueError, match="finite"):
        planner.plan(START, (1.0, math.inf))
    with pytest.raises(ValueError, match="todo"):
        planner.plan(START, todo=np.ones((3, 3), np.bool_))
    with pytest.raises(ValueError, match="obstacle"):
        planner.plan(START, obstacles=[(1.0, 1.0, -0.1)])


def slanted_room(degrees: float) -> OccupancyMap:
    """A room of 3 m whose lower wall is straight, slanted, and drawn into all cells it touches."""
    map = room(3.0, 3.0)
    values = map.values.copy()
    x, y = np.meshgrid(np.arange(values.shape[1] + 1) * 0.05, np.arange(values.shape[0] + 1) * 0.05)
    above = y - 0.3 - math.tan(math.radians(degrees)) * x
    values[np.minimum(above[:-1, :-1], above[:-1, 1:]) < 0.0] = OCCUPIED
    return OccupancyMap(map.frame, values)


def test_along_a_slanted_wall_the_plan_is_smooth_and_tells_what_it_leaves() -> None:
    map, start = slanted_room(17.0), (1.5, 2.0)
    planner = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG)
    plan = planner.plan(start)
    assert least_room(plan, map) >= REACH - TOLERANCE
    need, left = planner.floor.coverable(start), planner.rounded_off(start)
    assert not (left & ~need).any()
    assert 0.0 < left.sum() / need.sum() < 0.02
    assert share_swept(plan, need & ~left, planner.floor.frame) >= 0.997
    # It is in the dips: no other plan sweeps it either, and a wall along the grid has none.
    assert swept(plan, planner.floor.frame)[left].mean() < 0.5
    straight = CoveragePlanner(slanted_room(0.0), REACH, TOOL, SHARP, CONFIG)
    assert not straight.rounded_off(start).any()


@given(st.floats(0.0, 90.0))
@settings(max_examples=examples(6))
def test_a_turned_room_is_swept_as_well_and_by_hardly_more_way(degrees: float) -> None:
    things = ((0.6, 0.3, 0.9, 0.6), (-1.6, -1.0, 0.4, 0.4))
    shares, ratios = [], []
    for angle in (0.0, degrees):
        map = turned_room(4.4, 3.0, angle, *things)
        planner = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG)
        plan = planner.plan((0.0, 0.0), (0.0, 0.0))
        need = planner.floor.coverable((0.0, 0.0))
        shares.append(share_swept(plan, need, planner.floor.frame))
        ratios.append(plan.length * TOOL / (need.sum() * planner.floor.frame.resolution**2))
        assert least_room(plan, map) > -TOLERANCE
    assert shares[1] > shares[0] - 0.01
    assert ratios[1] < 1.2 * ratios[0]


@pytest.mark.parametrize("angle", [0.0, 17.0])
def test_swaths_along_the_axes_are_shifted_off_the_middles_of_cells_and_slanted_ones_are_not(
    angle: float,
) -> None:
    laid: list[NDArray[np.float64]] = []

    def noted(
        left: Mask, middles: Mask, radius: float, config: CoverageConfig
    ) -> list[NDArray[np.float64]]:
        laid.extend(OUR_STAGES.swaths(left, middles, radius, config))
        return laid

    stages = replace(OUR_STAGES, swaths=noted)
    map = turned_room(4.4, 3.0, angle)
    swaths = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG, stages).plan((0.0, 0.0)).swaths
    is_slanted = [bool((line[0] != line[1]).all()) for line in laid]
    assert sum(is_slanted) > 0.8 * len(laid) if angle else not any(is_slanted)
    corner = np.array((map.frame.origin_x, map.frame.origin_y))
    for line, in_cells, slanted in zip(swaths, laid, is_slanted, strict=True):
        shift = np.round((line - corner) / 0.01 - 0.5 - in_cells, 6) % 1.0
        assert sorted(shift[0]) == pytest.approx([0.0, 0.0] if slanted else [0.0, 0.2])


@pytest.mark.parametrize("is_upright", [False, True])
@pytest.mark.parametrize(("side", "shifts"), [(1.0, (0.2, -0.2)), (0.35, (0.0, 0.0))])
def test_a_swath_at_the_rim_is_shifted_inwards_and_one_with_no_room_beside_it_is_not(
    side: float, shifts: tuple[float, float], is_upright: bool
) -> None:
    laid: list[NDArray[np.float64]] = []

    def at_the_rims(
        left: Mask, middles: Mask, radius: float, config: CoverageConfig
    ) -> list[NDArray[np.float64]]:
        (top, first), (bottom, last) = np.argwhere(middles)[[0, -1]].astype(np.float64)
        ends = [(first, top), (last, bottom)]
        for x, y in ends:
            flat, upright = [(first, y), (last, y)], [(x, top), (x, bottom)]
            laid.append(np.array(upright if is_upright else flat))
        return laid

    stages = replace(OUR_STAGES, swaths=at_the_rims)
    map = room(side, 2.0) if is_upright else room(2.0, side)
    plan = CoveragePlanner(map, REACH, TOOL, SHARP, CONFIG, stages).plan((side / 2, side / 2))
    corner = np.array((map.frame.origin_x, map.frame.origin_y))
    for line, in_cells, shift in zip(plan.swaths, laid, shifts, strict=True):
        moved = (line - corner) / CONFIG.cell - 0.5 - in_cells
        apart = np.unique(np.round(moved - np.round(moved), 6), axis=0)
        assert apart == pytest.approx(np.array([(shift, 0.0) if is_upright else (0.0, shift)]))
    assert least_room(plan, map) > -TOLERANCE
