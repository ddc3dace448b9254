"""All forms of the angle wrap return the same bits, those of IEEE's remainder."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numba import njit

from roomba.angles import wrap_angles, wrapped
from roomba.geometry import TWO_PI, wrap_angle

angles = st.one_of(st.floats(-20.0, 20.0), st.floats(-1e300, 1e300))


def caller(angle: float) -> float:
    return wrapped(angle)


wrapped_in_a_kernel: Callable[[float], float] = njit()(caller)


def by_remainder(angle: float) -> float:
    rest = math.remainder(angle, TWO_PI)
    return math.pi if rest == -math.pi else rest


@given(angles)
@example(math.pi)
@example(-math.pi)
@example(math.nextafter(math.pi, 4.0))
@example(math.nextafter(-math.pi, -4.0))
@example(TWO_PI)
@example(-TWO_PI)
@example(3.0 * math.pi)
@example(-3.0 * math.pi)
def test_numbers_arrays_and_kernels_are_wrapped_to_the_same_bits(angle: float) -> None:
    expected = by_remainder(angle)
    assert wrap_angle(angle) == expected
    assert wrapped(angle) == expected
    assert wrapped_in_a_kernel(angle) == expected
    assert wrap_angles(np.array([[angle]])).tolist() == [[expected]]


@pytest.mark.filterwarnings("ignore:invalid value")
@pytest.mark.parametrize("angle", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_no_direction(angle: float) -> None:
    assert math.isnan(wrap_angle(angle))
    assert math.isnan(wrapped_in_a_kernel(angle))
    assert np.isnan(wrap_angles(np.array([angle]))).all()
