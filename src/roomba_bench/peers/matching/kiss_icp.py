"""kiss-icp: each scan is registered to a map of its own, which it makes on the way.

It was made for large scans outdoors. It gets the settings that served it best: voxels of 5 cm, and
the step by wheels and gyro as its prediction, in place of constant speed.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from kiss_icp.config import KISSConfig  # type: ignore[import-not-found, unused-ignore]
from kiss_icp.kiss_icp import KissICP  # type: ignore[import-not-found, unused-ignore]
from numpy.typing import NDArray

from roomba_bench.peers.matching.matrices import matrix_of, pose_of
from roomba_bench.peers.protocol import Parameters, Work

DISTRIBUTION = "kiss-icp"

_VOXEL = 0.05
_FIRST_THRESHOLD, _LEAST_MOTION = 0.3, 0.01
"""m."""

Floats = NDArray[np.float64]


class Odometry:
    """One scan after the other; poses begin at the origin."""

    def __init__(self, beams: int, nearest: float, farthest: float) -> None:
        """Take the lidar's beams and reach, m."""
        config = KISSConfig()
        config.data.deskew = False
        config.data.min_range, config.data.max_range = nearest, 2.0 * farthest
        config.mapping.voxel_size = _VOXEL
        config.adaptive_threshold.initial_threshold = _FIRST_THRESHOLD
        config.adaptive_threshold.min_motion_th = _LEAST_MOTION
        config.registration.max_num_threads = 1
        self._kiss = KissICP(config)
        angles = np.arange(beams) * (2.0 * math.pi / beams)
        self._fan = np.column_stack([np.cos(angles), np.sin(angles)])
        self._nearest, self._farthest = nearest, farthest

    def register(self, ranges: NDArray[np.float32], step: Floats) -> Floats:
        """Return where a scan was taken, 4 x 4, which is about ``step`` after the last."""
        met = (ranges >= self._nearest) & (ranges <= self._farthest)
        ends = np.zeros((np.count_nonzero(met), 3))
        ends[:, :2] = ranges[met, None] * self._fan[met]
        self._kiss.last_delta = step
        if len(ends):
            self._kiss.register_frame(ends, np.zeros(len(ends)))
        else:
            self._kiss.last_pose = self._kiss.last_pose @ step
        return np.asarray(self._kiss.last_pose)


def prepare(parameters: Parameters) -> Work:
    """Follow the whole drive, and write the poses; then it is followed anew, scan by scan."""
    drive = np.load(parameters["scans"])
    ranges, reckoned = drive["ranges"], drive["reckoned"]
    start = matrix_of(parameters["start"])
    stations = [start, *map(matrix_of, reckoned)]
    steps = [np.linalg.inv(one) @ other for one, other in itertools.pairwise(stations)]

    def odometry() -> Odometry:
        return Odometry(ranges.shape[1], parameters["nearest"], parameters["farthest"])

    following = odometry()
    # The first scan is taken a moment after the start.
    start = start @ steps[0]
    poses = [
        start @ following.register(scan, step if at else np.eye(4))
        for at, (scan, step) in enumerate(zip(ranges, steps, strict=True))
    ]
    np.save(parameters["poses"], np.array([pose_of(pose) for pose in poses]))
    following = odometry()
    at = 0

    def work() -> float:
        nonlocal following, at
        if at == len(ranges):
            following, at = odometry(), 0
        following.register(ranges[at], steps[at] if at else np.eye(4))
        at += 1
        return 1.0

    return Work(work)
