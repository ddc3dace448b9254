"""All that a body tells its brain at a tick."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from roomba.control.speed_loop import Hazards
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.mission.docking.beams import NO_BEAMS, StationBeams
from roomba.mission.inputs.senses import Battery, EmptyingTold, Senses
from roomba.perception.localization.estimate import Knowledge

if TYPE_CHECKING:
    # It comes with compiled code, which a node that takes no scans need not load.
    from roomba.perception.matching.scan_view import LidarModel


@dataclass(frozen=True, slots=True, eq=False)
class ScanReading:
    """A scan of a lidar: ``ranges`` is float32 [beams], m, taken at ``stamp``, s."""

    stamp: float
    ranges: NDArray[np.float32]
    lidar: LidarModel


@dataclass(frozen=True, slots=True)
class CliffReading:
    """Which of the cliff sensors see no floor."""

    left: bool = False
    front_left: bool = False
    front_right: bool = False
    right: bool = False

    @property
    def any(self) -> bool:
        """Whether any cliff sensor sees no floor."""
        return self.left or self.front_left or self.front_right or self.right


_NO_CLIFF = CliffReading()
_FULL = Battery()


@dataclass(frozen=True, slots=True, eq=False)
class Readings:
    """What the sensors tell at ``time``, s of the robot's clock.

    ``odometry`` and ``twist`` (m/s, rad/s) are by the wheels, ``turning`` (rad/s) by the gyro, None
    without one; ``scan`` is the newest one if it is new. ``grains`` is what the dirt sensor counts,
    1/s, ``in_bin`` what was picked up, g, ``brush_current`` what the brush's motor takes, A; 0
    where it is not told; ``emptying`` is what a station tells that empties the bin. ``wall`` is how
    near the wall on its right is, from 0, out of the sensor's reach, to 1, at the body; 0 without
    such a sensor.
    """

    time: float
    odometry: Pose
    _: KW_ONLY
    twist: Twist = STANDSTILL
    turning: float | None = None
    scan: ScanReading | None = None
    bumper_left: bool = False
    bumper_right: bool = False
    cliff: CliffReading = _NO_CLIFF
    dropped_left: bool = False
    dropped_right: bool = False
    beams: StationBeams = NO_BEAMS
    battery: Battery = _FULL
    grains: float = 0.0
    in_bin: float = 0.0
    brush_current: float = 0.0
    emptying: EmptyingTold | None = None
    wall: float = 0.0

    @property
    def bumps(self) -> bool:
        """Whether the bumper is pressed anywhere."""
        return self.bumper_left or self.bumper_right

    @property
    def hazards(self) -> Hazards:
        """What the drive must not go on into."""
        return Hazards(self.bumps, self.cliff.any, self.dropped_left or self.dropped_right)

    @property
    def is_lifted(self) -> bool:
        """Whether both wheels hang in the air: the robot is held."""
        return self.dropped_left and self.dropped_right


def senses_of(
    readings: Readings,
    pose: Pose,
    knowledge: Knowledge,
    trouble: str = "",
    unsure: float = math.inf,
) -> Senses:
    """Return what the robot senses, of what its body tells and what is known of its place.

    ``trouble`` says why the place is not known better, ``unsure`` is its standard deviation, m.
    """
    turning = readings.twist.angular if readings.turning is None else readings.turning
    return Senses(
        readings.time,
        pose,
        twist=Twist(readings.twist.linear, turning),
        knowledge=knowledge,
        trouble=trouble,
        bumper_left=readings.bumper_left,
        bumper_right=readings.bumper_right,
        cliff_left=readings.cliff.left or readings.cliff.front_left,
        cliff_right=readings.cliff.right or readings.cliff.front_right,
        lifted=readings.is_lifted,
        wheel_hangs=readings.dropped_left or readings.dropped_right,
        beams=readings.beams,
        battery=readings.battery,
        grains=readings.grains,
        in_bin=readings.in_bin,
        brush_current=readings.brush_current,
        emptying=readings.emptying,
        unsure=unsure,
    )
