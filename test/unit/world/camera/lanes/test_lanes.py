"""Lanes in compiled kernels against numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from roomba.world.camera.lanes.lane_memory import load, look_up, store, store_pixels, turn
from roomba.world.camera.lanes.lanes import (
    LANES,
    any_of,
    as_real,
    cut,
    floored,
    steps,
    where,
    within,
)

kernel: Any = njit
REALS = np.linspace(-5.3, 60.2, LANES).astype(np.float32)
WHOLES = (np.arange(LANES) * 37 - 200).astype(np.int32)


@kernel
def calculated(reals: NDArray[np.float32], wholes: NDArray[np.int32]) -> None:
    real, whole = load(reals, 0), load(wholes, 0)
    store(reals, LANES, (real + 1.5) * real - 3.0 / (real - 0.25))
    store(wholes, LANES, (whole << 2) - (whole >> 1) | 5)
    store(wholes, 2 * LANES, floored(real) * steps() & 1023)
    store(wholes, 3 * LANES, cut(real - as_real(whole)))
    store(wholes, 4 * LANES, where((real > 2.0) & (whole <= 96), whole, 7))
    store(wholes, 5 * LANES, within(whole, -50, steps()))


def test_operators_do_the_same_in_all_lanes() -> None:
    reals = np.concatenate([REALS, np.zeros_like(REALS)])
    wholes = np.concatenate([WHOLES, np.zeros(5 * LANES, np.int32)])
    calculated(reals, wholes)
    found = wholes.reshape(6, LANES)
    assert reals[LANES:] == pytest.approx((REALS + 1.5) * REALS - 3.0 / (REALS - 0.25), rel=1e-5)
    assert np.array_equal(found[1], (WHOLES << 2) - (WHOLES >> 1) | 5)
    assert np.array_equal(found[2], np.floor(REALS).astype(int) * np.arange(LANES) & 1023)
    assert np.array_equal(found[3], np.trunc(REALS - WHOLES))
    assert np.array_equal(found[4], np.where((REALS > 2.0) & (WHOLES <= 96), WHOLES, 7))
    assert np.array_equal(found[5], np.maximum(np.minimum(WHOLES, np.arange(LANES)), -50))


@kernel
def is_any_below(reals: NDArray[np.float32], limit: float) -> bool:
    return bool(any_of(load(reals, 0) < limit))


@pytest.mark.parametrize(("limit", "expected"), [(-5.2, True), (-5.4, False)])
def test_one_lane_is_any(limit: float, expected: bool) -> None:
    assert is_any_below(REALS, limit) is expected


@kernel
def looked_up(table: NDArray[Any], places: NDArray[np.int32], found: NDArray[Any]) -> None:
    store(found, 0, look_up(table, load(places, 0)))


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.int32, np.float32])
def test_a_table_is_read_up_to_its_last_value(kind: Any) -> None:
    table = np.random.default_rng(1).integers(0, 250, 37).astype(kind)
    places = np.linspace(0, 36, LANES).astype(np.int32)
    found = np.zeros(LANES, np.float32 if kind is np.float32 else np.int32)
    looked_up(table, places, found)
    assert np.array_equal(found, table[places])


@kernel
def turned(source: NDArray[np.float32], target: NDArray[np.float32]) -> None:
    turn(source, 3, source.shape[1], target, 0, target.shape[1])


def test_a_square_is_turned() -> None:
    source = np.arange(LANES * 20, dtype=np.float32).reshape(LANES, 20)
    target = np.zeros((LANES, 30), np.float32)
    turned(source, target)
    assert np.array_equal(target[:, :LANES], source[:, 3 : 3 + LANES].T)
    assert not target[:, LANES:].any()


@kernel
def packed(colours: NDArray[np.uint32], pixels: NDArray[np.uint8]) -> None:
    store_pixels(pixels, 3, load(colours, 0))


def test_pixels_are_three_bytes_and_no_more_is_written() -> None:
    bytes_ = np.random.default_rng(2).integers(0, 256, (LANES, 3)).astype(np.uint32)
    pixels = np.full((LANES + 2, 3), 9, np.uint8)
    packed(bytes_[:, 0] | bytes_[:, 1] << 8 | bytes_[:, 2] << 16, pixels)
    assert np.array_equal(pixels[1:-1], bytes_)
    assert (pixels[[0, -1]] == 9).all()
