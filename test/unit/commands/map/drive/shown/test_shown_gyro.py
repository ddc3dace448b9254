"""Scans and odometry show a gyro's errors; a good gyro is left alone."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from fixtures.drives.made_logs import BEGAN
from fixtures.drives.turning_drive import (
    SECONDS,
    half_circle,
    readings_of,
    turning_drive,
    turning_pose,
)

from roomba.commands.map.drive.shown.lidar_samples import LidarSamples
from roomba.commands.map.drive.shown.shown_gyro import gyro_fault
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.readings import Odometry, Reading, Turning

Gyro = Callable[[float, float], float]


def turnings(gyro: Gyro, period: float, late: float) -> list[Reading]:
    """Return what a ``gyro`` says, made of seconds and the true speed, rad/s."""
    readings = []
    for seconds in np.arange(0.0, SECONDS, period).tolist():
        before, after = (turning_pose(max(seconds + step, 0.0)).theta for step in (-0.01, 0.01))
        stamp = BEGAN + seconds + late
        speed = gyro(seconds, (after - before) / 0.02)
        readings.append(Reading(stamp, Turning(speed), stamp + 0.02))
    return readings


def fault(
    gyro: Gyro,
    *,
    period: float = 0.02,
    late: float = 0.0,
    odometry: float = 1.0,
    lidar: LidarModel | None = None,
) -> str:
    """Return what is said of a gyro beside odometry that tells turns so many times as large."""
    readings = [
        each._replace(value=Odometry(Pose(pose.x, pose.y, odometry * pose.theta)))
        if isinstance(each.value, Odometry) and (pose := each.value.pose)
        else each
        for each in readings_of(turning_drive(), lidar or half_circle())
    ]
    readings += turnings(gyro, period, late)
    return gyro_fault(LidarSamples(sorted(readings, key=lambda each: each.stamp)))


@pytest.mark.parametrize(
    ("gyro", "said"),
    [
        (lambda seconds, speed: 0.0, "it tells turns of 0 rad where scans and odometry show 0."),
        (lambda seconds, speed: math.degrees(speed), "rad where scans and odometry show 0."),
        (lambda seconds, speed: 0.2 * math.sin(seconds), "where scans and odometry show"),
        (lambda seconds, speed: -speed, "it turns the other way than scans and odometry"),
    ],
    ids=["stands still", "degrees", "another axis", "mirrored"],
)
def test_a_gyro_that_tells_other_turns_is_seen(gyro: Gyro, said: str) -> None:
    assert said in fault(gyro)


@pytest.mark.parametrize(
    ("gyro", "period", "late"),
    [
        (lambda seconds, speed: speed, 0.02, 0.0),
        (lambda seconds, speed: 1.1 * speed + 0.05, 0.02, 0.0),
        (lambda seconds, speed: speed, 0.2, 0.0),
        (lambda seconds, speed: speed, 0.02, 0.15),
        (lambda seconds, speed: speed + 0.3 * math.sin(700.0 * seconds), 0.01, 0.0),
    ],
    ids=["true", "uncalibrated", "rare", "late", "noisy"],
)
def test_a_good_one_is_left_alone(gyro: Gyro, period: float, late: float) -> None:
    assert not fault(gyro, period=period, late=late)


def test_one_that_is_told_too_seldom_says_nothing() -> None:
    assert not fault(lambda seconds, speed: 0.0, period=0.5)
    assert not gyro_fault(LidarSamples(readings_of(turning_drive(), half_circle())))
    assert not gyro_fault(LidarSamples([]))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_where_scans_and_odometry_disagree_nothing_is_said(sign: float) -> None:
    """Wheels that slip may be wrong, and a lidar that hangs the other way round."""
    assert not fault(lambda seconds, speed: sign * speed, odometry=-1.0)
    assert not fault(lambda seconds, speed: sign * speed, odometry=0.3)
