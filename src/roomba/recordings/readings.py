"""What a recorded drive says: odometry, scans, turning speeds, each with its time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.geometry import Pose
from roomba.perception.matching.scan_view import LidarModel

UNUSABLE_SCANS: Final = "scans that cannot be used"
"""What is refused of the lidar."""


class LogError(RoombaError):
    """A log that cannot be used; says what was expected, what came, and what to do."""


class Kind(IntEnum):
    """What a channel tells; of readings of the same time the first of these comes first."""

    GYRO = 0
    ODOMETRY = 1
    TRUTH = 2
    """Where the robot truly was; simulators write it."""
    SCAN = 3


class Turning(NamedTuple):
    """What a gyro measured: ``speed`` in rad/s, counter-clockwise as seen from above."""

    speed: float


class Odometry(NamedTuple):
    """Where the wheels take the robot to be, in their own frame."""

    pose: Pose


class TruePose(NamedTuple):
    """Where the robot was, in the frame of the true map."""

    pose: Pose


@dataclass(frozen=True, slots=True, eq=False)
class LidarScan:
    """A scan of ``lidar``: ``ranges`` is float32 [beams], m; what is not finite met nothing."""

    ranges: NDArray[np.float32]
    lidar: LidarModel


Value: TypeAlias = Turning | Odometry | TruePose | LidarScan


class Reading(NamedTuple):
    """A value and when it was measured, s, by the clock of the odometry."""

    stamp: float
    value: Value


class Refused(NamedTuple):
    """In place of a value that cannot be used: what it is one of, and the reason."""

    what: str
    reason: str
