"""Dirt in the camera's pictures: how much of it shows, and where."""

from __future__ import annotations

import numpy as np
from fixtures.homes.camera_rooms import CLEAN, DIRT_FRAME, camera_of, even_dirt, home_with

from roomba.configuration.sensors import CameraConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.world.camera.camera import Camera, Scene


def specks(grams: float) -> int:
    """How many pixels of the near floor are much darker than the clean floor."""
    camera = Camera(Scene.of(home_with()), CameraConfig(width=640, height=480))
    clean, dirty = (
        camera.picture(Pose(), 0.0, dirt, DIRT_FRAME)[300:].astype(int)
        for dirt in (CLEAN, even_dirt(grams))
    )
    return int(((clean - dirty).mean(axis=-1) > 15).sum())


def test_more_dirt_shows_as_more_specks() -> None:
    faint, clear, heavy = specks(0.1), specks(1.0), specks(10.0)
    assert 0 < faint < 0.5 * clear < 0.25 * heavy


def test_dirt_is_seen_where_it_lies() -> None:
    dirt = CLEAN.copy()
    dirt[:, 30:][30:] = even_dirt(10.0)[30:, 30:]
    camera = camera_of(home_with())
    clean = camera.picture(Pose(), 0.0, CLEAN, DIRT_FRAME)
    changed = (camera.picture(Pose(), 0.0, dirt, DIRT_FRAME) != clean).any(axis=-1)
    assert changed[70:, :75].mean() > 0.5
    assert changed[:, 140:].sum() == 0
    assert changed[:60].sum() == 0


def test_dirt_looks_the_same_on_finer_cells() -> None:
    fine_frame = GridFrame(0.05, -3.0, -3.0, 120, 120)
    fine = np.full(fine_frame.shape, 2500, np.int32)
    camera = camera_of(home_with())
    pictures = [
        camera.picture(Pose(), 0.0, even_dirt(1.0), DIRT_FRAME),
        camera.picture(Pose(), 0.0, fine, fine_frame),
    ]
    assert np.array_equal(pictures[0], pictures[1])


def test_specks_stay_where_they_lie_when_more_dirt_falls() -> None:
    camera = Camera(Scene.of(home_with()), CameraConfig(width=640, height=480), 1)
    clean, little, more = (
        camera.picture(Pose(), 0.0, even_dirt(grams), DIRT_FRAME)[360:].astype(int).mean(axis=-1)
        for grams in (0.0, 0.3, 0.4)
    )
    crumbs = np.abs(clean - little) > 12
    assert crumbs.sum() > 5
    assert (np.abs(clean - more)[crumbs] > 6).mean() > 0.9
