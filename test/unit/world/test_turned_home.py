"""Homes turned by any angle, against plain polygons that are turned by a library."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import DT, IDEAL, block_that_moves
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely.affinity import rotate

from roomba.configuration.sensors import CameraConfig, LidarConfig
from roomba.geometry import Pose, Twist
from roomba.grid import FREE, OCCUPIED, UNKNOWN, GridFrame, OccupancyMap
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import Home, Move, Rectangle, Room
from roomba.world.home.turned import turned_home
from roomba.world.lidar import Lidar
from roomba.world.simulator import Simulator

HOME = room_home(blocks=((1.4, 1.1, 1.9, 1.3), (2.6, 0.6, 2.65, 2.0)))
SLIDES = block_that_moves(Move(0.0, 4.0, Pose(3.0, 2.0, 1.0)), pose=Pose(2.2, 2.2, 0.3))
RADIUS = IDEAL.body.radius
CAMERA = CameraConfig(width=160, height=120)

angles = st.floats(-math.pi, math.pi)


@cache
def solid_of_home() -> shapely.Geometry:
    """Return what is solid in HOME in its own axes: slow and plain."""
    frame = HOME.frame
    rows, columns = np.nonzero(HOME.solid)
    left = frame.origin_x + columns * frame.resolution
    low = frame.origin_y + rows * frame.resolution
    cells = shapely.box(left, low, left + frame.resolution, low + frame.resolution)
    # A hair's breadth more, so that no gap stays between cells.
    return shapely.union_all(shapely.buffer(cells, 1e-9, join_style="mitre"))


def solid_turned(angle: float) -> shapely.Geometry:
    """Return the same, turned."""
    return rotate(solid_of_home(), angle, origin=(0.0, 0.0), use_radians=True)


def way_to(solid: shapely.Geometry, x: float, y: float, direction: float) -> float:
    """Return how far a ray goes from a point to the solid, m."""
    end = x + 50.0 * math.cos(direction), y + 50.0 * math.sin(direction)
    met = shapely.intersection(shapely.LineString([(x, y), end]), solid)
    return float(shapely.distance(shapely.Point(x, y), met))


def is_clear(solid: shapely.Geometry, x: float, y: float, direction: float, way: float) -> bool:
    """Whether a ray grazes no corner: right beside it another one goes as far."""
    beside = [way_to(solid, x, y, direction + off) for off in (-1e-3, 1e-3)]
    return all(abs(each - way) < 0.05 for each in beside)


@settings(max_examples=examples(20), deadline=None)
@given(angle=angles, x=st.floats(0.4, 1.2), y=st.floats(0.4, 2.4), theta=angles)
def test_the_lidar_meets_slanted_walls_exactly(
    angle: float, x: float, y: float, theta: float
) -> None:
    home = turned_home(HOME, angle)
    pose = Pose(0.0, 0.0, angle).compose(Pose(x, y, theta))
    config = LidarConfig(min_range=1e-3)
    ranges = Lidar.of(home, config).scan(np.array([[pose.x, pose.y, pose.theta]]))[0]
    solid = solid_turned(angle)
    compared = 0
    for beam in range(0, config.beams, 7):
        direction = pose.theta + beam * 2.0 * math.pi / config.beams
        way = way_to(solid, pose.x, pose.y, direction)
        if is_clear(solid, pose.x, pose.y, direction, way):
            assert ranges[beam] == pytest.approx(way, abs=1e-3)
            compared += 1
    assert compared > 30


@settings(max_examples=examples(15), deadline=None)
@given(angle=angles, theta=angles, turns=st.floats(-0.6, 0.6))
def test_the_round_body_comes_to_rest_at_a_slanted_wall(
    angle: float, theta: float, turns: float
) -> None:
    start = Pose(0.0, 0.0, angle).compose(Pose(0.8, 1.6, theta))
    world = Simulator(turned_home(HOME, angle), IDEAL, start=start)
    solid = solid_turned(angle)
    for _ in range(60):
        world.advance(Twist(0.3, turns), DT, 8)
        away = shapely.distance(shapely.Point(world.pose.x, world.pose.y), solid)
        assert away > RADIUS - 1e-5
        assert world.gap == pytest.approx(min(away - RADIUS, RADIUS), abs=1e-5)
        if world.observe().bumper.pressed:
            assert away < RADIUS + 2e-3
    assert world.numbers["hits"] > 0.0 or abs(turns) > 0.2


@settings(max_examples=examples(10), deadline=None)
@given(angle=angles, x=st.floats(0.5, 1.1), y=st.floats(0.5, 2.3), theta=angles)
def test_the_camera_sees_slanted_walls_exactly(
    angle: float, x: float, y: float, theta: float
) -> None:
    camera = Camera(Scene.of(turned_home(HOME, angle)), CAMERA, supersampling=1)
    pose = Pose(0.0, 0.0, angle).compose(Pose(x, y, theta))
    lens = pose.compose(Pose(CAMERA.mount_forward, 0.0, 0.0))
    solid = solid_turned(angle)
    if shapely.distance(shapely.Point(lens.x, lens.y), solid) < 0.05:
        return
    level = camera.depth(pose, 0.0)[CAMERA.height // 2 - 1]
    for column in range(0, CAMERA.width, 9):
        aside = math.atan2(0.5 * CAMERA.width - column - 0.5, camera.focal)
        way = way_to(solid, lens.x, lens.y, lens.theta + aside)
        if is_clear(solid, lens.x, lens.y, lens.theta + aside, way):
            assert level[column] == pytest.approx(way * math.cos(aside), abs=2e-3)


@settings(max_examples=examples(10), deadline=None)
@given(angle=angles)
def test_the_map_shows_slanted_walls_as_steps(angle: float) -> None:
    turned = turned_home(HOME, angle)
    share, inside = _shares(turned.frame, angle)
    whole = inside > 0.999
    assert whole.sum() > 0.8 * HOME.solid.size
    shown = turned.map.values
    # An edge that is hardly aslant takes a whole row of nine, and shares are rounded up.
    assert np.abs(shown[whole] - OCCUPIED * share[whole]).max() < OCCUPIED / 9 + 1.0
    assert (shown[whole & (share > 0.03)] > FREE).all()
    assert (shown[whole & (share < 1e-6)] == FREE).all()
    assert turned.solid[whole & (share > 0.03)].all()
    assert not turned.solid[whole & (share < 1e-6)].any()
    assert turned.solid[inside == 0.0].all()


@settings(max_examples=examples(10), deadline=None)
@given(angle=angles)
def test_what_is_not_known_behind_a_wall_is_as_solid(angle: float) -> None:
    # Walls of one cell, as robots' own maps have them: what is behind was never seen.
    values = HOME.map.values.copy()
    values[[0, -1], :] = values[:, [0, -1]] = UNKNOWN
    turned = turned_home(replace(HOME, map=OccupancyMap(HOME.frame, values)), angle)
    share, inside = _shares(turned.frame, angle)
    shown = turned.map.values
    walled = (shown > FREE) & (inside > 0.999)
    assert walled.sum() > 100
    assert np.abs(shown[walled] - OCCUPIED * share[walled]).max() < OCCUPIED / 9 + 1.0


def _shares(frame: GridFrame, angle: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how much of each cell is solid in HOME, turned, and lies on its grid, 0..1."""
    left, low = np.meshgrid(
        frame.origin_x + np.arange(frame.columns) * frame.resolution,
        frame.origin_y + np.arange(frame.rows) * frame.resolution,
    )
    cells = shapely.box(left, low, left + frame.resolution, low + frame.resolution)
    outline = rotate(_outline(HOME), angle, (0.0, 0.0), use_radians=True)
    area = frame.resolution**2
    return _area_in(solid_turned(angle), cells) / area, _area_in(outline, cells) / area


def _area_in(shape: shapely.Geometry, cells: NDArray[np.object_]) -> NDArray[np.float64]:
    """Return how much of each cell lies in a shape, m2; those on its border alone are cut."""
    shapely.prepare(shape)
    areas = np.where(shapely.covers(shape, cells), shapely.area(cells), 0.0)
    cut = shapely.intersects(shape, cells) & (areas == 0.0)
    areas[cut] = shapely.area(shapely.intersection(cells[cut], shape))
    return areas


def _outline(home: Home) -> shapely.Polygon:
    x_min, x_max, y_min, y_max = home.frame.extent
    return shapely.box(x_min, y_min, x_max, y_max)


def test_what_is_told_of_things_and_places_is_turned() -> None:
    angle = 0.7
    axes = Pose(0.0, 0.0, angle)
    own = room_home(moving=(SLIDES,))
    plain = Simulator(own, IDEAL, start=Pose(0.8, 1.0, 0.2))
    world = Simulator(turned_home(own, angle), IDEAL, start=axes.compose(Pose(0.8, 1.0, 0.2)))
    at = axes.compose(Pose(1.6, 1.0, 0.0))
    world.place_obstacle(at.x, at.y, 0.05)
    plain.place_obstacle(1.6, 1.0, 0.05)
    assert world.discs[0].tolist() == pytest.approx([at.x, at.y, 0.05])
    for each in (world, plain):
        each.advance(Twist(0.2, 0.1), DT, 60)
    expected = axes.compose(plain.pose)
    assert world.pose.distance_to(expected.x, expected.y) < 1e-6
    assert world.pose.theta == pytest.approx(expected.theta)
    assert world.observe().odometry.x == pytest.approx(plain.observe().odometry.x)
    assert world.ranges == pytest.approx(plain.ranges, abs=1e-4)
    thing = axes.compose(Pose(*plain.things[0, :3].tolist()))
    assert world.things[0].tolist() == pytest.approx([thing.x, thing.y, thing.theta, 1.0])
    aside = at.compose(Pose(0.0, 1.0, 0.0))
    world.put(aside)
    assert world.pose.distance_to(aside.x, aside.y) < 1e-9


@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_after_quarter_turns_cells_lie_on_cells(quarters: int) -> None:
    # Maps of others begin anywhere, not at a whole number of cells.
    own = HOME.frame
    frame = replace(own, origin_x=own.origin_x + 0.013, origin_y=own.origin_y - 0.027)
    turned = turned_home(
        replace(HOME, map=OccupancyMap(frame, HOME.map.values)), quarters * math.pi / 2.0
    )
    # Rows go up: what numpy turns clockwise goes counter-clockwise.
    np.testing.assert_array_equal(turned.map.values, np.rot90(HOME.map.values, -quarters))
    np.testing.assert_array_equal(turned.solid, np.rot90(HOME.solid, -quarters))


def test_crumbs_are_spilled_where_the_turned_frame_says() -> None:
    world = Simulator(turned_home(HOME, 2.0), IDEAL)
    own = HOME.station.compose(Pose(0.3, 0.4, 0.0))
    told = Pose(0.0, 0.0, 2.0).compose(own)
    before = world.dirt.micrograms.copy()
    world.spill(told.x, told.y, 0.03, 1.0)
    rows, columns = np.nonzero(world.dirt.micrograms != before)
    x, y = world.dirt.frame.centres(rows, columns)
    assert float(np.hypot(x - own.x, y - own.y).max()) < 0.2


def test_rooms_and_stairs_lie_where_they_turned_to() -> None:
    stairs = Rectangle(2.0, 2.0, 2.5, 2.5)
    room = Room("study", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)), "oak")
    home = turned_home(replace(room_home(), rooms=(room,), stairs=(stairs,)), math.pi / 2.0)
    assert home.room_at(-0.5, 0.5) is not None
    assert home.room_at(0.5, 0.5) is None
    assert home.drop[home.frame.cell_of(-2.2, 2.2)]
    assert home.drop.sum() == pytest.approx(100, abs=1)


def test_a_home_is_turned_once() -> None:
    with pytest.raises(ValueError, match="turned already"):
        turned_home(turned_home(HOME, 0.1), 0.1)


def test_floor_that_is_not_known_is_free_in_no_cell_that_it_touches() -> None:
    """The body does not pass it: if the map told such a cell to be free it would run into it."""
    home = HOME
    values, solid = home.map.values.copy(), home.solid.copy()
    row, column = home.frame.cell_of(2.2, 2.2)
    assert values[row, column] == FREE
    values[row, column], solid[row, column] = UNKNOWN, True
    bare = replace(home, map=OccupancyMap(home.frame, values), solid=solid)
    turned = turned_home(bare, math.radians(17.0))
    x, y = home.frame.centre_of(row, column)
    place = turned.axes.compose(Pose(x, y, 0.0))
    row, column = turned.frame.cell_of(place.x, place.y)
    around = slice(row - 2, row + 3), slice(column - 2, column + 3)
    assert np.count_nonzero(turned.solid[around]) >= 3
    assert not (turned.map.values[around][turned.solid[around]] == FREE).any()
