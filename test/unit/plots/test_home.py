"""Plan pictures: the right size, everything at its place, and the same picture every time."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.plots.home import draw_floor_plan
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home


@pytest.fixture(scope="module")
def studio() -> Home:
    return load_home("studio", HOMES)


def differing(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.intp]:
    return np.argwhere((one != other).any(axis=2))


def test_a_plan_is_an_rgb_picture_at_the_wanted_scale(studio: Home) -> None:
    picture = draw_floor_plan(studio, pixels_per_metre=40.0)
    assert picture.dtype == np.uint8
    rows, columns, channels = picture.shape
    assert channels == 3
    assert columns == pytest.approx(40.0 * 6.4 * 1.06, abs=2)
    assert rows == pytest.approx(40.0 * (5.6 + 3 * 0.03 * 6.4), abs=2)
    assert np.array_equal(picture, draw_floor_plan(studio, pixels_per_metre=40.0))


def test_walls_are_dark_and_floor_and_paper_are_light(studio: Home) -> None:
    picture = draw_floor_plan(studio, pixels_per_metre=40.0, labels=False).astype(int).sum(axis=2)
    margin = 0.03 * 6.4

    def at(x: float, y: float) -> int:
        return int(picture[round((3.8 + margin - y) * 40.0), round((x + 0.5 + margin) * 40.0)])

    assert at(2.0, -1.7) < 300
    assert at(3.0, 1.0) > 400
    assert at(-0.6, 0.0) > 700


def test_path_dirt_and_robot_are_drawn_where_they_are(studio: Home) -> None:
    bare = draw_floor_plan(studio, pixels_per_metre=40.0, robot=Pose(1.0, 1.0, 0.0))
    walked = draw_floor_plan(
        studio, pixels_per_metre=40.0, robot=Pose(1.0, 1.0, 0.0), path=[(3.0, 1.0), (4.0, 1.0)]
    )
    marks = differing(bare, walked)
    left = 40.0 * (3.0 + 0.5 + 0.192)
    assert marks[:, 1].min() == pytest.approx(left, abs=6)
    assert marks[:, 1].max() == pytest.approx(left + 40.0, abs=6)
    level = 40.0 * (3.8 + 0.192 - 1.0)
    assert marks[:, 0].mean() == pytest.approx(level, abs=4)
    dirt = np.zeros(studio.frame.shape)
    row, column = studio.frame.cell_of(3.0, 1.0)
    dirt[row - 2 : row + 3, column - 2 : column + 3] = 5.0
    dirty = draw_floor_plan(studio, pixels_per_metre=40.0, robot=Pose(1.0, 1.0, 0.0), dirt=dirt)
    spots = differing(bare, dirty)
    assert spots[:, 1].mean() == pytest.approx(left, abs=4)
    assert spots[:, 0].mean() == pytest.approx(level, abs=4)
    assert np.ptp(spots[:, 1]) < 24


def test_of_a_path_the_robot_stands_at_the_end(studio: Home) -> None:
    path = [(3.0, 1.0), (3.0, 0.8)]
    at_end = draw_floor_plan(studio, pixels_per_metre=40.0, path=path)
    told = draw_floor_plan(
        studio, pixels_per_metre=40.0, path=path, robot=Pose(3.0, 0.8, -np.pi / 2.0)
    )
    assert np.array_equal(at_end, told)


@pytest.mark.parametrize("name", ["apartment", "hall"])
def test_homes_without_furniture_or_of_any_size_are_drawn(name: str) -> None:
    picture = draw_floor_plan(load_home(name, HOMES), pixels_per_metre=3.0)
    assert picture.std() > 3.0


def test_wrong_shapes_and_scales_are_refused(studio: Home) -> None:
    with pytest.raises(ValueError, match="shape"):
        draw_floor_plan(studio, dirt=np.zeros((2, 2)))
    with pytest.raises(ValueError, match="pixels per metre"):
        draw_floor_plan(studio, pixels_per_metre=0.0)
