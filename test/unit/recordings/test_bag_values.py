"""Messages of bags as values."""

from __future__ import annotations

import gc
import math
import weakref
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from roomba.geometry import Pose
from roomba.perception.matching.mounts import FrameTransform, Mount, Mounts
from roomba.recordings.bag_values import LidarBook, decoded
from roomba.recordings.readings import Kind, Odometry, Refused, Turning

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


@pytest.mark.parametrize("length", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("theta", [-2.5, -0.4, 0.0, 1.2, 3.0])
def test_a_quaternion_of_any_length_tells_the_heading(length: float, theta: float) -> None:
    place = SimpleNamespace(x=1.0, y=2.0, z=0.0)
    x, y, z, w = 0.0, 0.0, length * math.sin(theta / 2.0), length * math.cos(theta / 2.0)
    pose = SimpleNamespace(position=place, orientation=SimpleNamespace(x=x, y=y, z=z, w=w))
    message = SimpleNamespace(pose=SimpleNamespace(pose=pose))
    value = decoded(Kind.ODOMETRY, message, LidarBook(lambda frame, kind: Mount()))
    assert isinstance(value, Odometry)
    assert value.pose.as_array() == pytest.approx(Pose(1.0, 2.0, theta).as_array())


def scan(increment: float, frame: str = "laser", beams: int = 4) -> Any:
    """Return a message of a lidar."""
    return SimpleNamespace(
        header=SimpleNamespace(frame_id=frame),
        angle_min=0.0,
        angle_increment=0.1,
        time_increment=increment,
        range_min=0.1,
        range_max=9.0,
        ranges=np.arange(1.0, beams + 1.0),
    )


def test_a_lidar_that_turns_a_little_faster_is_the_same() -> None:
    book = LidarBook(lambda frame, kind: Mount())
    one = book.lidar_of(scan(1e-4))
    assert one.time_increment == 1e-4
    assert all(book.lidar_of(scan(each)) is one for each in (1.01e-4, 0.99e-4, 1.015e-4))
    faster = book.lidar_of(scan(0.9e-4))
    assert faster.time_increment == 0.9e-4
    assert book.lidar_of(scan(-0.9e-4)) is not faster


def test_of_each_frame_the_newest_lidar_alone_is_kept() -> None:
    book = LidarBook(lambda frame, kind: Mount())
    one, other = (book.lidar_of(scan(0.0, frame)) for frame in ("left", "right"))
    assert book.lidar_of(scan(0.0, "left")) is one
    assert book.lidar_of(scan(0.0, "right")) is other
    before = weakref.ref(book.lidar_of(scan(0.0, "left", beams=5)))
    del one
    book.lidar_of(scan(0.0, "left"))
    gc.collect()
    assert before() is None


def test_a_gyro_that_says_that_it_measures_nothing_is_refused() -> None:
    book = mounted((0.0, 0.0, 0.0, 1.0))
    refused = decoded(Kind.GYRO, turning(0.0, 0.0, 0.0, -1.0), book)
    assert refused == Refused("messages of the gyro", "they say that no turning is measured")
