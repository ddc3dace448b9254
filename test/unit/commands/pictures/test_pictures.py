"""The pictures of the documents: each can be made, shows something, and is the same every time."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from fixtures.thoroughness import core_first
from numpy.typing import NDArray

from roomba.commands.pictures.__main__ import PICTURES, main
from roomba.configuration.sensors import CameraConfig
from roomba.files.shipped import HOMES
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

SMALL_CAMERA = CameraConfig(width=64, height=48)
QUICK: dict[str, dict[str, Any]] = {
    "lidar": {"scans": 2},
    "odometry": {"seconds": 5.0},
    "bumper": {"posts": 8},
    "edge": {"seconds": 1.0},
    "station": {"spacing": 0.1},
    "dirt": {"way": 1.0},
    "battery": {"most_hours": 0.05},
    "levels": {"points": 5},
    "moving": {"minutes": 0.5},
    "depth": {"config": SMALL_CAMERA},
    "kitchen": {"config": SMALL_CAMERA},
    "localization": {"minutes": 0.1},
}
"""Arguments with which a picture is made in less time than for the documents."""
SLOW = {"cleaning", "map_errors", "mapping", "walk", "living_room", "bedroom", "bathroom"}
"""Not made here: walks, views, cleans and maps have tests of their own."""
PLOTS = sorted(set(PICTURES) - SLOW - {"bay", "home", "kitchen"})


@pytest.fixture(autouse=True)
def _coarse_plans(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roomba.plots.style.PLAN_PIXELS", 60.0)


@lru_cache
def home_of(name: str) -> Home:
    return load_home(PICTURES[name][0], HOMES)


def made(name: str) -> NDArray[np.uint8]:
    picture_of: Callable[[Home], NDArray[np.uint8]] = PICTURES[name][1]
    return partial(picture_of, **QUICK.get(name, {}))(home_of(name))


@pytest.mark.parametrize("name", core_first(PLOTS, {"floor_plan", "layers", "levels"}))
def test_a_plot_is_a_picture_of_a_page_s_width_with_something_in_it(name: str) -> None:
    picture = made(name)
    height, width, channels = picture.shape
    assert picture.dtype == np.uint8
    assert channels == 3
    assert 800 <= width <= 1200
    assert 300 <= height <= 1000
    paper = (picture == 255).all(axis=2)
    assert 0.2 < paper.mean() < 0.98 or name in {"depth", "floor_plan"}
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50


def test_views_of_the_readme_are_of_the_camera_s_size() -> None:
    assert made("kitchen").shape == (48, 64, 3)


def test_a_plot_is_the_same_every_time_whatever_the_user_s_style() -> None:
    import matplotlib as mpl

    first = made("levels")
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "black"}):
        assert np.array_equal(first, made("levels"))


def test_the_command_writes_what_it_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(tmp_path / "new"), "--only", "levels"]) == 0
    written = tmp_path / "new" / "levels.png"
    assert list((tmp_path / "new").iterdir()) == [written]
    assert capsys.readouterr().out.split() == [str(written)]
    # OpenCV's order of the colours is the other way round.
    assert np.array_equal(
        cv2.imread(str(written))[:, :, ::-1], PICTURES["levels"][1](home_of("levels"))
    )


def test_a_folder_that_cannot_be_made_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main([str(tmp_path / "file"), "--only", "levels"]) == 1
    assert "./roomba pictures: " in capsys.readouterr().err
