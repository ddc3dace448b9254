"""The noise of ranges by how far they are, and ranges that lie between two things."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from roomba.perception.things.range_kernels import (
    is_mixed,
    measure_noises,
    noise_at,
    unknown_noises,
)

STEP = math.radians(1.0)


def wall(distance: float, aslant: float, beams: int = 21) -> NDArray[np.float32]:
    """Ranges to a straight wall met so far from square, rad, by the middle beam."""
    angles = STEP * (np.arange(beams) - beams // 2)
    lengths: NDArray[np.float64] = distance * math.cos(aslant) / np.cos(angles + aslant)
    return lengths.astype(np.float32)


def mixed(ranges: NDArray[np.float32], slack: float = 0.015) -> list[int]:
    inner = [beam for beam in range(2, ranges.size - 2) if math.isfinite(ranges[beam])]
    return [beam for beam in inner if is_mixed(ranges, beam, STEP, 360, slack)]


def test_noise_is_measured_where_ranges_are_as_long() -> None:
    """It grows with the square of the range, as where distance is told by an angle."""
    random, noises = np.random.default_rng(1), unknown_noises(4.0)
    assert len(noises) == 8
    for scan in range(1, 400):
        clean = np.concatenate([wall(0.4 + 0.5 * number, 0.0, 45) for number in range(8)])
        deviation = 0.002 + 0.002 * clean**2
        ranges = clean + random.normal(0.0, deviation)
        measure_noises(noises, scan, ranges.astype(np.float32), 0.1)
    for away in (0.4, 0.9, 1.9, 2.9):
        assert noise_at(noises, away) == pytest.approx(0.002 + 0.002 * away**2, rel=0.35)
    assert noise_at(noises, 9.0) == noise_at(noises, 3.9)


def test_ranges_that_were_not_met_are_as_noisy_as_the_next_longer_ones() -> None:
    """And where no longer ones were met, as those of the worst lidars."""
    random, noises = np.random.default_rng(1), unknown_noises(4.0)
    assert (noises["deviation"] == 0.02).all()
    for scan in range(1, 200):
        ranges = wall(1.2, 0.0, 41) + random.normal(0.0, 0.006, 41)
        measure_noises(noises, scan, ranges.astype(np.float32), 0.1)
    assert noise_at(noises, 1.2) == pytest.approx(0.006, rel=0.3)
    assert noise_at(noises, 0.3) == noise_at(noises, 0.8) == noise_at(noises, 1.2)
    assert noise_at(noises, 2.2) == 0.02


def test_noise_is_measured_in_some_of_the_scans() -> None:
    noises, ranges = unknown_noises(1.0), wall(0.7, 0.0)
    for scan in (1, 2, 3, 4):
        measure_noises(noises, scan, ranges, 0.1)
        assert noises["total"].sum() == 0
    measure_noises(noises, 5, ranges, 0.1)
    assert noises["total"].sum() > 0


@pytest.mark.parametrize("aslant", [0.0, 30.0, 60.0, 75.0])
@pytest.mark.parametrize("distance", [0.5, 2.0, 3.5])
def test_along_a_wall_no_range_is_mixed(distance: float, aslant: float) -> None:
    random = np.random.default_rng(2)
    ranges = wall(distance, math.radians(aslant))
    for _ in range(20):
        noisy = ranges + random.normal(0.0, 0.004, ranges.shape).astype(np.float32)
        assert mixed(noisy) == []


def test_one_between_an_edge_and_what_is_behind_is() -> None:
    ranges = np.concatenate((wall(1.0, 0.0), wall(3.0, 0.4)))
    assert mixed(ranges) == []
    for share in (0.2, 0.5, 0.8):
        between = ranges.copy()
        between[21] = ranges[20] + share * (ranges[22] - ranges[20])
        assert mixed(between) == [21]
        assert mixed(between[::-1].copy()) == [20]


def test_two_side_by_side_are_and_those_before_what_sends_nothing_back() -> None:
    ranges = np.concatenate((wall(1.0, 0.0), wall(3.0, 0.4)))
    ranges[21], ranges[22] = 1.7, 2.2
    assert mixed(ranges) == [21, 22]
    ranges[22:] = np.inf
    assert mixed(ranges) == [21]


def test_a_thin_leg_and_a_corner_are_none() -> None:
    ranges = wall(3.0, 0.2)
    for width in (1, 2, 3):
        leg = ranges.copy()
        leg[8 : 8 + width] = 1.2
        assert mixed(leg) == []
    corner = np.minimum(wall(2.0, 0.8), wall(2.1, -0.6))
    assert mixed(corner) == []


def test_a_lidar_that_sees_ahead_alone_has_a_first_and_a_last_beam() -> None:
    ranges = wall(2.0, 0.3)
    ranges[0] = ranges[-1] = 1.0
    assert not is_mixed(ranges, 0, STEP, 360, 0.015)
    assert not is_mixed(ranges, 20, STEP, 360, 0.015)
