"""small_gicp: each scan is registered to points on the map's surfaces, from where the wheels say.

It gets the settings that served it best: points every 2 cm, at three heights, so that it finds the
walls' normals; the distance to these planes; and the prediction by wheels and gyro.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import small_gicp  # type: ignore[import-not-found, unused-ignore]
from numpy.typing import NDArray

from roomba_bench.peers.matching.matrices import matrix_of, pose_of
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "small_gicp"

_HEIGHTS = (-0.02, 0.0, 0.02)
_NEIGHBOURS = 10
_FARTHEST = 0.3
"""m; the farthest surface that a beam's end may belong to."""
_ROUNDS = 20
_SETTLED, _SETTLED_TURN = 5e-5, 2e-4
"""m, rad."""

Floats = NDArray[np.float64]


class Registration:
    """The map's points, and one scan after the other."""

    def __init__(self, surfaces: Floats, beams: int, nearest: float, farthest: float) -> None:
        """``surfaces`` is float64 [points, 2], m."""
        walls = [np.column_stack([surfaces, np.full(len(surfaces), z)]) for z in _HEIGHTS]
        self._target = small_gicp.PointCloud(np.vstack(walls))
        self._tree = small_gicp.KdTree(self._target)
        small_gicp.estimate_normals(self._target, self._tree, _NEIGHBOURS)
        angles = np.arange(beams) * (2.0 * math.pi / beams)
        self._fan = np.column_stack([np.cos(angles), np.sin(angles)])
        self._nearest, self._farthest = nearest, farthest

    def register(self, ranges: NDArray[np.float32], guess: Floats) -> Floats:
        """Return where a scan was taken, 4 x 4, which is near ``guess``."""
        met = (ranges >= self._nearest) & (ranges <= self._farthest)
        if not met.any():
            return guess
        ends = np.zeros((np.count_nonzero(met), 3))
        ends[:, :2] = ranges[met, None] * self._fan[met]
        result = small_gicp.align(
            self._target,
            small_gicp.PointCloud(ends),
            self._tree,
            guess,
            registration_type="PLANE_ICP",
            max_correspondence_distance=_FARTHEST,
            num_threads=1,
            max_iterations=_ROUNDS,
            rotation_epsilon=_SETTLED_TURN,
            translation_epsilon=_SETTLED,
        )
        # It stays on the floor.
        return matrix_of(pose_of(result.T_target_source))


def prepare(parameters: Parameters) -> Work:
    """Follow the whole drive, and write the poses; then scans are registered over and over."""
    drive = np.load(parameters["scans"])
    ranges, reckoned = drive["ranges"], drive["reckoned"]
    registration = Registration(
        np.load(parameters["surfaces"]),
        ranges.shape[1],
        parameters["nearest"],
        parameters["farthest"],
    )
    pose, before = matrix_of(parameters["start"]), matrix_of(parameters["start"])
    guesses, poses = [], []
    for scan, now in zip(ranges, map(matrix_of, reckoned), strict=True):
        guesses.append(pose @ np.linalg.inv(before) @ now)
        pose, before = registration.register(scan, guesses[-1]), now
        poses.append(pose_of(pose))
    np.save(parameters["poses"], np.array(poses))
    again = itertools.cycle(zip(ranges, guesses, strict=True))

    def work() -> float:
        registration.register(*next(again))
        return 1.0

    return Work(work)
