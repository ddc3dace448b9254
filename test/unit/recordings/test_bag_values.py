"""Messages of bags as values."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from roomba.perception.matching.mounts import FrameTransform, Mount, Mounts
from roomba.recordings.bag_values import LidarBook, decoded
from roomba.recordings.readings import Kind, Refused, Turning

_HALF = math.sqrt(0.5)


def turning(x: float, y: float, z: float, first_variance: float = 0.0) -> Any:
    """Return a message of a gyro."""
    return SimpleNamespace(
        header=SimpleNamespace(frame_id="imu"),
        angular_velocity=SimpleNamespace(x=x, y=y, z=z),
        angular_velocity_covariance=np.array([first_variance, *[0.0] * 8]),
    )


def mounted(turn: tuple[float, float, float, float]) -> LidarBook:
    """Return what knows a gyro that is turned so, x, y, z, w, on its robot."""
    mounts = Mounts()
    mounts.add([FrameTransform.of("base_link", "imu", (0.1, 0.0, 0.2), turn)])
    return LidarBook(lambda frame, kind: mounts.mount("base_link", frame) or Mount())


@pytest.mark.parametrize(
    ("turn", "along"),
    [
        ((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.5)),
        ((0.0, 0.0, _HALF, _HALF), (0.0, 0.0, 0.5)),
        ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, -0.5)),
        ((0.0, -_HALF, 0.0, _HALF), (0.5, 0.0, 0.0)),
        ((_HALF, 0.0, 0.0, _HALF), (0.0, 0.5, 0.0)),
    ],
    ids=["flat", "aside", "upside down", "x up", "y up"],
)
def test_a_gyro_tells_turns_about_the_vertical_however_it_is_mounted(
    turn: tuple[float, float, float, float], along: tuple[float, float, float]
) -> None:
    value = decoded(Kind.GYRO, turning(*along), mounted(turn))
    assert isinstance(value, Turning)
    assert value.speed == pytest.approx(0.5, abs=1e-5)
    level = tuple(0.5 - abs(part) for part in along)
    rolling = decoded(Kind.GYRO, turning(*level), mounted(turn))
    assert isinstance(rolling, Turning)
    assert rolling.speed == pytest.approx(0.0, abs=1e-5)


def test_an_axis_that_is_level_need_not_be_a_number() -> None:
    flat = mounted((0.0, 0.0, 0.0, 1.0))
    assert decoded(Kind.GYRO, turning(math.nan, math.nan, 0.5), flat) == Turning(0.5)
    assert isinstance(decoded(Kind.GYRO, turning(0.0, 0.0, math.nan), flat), Refused)


def test_a_gyro_that_says_that_it_measures_nothing_is_refused() -> None:
    book = mounted((0.0, 0.0, 0.0, 1.0))
    refused = decoded(Kind.GYRO, turning(0.0, 0.0, 0.0, -1.0), book)
    assert refused == Refused("messages of the gyro", "they say that no turning is measured")
