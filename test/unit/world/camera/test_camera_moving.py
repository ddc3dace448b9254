"""What moves before the camera: things, doors' leaves and round bodies, at their right depth."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from fixtures.homes.camera_rooms import CLEAN, CONFIG, DIRT_FRAME, camera_of, home_with, redness
from numpy.typing import NDArray

from roomba.errors import PictureError
from roomba.geometry import Pose
from roomba.world.camera.camera import Camera, Scene
from roomba.world.engine.state.arrays import MOST_DISCS
from roomba.world.home.home import Box, Door, Home, MovingKind, MovingThing, Rectangle, Script

BLOCK = Box(0.1, 0.0, 0.0, 0.4, 0.6, 0.0, 1.0, "red")
"""Its near face is 0.1 m behind its thing's place, its far one 0.3 m before it."""
AHEAD = Pose(1.5, 0.0, 0.0)
LENS = CONFIG.mount_forward
ROW, MIDDLE = 50, 80


@cache
def empty_depth() -> NDArray[np.float32]:
    """Of an empty room; made by the process that needs it."""
    return camera_of(home_with()).depth(Pose(), 0.0)


def home_of(*things: MovingThing) -> Home:
    return replace(home_with(), moving=things)


def thing(pose: Pose = AHEAD, *, is_present: bool = True, name: str = "block") -> MovingThing:
    return MovingThing(name, MovingKind.FURNITURE, (BLOCK,), pose, is_present, Script(()))


def at(*rows: tuple[float, float, float, float]) -> NDArray[np.float64]:
    return np.array(rows, np.float64).reshape(-1, 4)


def ahead(camera: Camera) -> float:
    return float(camera.depth(Pose(), 0.0)[ROW, MIDDLE])


@pytest.mark.parametrize("supersampling", [1, 2])
def test_a_thing_stands_at_first_where_it_is_said_to(supersampling: int) -> None:
    camera = camera_of(home_of(thing()), supersampling)
    picture = camera.render(Pose(), 0.0, CLEAN, DIRT_FRAME)
    assert picture.depth[ROW, MIDDLE] == pytest.approx(1.4 - LENS, abs=1e-4)
    assert redness(picture.colour)[ROW, MIDDLE]


def test_a_thing_that_is_not_present_at_first_is_not_seen_until_it_is_placed() -> None:
    camera = camera_of(home_of(thing(is_present=False)))
    assert np.array_equal(camera.depth(Pose(), 0.0), empty_depth())
    camera.place_things(at((1.5, 0.0, 0.0, 1.0)))
    assert ahead(camera) == pytest.approx(1.4 - LENS, abs=1e-4)


@pytest.mark.parametrize(
    ("pose", "distance"),
    [
        ((1.1, 0.0, 0.0), 1.0),
        ((1.1, 0.0, math.pi), 0.8),
        ((1.1, 0.0, math.pi / 2), 0.8),
        # Turned by a right angle its length of 0.1 - 0.2 to 0.1 + 0.2 lies along y.
        ((1.1, 0.25, -math.pi / 2), 0.8),
    ],
)
def test_a_thing_is_seen_where_it_was_placed(
    pose: tuple[float, float, float], distance: float
) -> None:
    camera = camera_of(home_of(thing()))
    camera.place_things(at((*pose, 1.0)))
    assert ahead(camera) == pytest.approx(distance - LENS, abs=1e-4)


@pytest.mark.parametrize("supersampling", [1, 2])
def test_a_thing_that_went_is_not_seen(supersampling: int) -> None:
    camera = camera_of(home_of(thing()), supersampling)
    camera.place_things(at((1.5, 0.0, 0.0, 0.0)))
    picture = camera.render(Pose(), 0.0, CLEAN, DIRT_FRAME)
    assert np.array_equal(picture.depth, empty_depth())
    assert not redness(picture.colour).any()


def test_each_thing_gets_its_own_pose() -> None:
    camera = camera_of(home_of(thing(name="one"), thing(name="two")))
    camera.place_things(at((1.5, 0.6, 0.0, 1.0), (2.0, -0.6, 0.0, 1.0)))
    depth = camera.depth(Pose(), 0.0)[ROW]
    assert depth[50] == pytest.approx(1.4 - LENS, abs=1e-4)
    assert depth[105] == pytest.approx(1.9 - LENS, abs=1e-4)


def test_one_camera_does_not_move_the_things_of_another() -> None:
    home = home_of(thing())
    scene = Scene.of(home)
    camera, other = Camera(scene, CONFIG), Camera(scene, CONFIG)
    camera.place_things(at((1.5, 0.0, 0.0, 0.0)))
    assert ahead(other) == pytest.approx(1.4 - LENS, abs=1e-4)
    assert np.array_equal(camera.depth(Pose(), 0.0), empty_depth())


@pytest.mark.parametrize(
    "poses",
    [at(), at((1.0, 0.0, 0.0, 1.0), (2.0, 0.0, 0.0, 1.0)), at((math.nan, 0.0, 0.0, 1.0))],
)
def test_poses_of_other_things_are_refused(poses: NDArray[np.float64]) -> None:
    camera = camera_of(home_of(thing()))
    with pytest.raises(PictureError, match="the 1 things that move"):
        camera.place_things(poses)


@pytest.mark.parametrize("is_shut", [True, False])
def test_a_leaf_that_moves_is_drawn_once_and_where_it_is(is_shut: bool) -> None:
    wall = Rectangle(1.0, -3.0, 1.1, 3.0)
    opening = Rectangle(1.0, -0.45, 1.1, 0.45)
    leaf = MovingThing(
        "door",
        MovingKind.DOOR,
        (Box(0.0, 0.0, 0.0, 0.1, 0.9, 0.0, 2.03, "door"),),
        Pose(1.05, 0.0, 0.0),
        is_shut,
        Script(()),
    )
    home = home_with(walls=(wall,), doors=(Door("door", opening, not is_shut),))
    camera = camera_of(replace(home, moving=(leaf,)))
    beyond = ahead(camera_of(home_with(walls=(wall,), doors=(Door("door", opening, True),))))
    shut = 1.0 - LENS
    assert ahead(camera) == pytest.approx(shut if is_shut else beyond, abs=1e-4)
    camera.place_things(at((1.05, 0.0, 0.0, not is_shut)))
    assert ahead(camera) == pytest.approx(beyond if is_shut else shut, abs=1e-4)


@pytest.mark.parametrize("aside", [0.0, 0.05, 0.12, 0.16])
def test_a_disc_is_round(aside: float) -> None:
    camera = camera_of(home_with())
    camera.place_discs(at((1.0, aside, 0.17, 0.12)))
    depth = camera.depth(Pose(), 0.0)
    row = round(CONFIG.height / 2)
    for column in range(60, 100):
        left = (CONFIG.width / 2 - column - 0.5) / camera.focal
        # The ray (t, left * t) from the lens meets the circle about (1 - LENS, aside) first here.
        along, square = (1.0 - LENS) + left * aside, 1.0 + left * left
        rest = along * along - square * ((1.0 - LENS) ** 2 + aside**2 - 0.17**2)
        if rest < 0.0:
            assert depth[row, column] == empty_depth()[row, column]
        else:
            expected = (along - math.sqrt(rest)) / square
            assert depth[row, column] == pytest.approx(expected, abs=1e-4)


def test_a_disc_is_as_high_as_it_is_said_to_be() -> None:
    camera = camera_of(home_with())
    camera.place_discs(at((1.0, 0.0, 0.17, 0.12)))
    seen = camera.depth(Pose(), 0.0)[:, MIDDLE] < empty_depth()[:, MIDDLE] - 0.01
    above = (CONFIG.height / 2 - 0.5 - np.arange(CONFIG.height)) / camera.focal
    heights = CONFIG.mount_height + above * (1.0 - 0.17 - LENS)
    assert seen[(heights > 0.005) & (heights < 0.115)].all()
    assert not seen[heights > 0.125].any()


def test_a_low_disc_is_seen_from_above() -> None:
    camera = camera_of(home_with())
    camera.place_discs(at((0.6, 0.0, 0.2, 0.05)))
    depth = camera.depth(Pose(), 0.0)
    row = 68
    expected = (CONFIG.mount_height - 0.05) * camera.focal / (row + 0.5 - 60.0)
    assert 0.4 - LENS < expected < 0.8 - LENS
    assert depth[row, MIDDLE] == pytest.approx(expected, abs=1e-4)


def test_discs_are_seen_until_others_are_placed() -> None:
    camera = camera_of(home_of(thing(Pose(1.5, 2.0, 0.0))))
    before = camera.depth(Pose(), 0.0)
    camera.place_discs(at((1.0, 0.0, 0.17, 0.12), (0.7, 0.0, 0.17, 0.12)))
    row = 60
    assert camera.depth(Pose(), 0.0)[row, MIDDLE] == pytest.approx(0.53 - LENS, abs=1e-3)
    camera.place_discs(at((1.0, 0.0, 0.17, 0.12)))
    assert camera.depth(Pose(), 0.0)[row, MIDDLE] == pytest.approx(0.83 - LENS, abs=1e-3)
    camera.place_discs(at())
    assert np.array_equal(camera.depth(Pose(), 0.0), before)


def test_a_disc_behind_a_wall_is_not_seen() -> None:
    camera = camera_of(home_with(walls=(Rectangle(0.8, -3.0, 1.0, 3.0),)))
    before = camera.depth(Pose(), 0.0)
    camera.place_discs(at((1.6, 0.0, 0.17, 0.12)))
    assert np.array_equal(camera.depth(Pose(), 0.0), before)


@pytest.mark.parametrize(
    "discs", [np.zeros((MOST_DISCS + 1, 4)), np.zeros((2, 3)), at((1.0, math.inf, 0.2, 0.1))]
)
def test_discs_that_cannot_be_shown_are_refused(discs: NDArray[np.float64]) -> None:
    with pytest.raises(PictureError, match=f"up to {MOST_DISCS} discs"):
        camera_of(home_with()).place_discs(discs)
