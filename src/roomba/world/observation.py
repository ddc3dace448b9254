"""What a simulated robot's sensors say after a step, beside the truth: plain values."""

from __future__ import annotations

from dataclasses import dataclass

from roomba.geometry import Pose, Twist
from roomba.world.engine.state.arrays import Infrared
from roomba.world.power import BatteryState


@dataclass(frozen=True, slots=True)
class Bumper:
    """Which halves of the front bumper are pressed; both at contact straight ahead."""

    left: bool = False
    right: bool = False

    @property
    def pressed(self) -> bool:
        """Whether any part is pressed."""
        return self.left or self.right


@dataclass(frozen=True, slots=True)
class Cliff:
    """Which of the cliff sensors see no floor."""

    left: bool = False
    front_left: bool = False
    front_right: bool = False
    right: bool = False

    @property
    def any(self) -> bool:
        """Whether one of them does."""
        return self.left or self.front_left or self.front_right or self.right


@dataclass(frozen=True, slots=True)
class Wheels:
    """Of a left and a right wheel: how far each turned, rad, as counted; and what is wrong."""

    left: float
    right: float
    dropped_left: bool
    dropped_right: bool
    stalled_left: bool
    stalled_right: bool

    @property
    def dropped(self) -> bool:
        """Whether a wheel hangs in the air."""
        return self.dropped_left or self.dropped_right

    @property
    def stalled(self) -> bool:
        """Whether a wheel is held and should turn."""
        return self.stalled_left or self.stalled_right


@dataclass(frozen=True, slots=True)
class Observation:
    """The state after a step: the truth (``pose``, ``twist``), and what the sensors measure.

    ``odometry`` and ``odometry_twist`` are by the wheel encoders, in the frame that the robot
    started in; ``angular_velocity`` (rad/s) and ``acceleration`` (m/s2, ahead) are the gyro's and
    accelerometer's. ``dirt_under`` is g under the body's disc, ``in_bin`` g in the bin, ``grains``
    what the dirt sensor counts, 1/s, a whole number, ``brush_current`` A. ``scans`` counts the
    lidar's scans that arrived; ``scan_stamp`` is when the first beam of the newest one was
    measured, s.
    """

    time: float
    pose: Pose
    twist: Twist
    odometry: Pose
    odometry_twist: Twist
    bumper: Bumper
    cliff: Cliff
    wheels: Wheels
    angular_velocity: float
    acceleration: float
    infrared: Infrared
    battery: BatteryState
    dirt_under: float
    in_bin: float
    grains: float
    brush_current: float
    scans: int
    scan_stamp: float
