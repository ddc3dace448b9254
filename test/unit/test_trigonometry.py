"""Sine, cosine and arc tangent against those of the C library."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.compilation import compiled
from roomba.trigonometry import direction_of, sine_cosine

Floats = NDArray[np.float64]
CLOSE = 3e-16
"""Two steps of a number near 1."""


@compiled()
def sines_and_cosines(angles: Floats, found: Floats) -> None:
    for index in range(angles.size):
        found[index, 0], found[index, 1] = sine_cosine(angles[index])


@compiled()
def directions(y: Floats, x: Floats, found: Floats) -> None:
    for index in range(y.size):
        found[index] = direction_of(y[index], x[index])


@pytest.mark.parametrize("most", [1e-6, 0.4, 4.0, 40.0, 6000.0])
def test_sine_and_cosine_are_those_of_the_library(most: float) -> None:
    angles = np.random.default_rng(1).uniform(-most, most, 20000)
    found = np.empty((angles.size, 2))
    sines_and_cosines(angles, found)
    assert found == pytest.approx(np.stack([np.sin(angles), np.cos(angles)], 1), abs=CLOSE, rel=0)


def test_small_angles_keep_their_digits() -> None:
    for angle in (1e-300, -1e-12, 1e-5):
        sine, cosine = sine_cosine(angle)
        assert sine == pytest.approx(math.sin(angle), rel=CLOSE)
        assert cosine == math.cos(angle)


@pytest.mark.parametrize("eighth", range(-9, 10))
def test_at_eighths_of_a_turn_they_are_the_same(eighth: int) -> None:
    for nudge in (-1e-9, 0.0, 1e-9):
        angle = eighth * math.pi / 4.0 + nudge
        assert sine_cosine(angle) == pytest.approx(
            (math.sin(angle), math.cos(angle)), abs=CLOSE, rel=0
        )


def test_directions_are_those_of_the_library() -> None:
    random = np.random.default_rng(2)
    y, x = random.normal(size=(2, 20000)) * np.exp(random.uniform(-9.0, 9.0, (2, 20000)))
    found = np.empty(y.size)
    directions(y, x, found)
    assert found == pytest.approx(np.arctan2(y, x), rel=3e-16, abs=CLOSE)


@pytest.mark.parametrize("y", [-2.0, -1.0, 0.0, 1.0, 2.0])
@pytest.mark.parametrize("x", [-2.0, -1.0, 0.0, 1.0, 2.0])
def test_along_axes_and_diagonals_too(y: float, x: float) -> None:
    assert direction_of(y, x) == pytest.approx(math.atan2(y, x), abs=5e-16, rel=0)
