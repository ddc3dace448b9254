"""The camera: geometry against a slow caster, what is seen where, and repeatability."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from fixtures.homes.camera_rooms import (
    CLEAN,
    CONFIG,
    DIRT_FRAME,
    FRAME,
    FURNISHED,
    INSIDE,
    UNDERSIDE,
    camera_of,
    even_dirt,
    home_with,
    redness,
)
from fixtures.references.slow_camera import slow_depth
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.errors import PictureError
from roomba.geometry import Pose
from roomba.grid import UNKNOWN, OccupancyMap
from roomba.world.camera.camera import Camera, Scene
from roomba.world.home.home import Box, Carpet, Door, Rectangle
from roomba.world.home.materials import MATERIALS

places = st.floats(-2.4, 2.4)


@cache
def furnished_camera() -> Camera:
    """Made by the process that needs it."""
    return Camera(Scene.of(FURNISHED), CONFIG, supersampling=1)


@settings(max_examples=examples(60), deadline=None)
@given(
    x=places,
    y=places,
    theta=st.floats(-math.pi, math.pi),
    pan=st.floats(-0.55, 0.55),
    seed=st.integers(0, 2**32 - 1),
)
def test_depth_is_that_of_a_slow_caster(
    x: float, y: float, theta: float, pan: float, seed: int
) -> None:
    pose = Pose(x, y, theta)
    lens = pose.compose(Pose(CONFIG.mount_forward, 0.0, 0.0))
    if FURNISHED.solid[FURNISHED.frame.cell_of(lens.x, lens.y)]:
        return
    depth = furnished_camera().depth(pose, pan)
    random = np.random.default_rng(seed)
    wrong = 0
    for row, column in zip(random.integers(0, 120, 40), random.integers(0, 160, 40), strict=True):
        true = slow_depth(FURNISHED, CONFIG, pose, pan, int(row), int(column))
        # A micrometre from the lens both are right to differ.
        wrong += abs(depth[row, column] - true) > 1e-3 and true > 0.01
    # A ray along the edge of a box may fall to either side of it.
    assert wrong <= 1


def test_depth_to_a_wall_ahead_is_the_distance() -> None:
    depth = camera_of(home_with()).depth(Pose(-0.4, 0.3, 0.0), 0.0)
    expected = INSIDE - (-0.4 + CONFIG.mount_forward)
    assert depth[50:60, 79:81] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("x", [-0.15, -0.1, 0.0, 0.3])
def test_depth_is_exact_from_the_edge_of_a_cell(x: float) -> None:
    depth = camera_of(home_with()).depth(Pose(x, 0.0, 0.0), 0.0)
    expected = INSIDE - (x + CONFIG.mount_forward)
    assert depth[58] == pytest.approx(expected, abs=1e-3)


def test_depth_does_not_depend_on_supersampling() -> None:
    pose = Pose(-0.5, 0.0, 0.6)
    fine = camera_of(FURNISHED, 2).render(pose, 0.1, CLEAN, DIRT_FRAME)
    coarse = camera_of(FURNISHED, 1).render(pose, 0.1, CLEAN, DIRT_FRAME)
    assert np.array_equal(fine.depth, coarse.depth)
    assert not np.array_equal(fine.colour, coarse.colour)


def test_left_is_left() -> None:
    home = home_with(Box(1.5, 0.6, 0.0, 0.3, 0.3, 0.0, 0.6, "red"))
    seen = redness(camera_of(home).picture(Pose(), 0.0, CLEAN, DIRT_FRAME))
    assert seen[:, :80].sum() > 100
    assert seen[:, 80:].sum() == 0


def test_positive_pan_turns_the_view_left() -> None:
    camera = camera_of(home_with(Box(1.5, 0.0, 0.0, 0.3, 0.3, 0.0, 0.6, "red")))
    middles = [
        float(np.nonzero(redness(camera.picture(Pose(), pan, CLEAN, DIRT_FRAME)))[1].mean())
        for pan in (-0.3, 0.0, 0.3)
    ]
    assert middles[0] < 79.5 - 20.0
    assert middles[1] == pytest.approx(79.5, abs=1.0)
    assert middles[2] > 79.5 + 20.0


def test_a_box_between_is_nearer() -> None:
    empty = camera_of(home_with()).depth(Pose(), 0.0)
    home = home_with(Box(1.2, 0.0, 0.0, 0.4, 0.4, 0.0, 1.0, "white"))
    depth = camera_of(home).depth(Pose(), 0.0)
    assert depth[40, 80] == pytest.approx(1.0 - CONFIG.mount_forward, abs=1e-3)
    assert (depth <= empty).all()


def test_a_box_behind_a_wall_is_not_seen() -> None:
    wall = Rectangle(0.8, -3.0, 1.0, 3.0)
    hidden = camera_of(home_with(Box(2.3, 0.0, 0.0, 0.4, 0.4, 0.0, 2.0, "red"), walls=(wall,)))
    empty = camera_of(home_with(walls=(wall,)))
    pictures = [c.render(Pose(-0.5, 0.2, 0.1), 0.0, CLEAN, DIRT_FRAME) for c in (hidden, empty)]
    # Shadows are soft and know no walls: a little of one comes through.
    difference = np.abs(pictures[0].colour.astype(int) - pictures[1].colour)
    assert difference.max() <= 3
    assert not redness(pictures[0].colour).any()
    assert np.array_equal(pictures[0].depth, pictures[1].depth)


def test_the_underside_of_a_table_is_seen() -> None:
    home = home_with(Box(1.2, 0.0, 0.0, 1.6, 1.6, UNDERSIDE, 0.5, "red"))
    picture = camera_of(home, 1).render(Pose(0.3, 0.0, 0.0), 0.0, CLEAN, DIRT_FRAME)
    row, focal = 20, camera_of(home, 1).focal
    slope = (60.0 - row - 0.5) / focal
    expected = (UNDERSIDE - CONFIG.mount_height) / slope
    assert picture.depth[row, 80] == pytest.approx(expected, abs=1e-3)
    assert redness(picture.colour)[row, 80]


def test_a_low_box_is_seen_from_above() -> None:
    home = home_with(Box(1.2, 0.0, 0.0, 1.6, 1.0, 0.0, 0.04, "red"))
    picture = camera_of(home, 1).render(Pose(), 0.0, CLEAN, DIRT_FRAME)
    row, focal = 67, camera_of(home, 1).focal
    expected = (CONFIG.mount_height - 0.04) * focal / (row + 0.5 - 60.0)
    assert picture.depth[row, 80] == pytest.approx(expected, abs=1e-3)
    assert redness(picture.colour)[row, 80]


@pytest.mark.parametrize(("is_open", "distance"), [(True, 2.65), (False, 0.88)])
def test_a_door_is_seen_open_or_shut(is_open: bool, distance: float) -> None:
    wall = Rectangle(1.0, -3.0, 1.1, 3.0)
    door = Door("door", Rectangle(1.0, -0.45, 1.1, 0.45), is_open)
    depth = camera_of(home_with(walls=(wall,), doors=(door,))).depth(Pose(), 0.0)
    assert depth[50, 80] == pytest.approx(distance, abs=1e-3)


def test_pictures_are_repeated_bit_for_bit() -> None:
    camera, other = camera_of(FURNISHED), camera_of(FURNISHED)
    pose = Pose(-0.3, -0.7, 2.0)
    first = camera.render(pose, 0.2, even_dirt(2.0), DIRT_FRAME)
    kept = first.colour.copy()
    camera.render(Pose(1.0, -1.0, 0.0), 0.0, CLEAN, DIRT_FRAME)
    assert np.array_equal(first.colour, kept), "a picture must not change once it is handed out"
    for again in (camera, other):
        picture = again.render(pose, 0.2, even_dirt(2.0), DIRT_FRAME)
        assert np.array_equal(picture.colour, kept)
        assert np.array_equal(picture.depth, first.depth)


@pytest.mark.parametrize("supersampling", [1, 2])
def test_shape_and_type(supersampling: int) -> None:
    picture = camera_of(FURNISHED, supersampling).render(Pose(), 0.0, CLEAN, DIRT_FRAME)
    assert picture.colour.shape == (120, 160, 3)
    assert picture.colour.dtype == np.uint8
    assert picture.colour.flags.c_contiguous
    assert picture.depth.shape == (120, 160)
    assert picture.depth.dtype == np.float32
    assert np.isfinite(picture.depth).all()
    assert (picture.depth > 0.0).all()


@pytest.mark.parametrize("supersampling", [1, 2])
@pytest.mark.parametrize("width", [7, 100])
def test_any_width_has_a_picture(width: int, supersampling: int) -> None:
    home = home_with(Box(1.6, 0.0, 0.0, 0.4, 0.6, 0.0, 1.0, "red"))
    config = CONFIG.model_copy(update={"width": width})
    picture = Camera(Scene.of(home), config, supersampling).render(Pose(), 0.0, CLEAN, DIRT_FRAME)
    assert picture.colour.shape == (120, width, 3)
    assert picture.colour.flags.c_contiguous
    assert picture.depth[59, width // 2] == pytest.approx(1.4 - CONFIG.mount_forward, abs=1e-4)
    assert redness(picture.colour)[59, width // 2]
    assert not redness(picture.colour)[59, 0]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("slot", ["x", "y", "theta", "pan"])
def test_what_is_not_finite_is_refused(slot: str, bad: float) -> None:
    values = {"x": 0.0, "y": 0.0, "theta": 0.0, "pan": 0.0, slot: bad}
    pose = Pose(values["x"], values["y"], values["theta"])
    with pytest.raises(PictureError, match=rf"{slot}={bad}"):
        furnished_camera().picture(pose, values["pan"], CLEAN, DIRT_FRAME)


def test_dirt_that_does_not_fit_is_refused() -> None:
    with pytest.raises(PictureError, match=r"\(60, 60\).*\(3, 4\)"):
        furnished_camera().picture(Pose(), 0.0, np.zeros((3, 4), np.int32), DIRT_FRAME)


def test_supersampling_is_one_or_two() -> None:
    with pytest.raises(PictureError, match="supersampling of 1 or 2, got 3"):
        camera_of(FURNISHED, 3)


@pytest.mark.parametrize(
    "place", [(2.95, 0.0), (50.0, -70.0), (-3.0, -3.0), (1e9, 0.0), (1e300, -1e308)]
)
def test_from_inside_a_wall_or_off_the_map_a_wall_is_seen(place: tuple[float, float]) -> None:
    depth = furnished_camera().depth(Pose(*place, 0.3), 0.0)
    assert (depth < 0.01).all()


def test_unknown_cells_are_walls() -> None:
    home = home_with()
    values = home.map.values.copy()
    values[:, 80:] = UNKNOWN
    open_air = np.zeros(FRAME.shape, np.bool_)
    unknown = replace(home, map=OccupancyMap(FRAME, values), walls=open_air, rooms=())
    depth = camera_of(unknown).depth(Pose(), 0.0)
    assert depth[50, 80] == pytest.approx(1.0 - CONFIG.mount_forward, abs=1e-3)


def test_a_bare_map_is_seen() -> None:
    bare = replace(home_with(), rooms=())
    picture = camera_of(bare).picture(Pose(), 0.0, CLEAN, DIRT_FRAME)
    wall, floor = picture[30:50].mean((0, 1)), picture[90:].mean((0, 1))
    assert np.abs(wall - floor).max() > 10


def test_a_carpet_lies_on_the_floor() -> None:
    home = replace(
        home_with(), carpets=(Carpet("c", Rectangle(0.2, -0.5, 1.5, 0.5), "carpet_red"),)
    )
    seen = redness(camera_of(home).picture(Pose(), 0.0, CLEAN, DIRT_FRAME))
    assert seen[70:, 60:100].mean() > 0.8
    assert seen[:60].sum() == 0


def test_the_light_of_a_station_is_green_in_the_dark_block() -> None:
    home = home_with(
        Box(0.6, 0.0, 0.0, 0.1, 0.26, 0.0, 0.1, "station"),
        Box(0.55, 0.0, 0.0, 0.004, 0.06, 0.075, 0.085, "station_light"),
    )
    picture = camera_of(home).picture(Pose(), 0.0, CLEAN, DIRT_FRAME).astype(int)
    red, green, blue = np.moveaxis(picture, -1, 0)
    lamp = (green > 180) & (green > red + 60) & (green > blue + 30)
    assert lamp.sum() > 3
    assert picture[63, 80].max() < 100


@pytest.mark.parametrize("name", sorted(MATERIALS))
def test_every_material_has_its_colour(name: str) -> None:
    camera = camera_of(home_with(Box(0.9, 0.0, 0.0, 0.3, 3.0, 0.0, 2.4, name)))
    seen = camera.picture(Pose(), 0.0, CLEAN, DIRT_FRAME)[10:50].mean((0, 1))
    expected = np.array(MATERIALS[name].rgb)
    assert np.abs(seen - expected).max() < 60
