"""Compiled: which poses scans determine well enough to measure the robot's errors by them."""

from __future__ import annotations

from typing import Final

from roomba.arrays import Floats
from roomba.compilation import inner_part
from roomba.perception.calibration.kernels import drop_window, note_place
from roomba.perception.calibration.state import Row

_SURE: Final = 0.012
_SURE_TURN: Final = 0.01
"""m, rad; standard deviations above which a scan does not determine the whole pose: along a bare
corridor the pose is dead reckoning's own, which would be compared with itself."""


@inner_part
def note_pose(
    row: Row, pose: tuple[float, float, float], covariance: Floats, of_map: Floats
) -> None:
    """Take the robot's pose, x, y, theta, after a scan, if the scan determines all of it.

    ``covariance`` [3, 3] is by dead reckoning and scan; ``of_map`` [3, 3] is by the map's errors.
    """
    variance, turn_variance = max(covariance[0, 0], covariance[1, 1]), covariance[2, 2]
    if not (variance <= _SURE * _SURE and turn_variance <= _SURE_TURN * _SURE_TURN):
        drop_window(row)
        return
    variance += max(of_map[0, 0], of_map[1, 1])
    note_place(row, pose, variance, turn_variance + of_map[2, 2])
