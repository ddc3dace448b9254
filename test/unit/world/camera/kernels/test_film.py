"""Last steps of a picture in compiled kernels, against numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from roomba.world.camera.kernels import film
from roomba.world.camera.scene.arrays import STRIP

kernel: Any = njit
RANDOM = np.random.default_rng(2)


@kernel
def turned(columns: Any, last: int, rows: Any, begin: int) -> None:
    film.turn(columns, last, rows, begin)


def test_columns_are_turned_into_rows_and_no_more_is_written() -> None:
    columns = RANDOM.random((STRIP, 30)).astype(np.float32)
    rows = np.zeros((30, STRIP + 9), np.float32)
    turned(columns, 21, rows, 5)
    assert np.array_equal(rows[:21, 5 : 5 + STRIP], columns[:, :21].T)
    rows[:21, 5 : 5 + STRIP] = 0.0
    assert not rows.any()


@kernel
def written(colours: Any, pixels: Any) -> None:
    film.write_pixels(colours, pixels)


def test_pixels_are_three_bytes_and_no_more_is_written() -> None:
    channels = RANDOM.integers(0, 256, (STRIP, 3)).astype(np.uint32)
    pixels = np.full((STRIP + 1, 3), 9, np.uint8)
    written(channels @ np.array([1, 1 << 8, 1 << 16], np.uint32), pixels.reshape(-1))
    assert np.array_equal(pixels[:-1], channels)
    assert (pixels[-1] == 9).all()
