"""Bundles of a sweep's beams against complex numbers; whole sweeps have tests of their own."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from roomba.compilation import compiled
from roomba.world.engine.lidar import bundle_kernels
from roomba.world.engine.lidar.bundle_kernels import BEAMS, BUNDLE
from roomba.world.engine.state.arrays import Rows
from roomba.world.engine.state.random_kernels import hashed

INCREMENT, STEP, FIRST_ANGLE = 0.2 / 360, math.radians(1.0), 0.25
SWEEP, BEGIN, DT = 5.0, 5.01, 0.025
FIRST = 20
"""Number of a bundle's first beam: it is due 1 ms after the step began."""


@compiled()
def aimed(
    beams: Rows,
    numbers: Rows,
    times: tuple[float, float],
    first: int,
    start: tuple[float, float, float],
    way: tuple[float, float, float],
) -> None:
    bundle_kernels.aim(beams[0], times, DT, numbers[0], first, start, way)


@compiled()
def drawn(beams: Rows, key: np.uint32, first: int) -> None:
    bundle_kernels.draw(beams[0], key, first)


def numbers_with(rounding: float) -> Rows:
    """The numbers of a lidar whose angles are told no better than that, rad."""
    names = ("time_increment", "beam_step", "first_angle", "angle_rounding")
    numbers = np.zeros(1, np.dtype([(name, "f8") for name in names]))
    numbers[0] = INCREMENT, STEP, FIRST_ANGLE, rounding
    return numbers


@pytest.mark.parametrize(
    "way",
    [(0.01, -0.002, 0.08), (-0.005, 0.003, -0.03), (0.0, 0.0, 0.05), (0.01, 0.004, 0.0)],
)
def test_beams_are_measured_along_an_arc(way: tuple[float, float, float]) -> None:
    beams, (x, y, theta) = np.zeros(1, BEAMS), (1.5, -0.5, 2.8)
    aimed(beams, numbers_with(0.0), (SWEEP, BEGIN), FIRST, (x, y, theta), way)
    chord, turn = complex(way[0], way[1]), way[2]
    for number in range(BUNDLE):
        share = (SWEEP + (FIRST + number) * INCREMENT - BEGIN) / DT
        assert 0.0 < share < 1.0
        part = complex(share)
        if turn != 0.0:
            part = (cmath.exp(1j * share * turn) - 1.0) / (cmath.exp(1j * turn) - 1.0)
        place = complex(x, y) + part * chord
        angle = theta + share * turn + FIRST_ANGLE + (FIRST + number) * STEP
        assert complex(beams["x"][0, number], beams["y"][0, number]) == pytest.approx(place)
        assert beams["angle"][0, number] == pytest.approx(angle)
        direction = complex(beams["cosine"][0, number], beams["sine"][0, number])
        assert direction == pytest.approx(cmath.exp(1j * angle))


def test_before_and_after_the_step_the_lidar_stands_at_its_ends() -> None:
    beams = np.zeros(1, BEAMS)
    for first, expected in ((0, (1.0, 2.0)), (200, (1.01, 1.98))):
        aimed(beams, numbers_with(0.0), (SWEEP, BEGIN), first, (1.0, 2.0, 0.0), (0.01, -0.02, 0.1))
        assert beams["x"][0] == pytest.approx(np.full(BUNDLE, expected[0]))
        assert beams["y"][0] == pytest.approx(np.full(BUNDLE, expected[1]))


def test_chance_moves_an_angle_by_half_its_rounding_at_most() -> None:
    exact, rounded = np.zeros(1, BEAMS), np.zeros(1, BEAMS)
    off = []
    for sweep in range(200):
        for beams, rounding in ((exact, 0.0), (rounded, 0.01)):
            drawn(beams, np.uint32(sweep), FIRST)
            aimed(beams, numbers_with(rounding), (SWEEP, BEGIN), FIRST, (0.0,) * 3, (0.0,) * 3)
        off.extend((rounded["angle"] - exact["angle"])[0].tolist())
    assert np.abs(off).max() <= 0.005
    assert np.std(off) == pytest.approx(0.01 / math.sqrt(12.0), rel=0.05)


def test_the_bits_of_a_beam_are_its_own_in_any_bundle() -> None:
    one, other = np.zeros(1, BEAMS), np.zeros(1, BEAMS)
    drawn(one, np.uint32(77), 0)
    drawn(other, np.uint32(77), 5)
    for name in ("first", "second", "third"):
        assert one[name][0, 5:].tolist() == other[name][0, : BUNDLE - 5].tolist()
        assert len(set(one[name][0].tolist())) == BUNDLE
    with np.errstate(over="ignore"):
        expected = hashed(np.uint32(np.uint32(77) + np.uint32(3) * np.uint32(0x9E3779B9)))
    assert one["first"][0, 3] == expected
