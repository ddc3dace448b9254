"""Scans that no planar lidar in m and rad makes are recognized; single failed beams are not."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from roomba.perception.matching.plausible import FARTHEST_ECHO, scan_fault

STEP = math.pi / 180.0


def scan(length: float = 2.0, beams: int = 180) -> NDArray[np.float32]:
    return np.full(beams, length, np.float32)


@given(
    st.lists(st.floats(0.0, 30.0, width=32) | st.sampled_from((math.nan, math.inf)), min_size=2),
    st.floats(-math.pi, math.pi),
    st.floats(1e-3, 5e-3) | st.floats(-5e-3, -1e-3),
)
def test_nothing_is_wrong_with_a_scan_in_metres(
    ranges: list[float], first: float, step: float
) -> None:
    assert scan_fault(np.array(ranges, np.float32), first, step, 0.1, 40.0) == ""


@pytest.mark.parametrize("beams", [1, 360, 720])
def test_one_beam_or_two_turns_are_a_scan(beams: int) -> None:
    assert scan_fault(scan(beams=beams), 0.0, STEP if beams > 1 else 0.0, 0.0, math.inf) == ""


@pytest.mark.parametrize(
    ("first", "step", "beams", "said"),
    [
        (math.nan, STEP, 180, "expected finite angles, got beams from nan"),
        (0.0, math.inf, 180, "expected finite angles"),
        (0.0, STEP, 0, "each at another angle, got 0"),
        (0.0, 0.0, 2, "each at another angle, got 2"),
        (-90.0, 1.0, 181, "are the angles in degrees"),
        (-90.0, -1.0, 181, "are the angles in degrees"),
    ],
)
def test_angles_that_are_none_are_told(first: float, step: float, beams: int, said: str) -> None:
    assert said in scan_fault(scan(beams=beams), first, step, 0.1, 8.0)


@pytest.mark.parametrize(
    ("nearest", "farthest"), [(0.1, math.nan), (-0.1, 8.0), (8.0, 0.1), (math.nan, 8.0)]
)
def test_limits_that_leave_no_range_are_told(nearest: float, farthest: float) -> None:
    assert "up to a larger one" in scan_fault(scan(), 0.0, STEP, nearest, farthest)


def in_millimetres(beams: int = 180) -> NDArray[np.float32]:
    return np.linspace(1500.0, 2500.0, beams, dtype=np.float32)


@pytest.mark.parametrize("farthest", [8.0, 8000.0, math.inf])
def test_ranges_in_millimetres_are_told(farthest: float) -> None:
    """Also those of a driver that tells how far they count in m."""
    fault = scan_fault(in_millimetres(), 0.0, STEP, 0.1, farthest)
    assert "got 180 of 180 that are farther, 2000 m in the middle: are they in mm?" in fault


def test_zeros_that_mean_no_echo_are_no_ranges() -> None:
    ranges = in_millimetres()
    ranges[20:] = 0.0
    assert "got 20 of 20 that are farther" in scan_fault(ranges, 0.0, STEP, 0.0, 8000.0)


def test_some_beams_that_tell_what_cannot_be_are_no_fault_of_the_scan() -> None:
    ranges = scan()
    ranges[::3] = 2.0 * FARTHEST_ECHO
    assert scan_fault(ranges, 0.0, STEP, 0.1, 1e9) == ""


@pytest.mark.parametrize("farthest", [80.0, math.inf])
def test_a_number_for_no_echo_is_no_range_in_millimetres(farthest: float) -> None:
    ranges = scan(1000.0)
    ranges[:3] = 2.0
    assert scan_fault(ranges, 0.0, STEP, 0.1, farthest) == ""
