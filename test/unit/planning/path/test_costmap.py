"""Where the body fits, against slow and independent geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from roomba.arrays import Mask
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.planning.path.costmap import FitMap, room_beside


def occupancy(solid: Mask, resolution: float = 0.05, origin: float = 0.0) -> OccupancyMap:
    frame = GridFrame(resolution, origin, -origin, *solid.shape)
    return OccupancyMap(frame, np.where(solid, OCCUPIED, FREE).astype(np.int8))


def solid_things(map: OccupancyMap) -> shapely.Geometry:
    """Every solid cell as a square, and all outside the map as a wide frame around it."""
    x_min, x_max, y_min, y_max = map.frame.extent
    size = map.frame.resolution
    squares = [
        shapely.box(
            x_min + c * size, y_min + r * size, x_min + (c + 1) * size, y_min + (r + 1) * size
        )
        for r, c in np.argwhere(map.solid)
    ]
    around = shapely.box(x_min - 9, y_min - 9, x_max + 9, y_max + 9)
    return shapely.union_all([*squares, around - shapely.box(x_min, y_min, x_max, y_max)])


SMALL_MAPS = st.tuples(st.integers(1, 14), st.integers(1, 14)).flatmap(
    lambda shape: hnp.arrays(np.bool_, shape, elements=st.integers(0, 7).map(lambda n: n == 0))
)


@given(SMALL_MAPS, st.floats(0.01, 0.25), st.floats(0.0, 0.1))
@settings(max_examples=examples(150), deadline=None)
def test_fits_exactly_where_the_disc_touches_nothing_solid(
    solid: Mask, radius: float, clearance: float
) -> None:
    map = occupancy(solid, origin=-1.3)
    fits = FitMap.build(map, radius, clearance).fits
    things = solid_things(map)
    for row, column in np.ndindex(solid.shape):
        room = things.distance(shapely.Point(map.frame.centre_of(row, column)))
        if abs(room - radius - clearance) > 1e-7:
            assert fits[row, column] == (room > radius + clearance)


@given(
    SMALL_MAPS,
    st.lists(st.tuples(st.floats(-0.1, 0.8), st.floats(-0.1, 0.8), st.floats(0, 0.2)), max_size=3),
    st.tuples(*[st.floats(0.0, 0.7)] * 4),
)
@settings(max_examples=examples(150), deadline=None)
def test_room_along_is_the_distance_of_the_way_from_all_that_is_solid(
    solid: Mask,
    obstacles: list[tuple[float, float, float]],
    way: tuple[float, float, float, float],
) -> None:
    map = occupancy(solid)
    fit = FitMap.build(map, 0.1, 0.02, obstacles)
    line = shapely.LineString([way[:2], way[2:]])
    expected = solid_things(map).distance(line)
    for x, y, radius in obstacles:
        expected = min(expected, line.distance(shapely.Point(x, y)) - radius)
    limit = 0.12 + 0.05
    assert fit.room_along(way[:2], way[2:]) == pytest.approx(min(expected, limit), abs=1e-9)


@given(
    st.lists(
        st.tuples(st.floats(-0.5, 1.5), st.floats(-0.5, 1.5), st.floats(0, 0.3)),
        min_size=1,
        max_size=4,
    )
)
@settings(max_examples=examples(100), deadline=None)
def test_obstacles_are_added_to_the_walls_and_taken_away_again(
    obstacles: list[tuple[float, float, float]],
) -> None:
    solid = np.zeros((20, 24), np.bool_)
    solid[5, 5:15] = True
    walls = FitMap.build(occupancy(solid), 0.1, 0.02)
    fit = walls.with_obstacles(obstacles)
    for row, column in np.ndindex(solid.shape):
        x, y = walls.map.frame.centre_of(row, column)
        room = min(math.hypot(x - at_x, y - at_y) - radius for at_x, at_y, radius in obstacles)
        if abs(room - 0.12) > 1e-7:
            assert fit.fits[row, column] == (walls.fits[row, column] and room > 0.12)
    assert np.array_equal(fit.with_obstacles(()).fits, walls.fits)


@given(
    st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 2, st.floats(0.0, 2.0)), max_size=4),
    st.tuples(*[st.floats(-3.0, 3.0)] * 4),
)
@settings(max_examples=examples(100), deadline=None)
def test_room_beside_circles_is_the_distance_of_the_way_from_the_nearest(
    circles: list[tuple[float, float, float]], way: tuple[float, float, float, float]
) -> None:
    line = shapely.LineString((way[:2], way[2:]))
    rooms = [line.distance(shapely.Point(x, y)) - radius for x, y, radius in circles]
    room = room_beside(np.array(circles, np.float64).reshape(-1, 3), *way)
    assert room == pytest.approx(min(rooms, default=math.inf), abs=1e-9)


def test_a_body_exactly_as_far_as_it_must_be_fits() -> None:
    solid = np.zeros((40, 40), np.bool_)
    solid[:, 0] = True
    fit = FitMap.build(occupancy(solid), 0.17425, 0.01)
    assert fit.fits_at(0.05 + 0.18425, 1.0)
    assert not fit.fits_at(0.05 + 0.18425 - 1e-6, 1.0)


def test_unknown_cells_and_the_outside_of_the_map_are_solid() -> None:
    values = np.full((9, 9), FREE, np.int8)
    values[4, 4] = UNKNOWN
    fit = FitMap.build(OccupancyMap(GridFrame(0.1, 0.0, 0.0, 9, 9), values), 0.1, 0.0)
    assert not fit.fits[4, 4]
    assert not fit.fits[0].any()
    assert fit.fits[1, 1]
    assert fit.room_along((-5.0, 0.5), (0.5, 0.5)) == 0.0


def test_regions_do_not_join_over_a_corner() -> None:
    solid = np.array([[0, 0, 1], [0, 0, 1], [1, 1, 0]], np.bool_)
    regions = FitMap.build(occupancy(solid, 1.0), 0.3, 0.0).regions
    assert regions[0, 0] == regions[1, 1] != regions[2, 2]
    assert regions[0, 2] == 0


@pytest.mark.parametrize(
    ("radius", "clearance"),
    [(0.0, 0.1), (-0.1, 0.2), (0.1, -0.01), (math.nan, 0.0), (0.1, math.inf)],
)
def test_a_body_that_cannot_be_is_refused(radius: float, clearance: float) -> None:
    with pytest.raises(ValueError, match="expected a finite body_radius above 0"):
        FitMap.build(occupancy(np.zeros((3, 3), np.bool_)), radius, clearance)


@pytest.mark.parametrize("obstacle", [(math.nan, 0.0, 0.1), (0.0, math.inf, 0.1), (0.0, 0.0, -0.1)])
def test_an_obstacle_that_cannot_be_is_refused(obstacle: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="expected an obstacle as finite"):
        FitMap.build(occupancy(np.zeros((3, 3), np.bool_)), 0.1, 0.0, [obstacle])


def slanted_wall(degrees: float, cells: int = 60) -> tuple[OccupancyMap, shapely.Geometry]:
    """A map of a straight wall through its middle that tells of each cell how much is solid."""
    middle = 0.5 * cells
    half = shapely.box(-2 * cells, -2 * cells, 2 * cells, 0.0)
    below = shapely.affinity.translate(
        shapely.affinity.rotate(half, degrees, origin=(0.0, 0.0)), middle, middle
    )
    columns, rows = np.meshgrid(np.arange(cells), np.arange(cells))
    squares = shapely.box(columns, rows, columns + 1, rows + 1)
    shares = shapely.area(shapely.intersection(squares, below))
    values = np.ceil(OCCUPIED * shares - 1e-6).astype(np.int8)
    wall = shapely.affinity.scale(below, 0.05, 0.05, origin=(0.0, 0.0))
    return OccupancyMap(GridFrame(0.05, 0.0, 0.0, cells, cells), values), wall


@pytest.mark.parametrize("degrees", [8.0, 17.0, 30.0, 45.0, 100.0])
def test_a_slanted_wall_is_where_its_cells_say(degrees: float) -> None:
    """It keeps a margin of 1 cm more; the nearest middle of a cell may be a little farther off."""
    map, wall = slanted_wall(degrees)
    reach = 0.16 + 0.005
    fit = FitMap.build(map, 0.16, 0.005)
    rooms = []
    for row, column in np.argwhere(fit.fits).tolist():
        x, y = map.frame.centre_of(row, column)
        if min(x, y, 3.0 - x, 3.0 - y) > 0.5:
            rooms.append(wall.distance(shapely.Point(x, y)))
    assert reach + 0.005 <= min(rooms) < reach + 0.05
    across, along = (
        np.array((-math.sin(math.radians(degrees)), math.cos(math.radians(degrees)))),
        (np.array((math.cos(math.radians(degrees)), math.sin(math.radians(degrees))))),
    )
    for away, fits in ((reach + 0.035, True), (reach + 0.003, False)):
        start, end = (1.5 + away * across + way * along for way in (-0.5, 0.5))
        assert fit.fits_along((start[0], start[1]), (end[0], end[1])) == fits
