"""The lidar has its measured mount, as the same object as long as the mount stays the same."""

from __future__ import annotations

import math

import numpy as np
import pytest

from roomba.geometry import Pose
from roomba.perception.calibration.lidar import CorrectedLidar, lidar_correction
from roomba.perception.localization.belief.belief import unknown_belief
from roomba.perception.matching.scan_view import LidarModel

TOLD = LidarModel(np.arange(8) * (math.pi / 4.0), 0.1, 12.0, Pose(0.1, 0.0, math.pi))


def test_without_a_correction_it_is_what_is_told() -> None:
    assert CorrectedLidar().of(TOLD) is TOLD


def test_the_mount_is_moved_with_the_robot_as_its_middle() -> None:
    lidar = CorrectedLidar()
    lidar.correction = Pose(0.01, -0.02, 0.5 * math.pi)
    moved = lidar.of(TOLD)
    assert lidar.of(TOLD) is moved
    assert moved.mount.tolist() == pytest.approx([0.01, 0.08, -0.5 * math.pi])
    assert TOLD.mount.tolist() == pytest.approx([0.1, 0.0, math.pi])
    # Beam 0 looks along the mount.
    end = moved.view(np.full(8, 2.0, np.float32)).ends[0, :2]
    assert end.tolist() == pytest.approx([0.01, 0.08 - 2.0], abs=1e-6)
    lidar.correction = Pose()
    assert lidar.of(TOLD) is TOLD


def test_a_belief_tells_what_it_goes_by() -> None:
    belief = unknown_belief()
    belief[0]["calibration"]["errors"] = 0.1
    assert lidar_correction(belief) == Pose()
    belief[0]["calibration"]["applied"][4:] = 0.01, 0.02, 0.03
    assert lidar_correction(belief) == Pose(0.01, 0.02, 0.03)
