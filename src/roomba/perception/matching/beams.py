"""A lidar's beams as compiled code knows them."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from roomba.arrays import Floats
from roomba.compilation import part

_ALL_AROUND: Final = 0.01
"""rad; beams that cover a full turn but for less than this go all around: none is the last."""


class LidarBeams(NamedTuple):
    """A lidar as kernels know it, with work arrays for the ends of its beams.

    ``directions`` is float64 [beams, 2], cosine and sine in the lidar's frame; ``mount`` [3] is the
    lidar's x, y, theta in the robot's frame; ``first_angle`` is the angle of beam 0 in the lidar's
    frame and ``step`` that from one beam to the next, rad. Ranges count from ``nearest`` on that
    are less than ``farthest``, m. Each beam is measured ``time_increment``, s, after the one before
    it. ``ends`` is [beams, 4], as of :class:`roomba.perception.matching.scan_view.ScanView`;
    ``lanes`` [JUDGE_LANES, beams] is a work array.
    """

    directions: Floats
    mount: Floats
    first_angle: float
    step: float
    nearest: float
    farthest: float
    time_increment: float
    ends: Floats
    lanes: Floats


@part
def is_all_around(beams: int, step: float) -> bool:
    """Whether so many beams, ``step`` rad from one to the next, go all around."""
    return beams * abs(step) > 2.0 * math.pi - _ALL_AROUND
