"""Steps of a row of floor in compiled kernels, against numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from roomba.configuration.sensors import CameraConfig
from roomba.world.camera.kernels import floor_row
from roomba.world.camera.kernels.floor_row import OF_DIRT, OF_DUST, OF_LIGHT
from roomba.world.camera.scene.arrays import GREYS, SHADES, STRIP, TILE, Ray, StripRow
from roomba.world.camera.view import view_tables, workspace

kernel: Any = njit
RANDOM = np.random.default_rng(5)
VIEW = view_tables(CameraConfig(width=2 * STRIP, height=48), 1)


def row_of_floor() -> StripRow:
    return workspace(VIEW, 0).row


@kernel
def found_ways(view: Any, axis: Ray, begin: int, row: Any) -> None:
    floor_row.find_ways(view, axis, begin, row)


@pytest.mark.parametrize("begin", [0, STRIP])
def test_columns_look_from_left_to_right_around_the_middle(begin: int) -> None:
    row = row_of_floor()
    found_ways(VIEW, Ray(0.0, 0.0, np.cos(0.3), np.sin(0.3)), begin, row)
    aside = (VIEW.middle - (begin + np.arange(STRIP) + 0.5)) / VIEW.focal
    turned = np.exp(0.3j) * (1.0 + 1j * aside)
    assert row.way_x == pytest.approx(turned.real, rel=1e-5)
    assert row.way_y == pytest.approx(turned.imag, rel=1e-5, abs=1e-6)


@kernel
def felt(knots: Any, k: int, part: np.float32, shaded: Any, row: Any) -> float:
    floor_row.feel_dirt(knots, k, part, row.level)
    return float(floor_row.feel_light_and_dust(knots, k, part, shaded, row))


def test_light_dirt_and_dust_are_even_between_the_knots() -> None:
    edges = np.arange(0, STRIP + 1, TILE)
    knots = RANDOM.uniform(0.0, 120.0, (len(edges), 3, 3)).astype(np.float32)
    shaded = RANDOM.integers(0, 1 << 24, 17 * SHADES).astype(np.uint32)
    row = row_of_floor()
    most_dirt = felt(knots, 1, np.float32(0.25), shaded, row)
    here = 0.75 * knots[:, 1] + 0.25 * knots[:, 2]
    middles = np.arange(STRIP) + 0.5
    for values, what in ((row.shade, OF_LIGHT), (row.level, OF_DIRT), (row.dust, OF_DUST)):
        assert np.abs(values + 0.5 - np.interp(middles, edges, here[:, what])).max() <= 0.501
    assert most_dirt == pytest.approx(here[:, OF_DIRT].max(), rel=1e-5)
    veils = shaded[16 * SHADES + here[:-1, OF_LIGHT].astype(int)]
    assert np.array_equal(row.veil, np.repeat(veils, TILE))


@kernel
def coloured(
    x: np.float32, y: np.float32, t: np.float32, texels: Any, shaded: Any, row: Any
) -> None:
    floor_row.find_texels(x, y, t, row)
    floor_row.look_up_colours(texels, shaded, row)


def test_texels_repeat_every_width_to_all_sides() -> None:
    row = row_of_floor()
    row.way_x[:], row.way_y[:] = RANDOM.uniform(-3.0, 3.0, (2, STRIP))
    row.scale[:] = RANDOM.choice([25.0, 50.0], STRIP)
    row.width[:] = RANDOM.choice([4, 8], STRIP)
    row.start[:], row.base[:] = 7, SHADES * GREYS
    row.shade[:] = RANDOM.integers(0, SHADES, STRIP)
    texels = RANDOM.integers(0, 256, 7 + 8 * 8).astype(np.uint8)
    shaded = RANDOM.integers(0, 1 << 24, 2 * SHADES * GREYS).astype(np.uint32)
    coloured(np.float32(0.5), np.float32(-0.25), np.float32(2.0), texels, shaded, row)
    column = np.floor((row.way_x * 2.0 + 0.5) * row.scale).astype(int) % row.width
    line = np.floor((row.way_y * 2.0 - 0.25) * row.scale).astype(int) % row.width
    place = row.start + line * row.width + column
    expected = shaded.reshape(2, SHADES, GREYS)[1, row.shade, texels[place] // 4]
    assert np.array_equal(row.place, place)
    assert np.array_equal(row.colour, expected)


@kernel
def covered(upright: Any, depths: Any, t: np.float32, row: Any) -> None:
    floor_row.cover_with_dust(row)
    floor_row.put_before(upright, depths, t, row.colour)


def channels(colours: NDArray[np.uint32]) -> NDArray[np.int64]:
    return np.asarray(colours[:, None].astype(np.int64) >> np.array([0, 8, 16]) & 255, np.int64)


def test_dust_covers_by_its_share_and_what_is_nearer_stands_before_it() -> None:
    row = row_of_floor()
    row.colour[:], row.veil[:] = RANDOM.integers(0, 1 << 24, (2, STRIP))
    row.dust[:] = RANDOM.integers(0, 257, STRIP)
    row.dust[:2] = 0, 256
    upright = RANDOM.integers(0, 1 << 24, STRIP).astype(np.uint32)
    depths = RANDOM.choice([1.0, 2.0, 3.0], STRIP).astype(np.float32)
    share = row.dust[:, None].astype(np.int64)
    dusty = (channels(row.colour) * (256 - share) + channels(row.veil) * share) >> 8
    covered(upright, depths, np.float32(2.0), row)
    nearer = depths[:, None] < 2.0
    assert np.array_equal(channels(row.colour), np.where(nearer, channels(upright), dusty))
