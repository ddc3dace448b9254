"""The noise of ranges is measured, of any lidar and in any surroundings."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.perception.matching.range_noise import measure_noise, unknown_noise

NEAREST, FARTHEST = 0.1, 30.0


def walls(angles: NDArray[np.float64], half: float = 2.0) -> NDArray[np.float64]:
    """Ranges to the walls of a square room from a place off its middle, m."""
    x, y = 0.3, -0.5
    with np.errstate(divide="ignore"):
        along = np.where(np.cos(angles) > 0, half - x, half + x) / np.abs(np.cos(angles))
        across = np.where(np.sin(angles) > 0, half - y, half + y) / np.abs(np.sin(angles))
    result: NDArray[np.float64] = np.minimum(along, across)
    return result


@pytest.mark.parametrize("deviation", [0.003, 0.01, 0.03])
@pytest.mark.parametrize(("beams", "fan"), [(180, np.pi), (360, 2 * np.pi), (682, 4.19)])
def test_it_finds_what_was_added(deviation: float, beams: int, fan: float) -> None:
    generator, noise = np.random.default_rng(1), unknown_noise()
    clean = walls(np.linspace(-fan / 2, fan / 2, beams))
    for _ in range(20):
        ranges = clean + generator.normal(0.0, deviation, beams)
        measure_noise(noise, ranges.astype(np.float32), NEAREST, FARTHEST)
    assert noise[0]["deviation"] == pytest.approx(deviation, rel=0.2)


def test_what_stands_around_hardly_changes_it() -> None:
    """A leg each 60 beams, and a tenth without echo in each of its spellings."""
    generator, noise = np.random.default_rng(2), unknown_noise()
    clean = walls(np.linspace(-np.pi, np.pi, 720))
    for _ in range(20):
        ranges = clean + generator.normal(0.0, 0.01, 720)
        ranges[::60] *= 0.5
        for value in (0.0, np.inf, np.nan, 81.83):
            ranges[generator.integers(0, 720, 18)] = value
        measure_noise(noise, ranges.astype(np.float32), NEAREST, FARTHEST)
    assert noise[0]["deviation"] == pytest.approx(0.01, rel=0.3)


@pytest.mark.parametrize("share", [0.12, 0.15, 0.2, 0.25])
def test_single_wrong_ranges_are_not_taken_for_noise(share: float) -> None:
    """Each spoils five differences: of these most are wrong then."""
    generator, noise = np.random.default_rng(4), unknown_noise()
    clean = walls(np.linspace(-np.pi, np.pi, 720))
    for _ in range(20):
        ranges = clean + generator.normal(0.0, 0.005, 720)
        is_wrong = generator.random(720) < share
        ranges[is_wrong] = generator.uniform(0.2, 6.0, np.count_nonzero(is_wrong))
        measure_noise(noise, ranges.astype(np.float32), NEAREST, FARTHEST)
    assert 0.004 < noise[0]["deviation"] < 0.03


def test_neighbours_count_only_where_all_five_met_something() -> None:
    """Each fifth beam has no echo: no five in a row have one."""
    noise, ranges = unknown_noise(), np.full(720, 2.0, np.float32)
    ranges[::5] = np.inf
    measure_noise(noise, ranges, NEAREST, FARTHEST)
    assert noise[0]["total"] == 0
    ranges[::5] = 2.0
    measure_noise(noise, ranges, NEAREST, FARTHEST)
    assert noise[0]["total"] == noise[0]["counts"].sum() == 716


def test_before_enough_was_seen_it_is_that_of_a_usual_lidar() -> None:
    noise = unknown_noise()
    measure_noise(noise, np.full(100, 2.0, np.float32), NEAREST, FARTHEST)
    assert noise[0]["deviation"] == 0.005


def test_a_lidar_that_becomes_worse_is_noticed() -> None:
    generator, noise = np.random.default_rng(3), unknown_noise()
    clean = walls(np.linspace(-np.pi, np.pi, 720))
    for deviation in (0.002, 0.02):
        for _ in range(600):
            ranges = clean + generator.normal(0.0, deviation, 720)
            measure_noise(noise, ranges.astype(np.float32), NEAREST, FARTHEST)
    assert noise[0]["deviation"] == pytest.approx(0.02, rel=0.3)
