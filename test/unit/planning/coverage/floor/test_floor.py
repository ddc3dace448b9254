"""Floor that a tool can reach, against distances from every fine cell to all that is solid."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.references.straight_ways import connected_to
from fixtures.thoroughness import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from roomba.arrays import Mask
from roomba.configuration.coverage import CoverageConfig
from roomba.geometry import RoundObstacle
from roomba.grid import FREE, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.coverage.floor.floor import CoverageFloor, fine_frame

CONFIG = CoverageConfig()

CELL, ORIGIN, REACH, TOOL = 0.03, (-0.4, 0.7), 0.033, 0.09
SURE = 1e-6

MAPS = arrays(
    np.bool_,
    st.tuples(st.integers(4, 9), st.integers(4, 9)),
    elements=st.integers(0, 6).map(lambda number: number == 0),
    fill=st.just(False),
)
OBSTACLES = st.lists(
    st.tuples(st.integers(-2, 25), st.integers(-2, 25), st.integers(0, 5)).map(
        lambda at: (ORIGIN[0] + at[0] / 100, ORIGIN[1] + at[1] / 100, at[2] / 100)
    ),
    max_size=2,
)


def map_of(solid: Mask) -> OccupancyMap:
    frame = GridFrame(CELL, *ORIGIN, *solid.shape)
    return OccupancyMap(frame, np.where(solid, UNKNOWN, FREE).astype(np.int8))


def solid_shape(made: OccupancyMap) -> shapely.Geometry:
    """Solid cells as squares, and the outside of the map."""
    low_x, high_x, low_y, high_y = made.frame.extent
    squares = []
    for row, column in np.argwhere(made.solid).tolist():
        x, y = made.frame.centre_of(row, column)
        squares.append(shapely.Point(x, y).buffer(CELL / 2, cap_style="square"))
    outside = shapely.box(-9, -9, 9, 9) - shapely.box(low_x, low_y, high_x, high_y)
    return shapely.union_all([outside, *squares])


def assert_fits(floor: CoverageFloor, made: OccupancyMap, obstacles: list[RoundObstacle]) -> None:
    things = solid_shape(made)
    shapely.prepare(things)
    for row, column in np.ndindex(floor.frame.shape):
        x, y = floor.frame.centre_of(row, column)
        rooms = [math.dist((x, y), (at_x, at_y)) - radius for at_x, at_y, radius in obstacles]
        room = min([shapely.distance(things, shapely.Point(x, y)), *rooms])
        if abs(room - REACH) > SURE:
            assert floor.fits[row, column] == (room > REACH)


@given(MAPS, OBSTACLES)
@settings(max_examples=examples(20))
def test_the_middle_fits_where_it_keeps_its_reach_from_all_that_is_solid(
    solid: Mask, obstacles: list[RoundObstacle]
) -> None:
    made = map_of(solid)
    floor = CoverageFloor.build(made, REACH, TOOL, CONFIG)
    assert abs(floor.frame.resolution - CONFIG.cell) < 1e-12
    assert floor.frame.extent == made.frame.extent
    assert_fits(floor, made, [])
    among = floor.with_obstacles(obstacles)
    assert_fits(among, made, obstacles)
    assert np.array_equal(among.with_obstacles(()).fits, floor.fits)


@given(MAPS, st.data())
@settings(max_examples=examples(25))
def test_what_is_swept_is_free_floor_near_a_middle_that_can_be_got_to(
    solid: Mask, data: st.DataObject
) -> None:
    floor = CoverageFloor.build(map_of(solid), REACH, TOOL, CONFIG)
    cells = [(row, column) for row, column in np.argwhere(floor.fits).tolist()]
    assume(cells)
    start = data.draw(st.sampled_from(cells))
    middles = floor.middles(floor.frame.centre_of(*start))
    reachable = connected_to(floor.fits, start)
    assert {(row, column) for row, column in np.argwhere(middles).tolist()} == reachable
    coverable = floor.coverable(floor.frame.centre_of(*start))
    parts = floor.frame.rows // solid.shape[0]
    at = np.array(sorted(reachable))
    for row, column in np.ndindex(coverable.shape):
        away = np.hypot(at[:, 0] - row, at[:, 1] - column).min() * floor.frame.resolution
        is_free = not solid[row // parts, column // parts]
        if abs(away - TOOL / 2) > SURE:
            assert coverable[row, column] == (is_free and away < TOOL / 2)


@given(MAPS, st.integers(-15, 40), st.integers(-15, 40))
@settings(max_examples=examples(50))
def test_a_robot_that_does_not_fit_counts_as_at_the_nearest_place_with_no_wall_between(
    solid: Mask, right: int, up: int
) -> None:
    made = map_of(solid)
    floor = CoverageFloor.build(made, REACH, TOOL, CONFIG)
    point = ORIGIN[0] + right / 100 + 0.0041, ORIGIN[1] + up / 100 + 0.0023
    found = floor.cell_near(point)
    own = floor.frame.cell_of(*point)
    if floor.frame.contains(*point) and floor.fits[own]:
        assert found == own
        return
    ways = []
    for row, column in np.argwhere(floor.fits).tolist():
        away = math.dist(floor.frame.centre_of(row, column), point)
        if away <= 0.4:
            ways.append((away, (row, column)))
    expected = next(
        (cell for _, cell in sorted(ways) if not enters(made, point, floor, cell)), None
    )
    assert found == expected


def enters(
    made: OccupancyMap, point: tuple[float, float], floor: CoverageFloor, cell: tuple[int, int]
) -> bool:
    """Whether the straight way to a cell goes into what is solid again after it was free.

    Looked at in steps of half a fine cell, as far apart as a thinnest wall is wide or less.
    """
    to_x, to_y = floor.frame.centre_of(*cell)
    steps = max(2, math.ceil(2 * math.dist(point, (to_x, to_y)) / floor.frame.resolution))
    was_free = False
    for step in range(steps):
        share = step / (steps - 1)
        x, y = point[0] + share * (to_x - point[0]), point[1] + share * (to_y - point[1])
        at = made.frame.cell_of(x, y)
        is_free = made.frame.contains(x, y) and not made.solid[at]
        if was_free and not is_free:
            return True
        was_free = is_free
    return False


@pytest.mark.parametrize(("cell", "parts"), [(0.01, 5), (0.025, 2), (0.05, 1)])
def test_floor_is_counted_on_cells_as_configured(cell: float, parts: int) -> None:
    frame = fine_frame(GridFrame(0.05, 1.0, 2.0, 8, 6), cell)
    assert frame.shape == (8 * parts, 6 * parts)
    assert frame.resolution == pytest.approx(0.05 / parts)
