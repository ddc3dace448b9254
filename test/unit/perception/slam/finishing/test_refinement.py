"""Keyframes that were followed with errors agree again, each for itself."""

from __future__ import annotations

import numpy as np
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, Floats, points_of

from roomba.geometry import Pose
from roomba.perception.slam.finishing.refinement import refined
from roomba.perception.slam.submaps.submap import Keyframe

REACH, RANGE, POINT = 16.0, 0.005, 0.03


def around(count: int) -> Floats:
    """Poses on a circle of 1 m around the middle of the room, twice around."""
    angles = np.arange(count) * (4.0 * np.pi / count)
    heading = np.remainder(angles + 1.5 * np.pi, 2.0 * np.pi) - np.pi
    return np.column_stack((2.5 + np.cos(angles), 2.2 + np.sin(angles), heading))


def seen_from(poses: Floats) -> list[Keyframe]:
    eye = Eye(FURNISHED)
    return [
        Keyframe(points_of(eye.scan(Pose(*pose))).astype(np.float32), pose)
        for pose in poses.tolist()
    ]


def test_drift_of_centimetres_becomes_one_of_millimetres() -> None:
    truth = around(80)
    drift = np.linspace(0.0, 1.0, 80)[:, None] * np.array([0.06, -0.04, 0.03])
    found = refined(seen_from(truth), truth + drift, {}, REACH, RANGE, POINT)
    assert np.abs(drift[:, :2]).max() > 0.05
    assert np.abs(found[:, :2] - truth[:, :2]).max() < 0.012
    turned = np.remainder(found[:, 2] - truth[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    assert np.abs(turned).max() < 0.006
    assert np.array_equal(found[0], truth[0])


def test_poses_that_agree_stay() -> None:
    truth = around(80)
    found = refined(seen_from(truth), truth, {}, REACH, RANGE, POINT)
    off = found - truth
    off[:, 2] = np.remainder(off[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    assert np.abs(off).max() < 0.004


def test_a_few_keyframes_are_left_as_they_are() -> None:
    truth = around(10)
    assert refined(seen_from(truth), truth + 0.1, {}, REACH, RANGE, POINT) is not None
    assert np.array_equal(refined(seen_from(truth), truth, {}, REACH, RANGE, POINT), truth)
