"""Numbers of the robot's body, its tools and its battery."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Final

from pydantic import Field

from roomba.configuration.frozen import (
    Acceleration,
    AtLeastOne,
    Duration,
    Frozen,
    Positive,
    Ratio,
    Side,
    TurningSpeed,
)
from roomba.geometry import Pose
from roomba.vocabulary import FanLevel

FASTEST_SPEED: Final = 3.0
"""m/s; a higher speed is taken for a typing mistake: no robot for a home is as fast."""
Speed = Annotated[float, Field(ge=0.001, le=FASTEST_SPEED)]
BinCapacity = Annotated[float, Field(ge=0.01, le=100_000.0)]
"""g; a smaller bin would be filled by each pass over a floor."""
Angles = Annotated[
    tuple[Annotated[float, Field(ge=-math.pi, le=math.pi)], ...], Field(min_length=1)
]


_ABOUT: Final = Pose(0.0, 0.0, math.pi)
"""Half a turn."""


class BodyConfig(Frozen):
    """The round differential-drive body; lengths in m, speeds in m/s and rad/s."""

    diameter: Side = 0.32
    height: Side = 0.092
    wheel_separation: Side = 0.235
    wheel_diameter: Side = 0.072
    max_speed: Speed = 0.5
    max_angular_speed: TurningSpeed = 4.25
    max_acceleration: Acceleration = 0.9
    max_deceleration: Acceleration = 2.0
    max_angular_acceleration: Acceleration = 7.7
    command_timeout: Duration = 0.15
    backing_speed: Speed = 0.1
    """m/s; away from a cliff, and from what the bumper met."""
    cliff_backing_time: Duration = 2.5
    """s; then it stands: no sensor looks behind, and a cliff sensor may be dirty."""
    bumper_backing_time: Duration = 0.6
    """s; the longest time that it backs off from what the bumper met."""
    bumper_side: Angles = (0.35, 0.95)
    """rad; where on the left half of the rim a press of that half may come from; the right half is
    its mirror image."""
    bumper_middle: Angles = (-0.45, 0.0, 0.45)
    """rad; the same of a press of both halves."""
    docks_backwards: bool = False
    """Whether the contacts of its charging station are behind it."""

    @property
    def radius(self) -> float:
        """Radius of the body's disc, m."""
        return self.diameter / 2.0

    def pressed(self, left: bool, right: bool) -> tuple[float, float]:
        """Return the least and greatest bearing, rad, at which something may press these halves."""
        if left and right:
            farthest = max(abs(angle) for angle in self.bumper_middle)
            return -farthest, farthest
        return (0.0, math.pi / 2.0) if left else (-math.pi / 2.0, 0.0)

    def docked_at(self, station: Pose) -> Pose:
        """Return the pose of the robot for that of its station, which looks into the station.

        They differ for a robot that docks backwards, by a half turn: so this is its own inverse.
        """
        return station.compose(_ABOUT) if self.docks_backwards else station

    @property
    def max_angular_deceleration(self) -> float:
        """Braking of a turn on the spot, rad/s2: each wheel brakes as in a straight drive."""
        return 2.0 * self.max_deceleration / self.wheel_separation

    @property
    def braking_time(self) -> float:
        """Time from top speed to rest, straight or turning, s."""
        return max(
            self.max_speed / self.max_deceleration,
            self.max_angular_speed / self.max_angular_deceleration,
        )


class BrushConfig(Frozen):
    """Brushes and bin: the cleaned width, m, the duty at the start, 0..1, and the bin, g.

    The brush's motor takes ``carpet_current`` A and more on carpet, less than ``floor_current`` off
    it, in a mean in which the newest current has ``current_share``.
    """

    width: Annotated[float, Field(ge=0.05, le=1.0)] = 0.20
    duty: Ratio = 1.0
    bin_capacity: BinCapacity = 100.0
    carpet_current: Positive = 0.33
    floor_current: Positive = 0.29
    current_share: Ratio = 0.3

    in_order: ClassVar[tuple[str, ...]] = ("floor_current <= carpet_current",)


class FanConfig(Frozen):
    """The fan's duty at the start and at each level of a clean, 0..1."""

    duty: Ratio = 0.60
    quiet: Ratio = 0.30
    standard: Ratio = 0.60
    strong: Ratio = 1.0

    in_order: ClassVar[tuple[str, ...]] = ("quiet <= standard <= strong",)

    def duty_at(self, level: FanLevel) -> float:
        """Return the duty at a level of a clean, 0..1."""
        match level:
            case FanLevel.QUIET:
                return self.quiet
            case FanLevel.STANDARD:
                return self.standard
            case FanLevel.STRONG:
                return self.strong


class BatteryConfig(Frozen):
    """The battery as its label has it: Wh, V."""

    capacity: Positive = 26.0
    nominal_voltage: Positive = 14.4
    cells: AtLeastOne = 4
    """In series."""


class HealthConfig(Frozen):
    """Limits beyond which ``/diagnostics`` tells that a part is in need: shares 0..1."""

    low_battery: Ratio = 0.10
    """Of the charge; with less the robot should go home."""
    empty_battery: Ratio = 0.03
    """Of the charge; with less it must be carried."""
    hot_battery: Positive = 45.0
    """Degrees Celsius; lithium cells should not be charged much warmer."""
    full_bin: Ratio = 0.95
    most_misses: Ratio = 0.5
    """Share of beams without a range; walls around the robot explain no larger one."""

    in_order: ClassVar[tuple[str, ...]] = ("empty_battery <= low_battery",)
