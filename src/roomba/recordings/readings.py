"""What a recorded drive says: odometry, scans, turning speeds, poses, each with its time."""

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
UNUSABLE_ODOMETRY: Final = "messages of odometry"
"""What is refused of the odometry."""


class LogError(RoombaError):
    """A log that cannot be used; says what was expected, what came, and what to do."""


class Kind(IntEnum):
    """What a channel tells; readings of the same time come in the order of these members."""

    GYRO = 0
    ODOMETRY = 1
    TRUTH = 2
    """Where the robot truly was; simulators write it."""
    LIFTED = 3
    """Whether the wheels hang in the air."""
    TOLD = 4
    """A pose that a person or a program told."""
    SCAN = 5
    OWN_POSE = 6
    """Where the robot itself believed to be."""


class Turning(NamedTuple):
    """What a gyro measured: ``speed`` in rad/s, counter-clockwise as seen from above."""

    speed: float


class Odometry(NamedTuple):
    """Where the wheels take the robot to be, in their own frame."""

    pose: Pose


class TruePose(NamedTuple):
    """Where the robot was, in the frame of the true map."""

    pose: Pose


class Lifted(NamedTuple):
    """Whether the robot is held, so that both wheels hang; at an edge only one of them does."""

    is_lifted: bool


class ToldPose(NamedTuple):
    """A pose on the map that was told, and its standard deviations, m and rad."""

    pose: Pose
    deviation: tuple[float, float]


class OwnPose(NamedTuple):
    """Where the robot itself believed to be on the map; some robots do not tell the heading: 0."""

    pose: Pose


@dataclass(frozen=True, slots=True, eq=False)
class LidarScan:
    """A scan of ``lidar``: ``ranges`` is float32 [beams], m; what is not finite met nothing."""

    ranges: NDArray[np.float32]
    lidar: LidarModel


Value: TypeAlias = Turning | Odometry | TruePose | Lifted | ToldPose | LidarScan | OwnPose


class Reading(NamedTuple):
    """A value and when it was measured, s, by the clock of the odometry.

    ``arrival`` is when it was recorded, s, by the clock of the recorder.
    """

    stamp: float
    value: Value
    arrival: float


class Refused(NamedTuple):
    """Stands for a value that cannot be used: ``what`` kind it is of, and the ``reason``."""

    what: str
    reason: str
