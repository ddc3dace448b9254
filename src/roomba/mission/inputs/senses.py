"""The senses: the input of a mission at each tick."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass

from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.mission.docking.beams import NO_BEAMS, StationBeams
from roomba.perception.localization.estimate import Knowledge


@dataclass(frozen=True, slots=True)
class Battery:
    """``level`` is 0..1 of ``capacity`` (Wh); ``is_docked`` while the station's contacts touch, so
    that current comes in unless it is full."""

    level: float = 1.0
    capacity: float = 26.0
    is_docked: bool = False

    @property
    def energy(self) -> float:
        """What is in it, Wh."""
        return self.level * self.capacity


@dataclass(frozen=True, slots=True)
class EmptyingTold:
    """What a station that empties the bin tells: whether it is at work, its bag's level, 0..1."""

    is_at_work: bool
    bag: float


_FULL = Battery()


@dataclass(frozen=True, slots=True)
class Senses:
    """What the robot senses: time s of its clock, pose in the map frame as it is believed.

    ``knowledge`` is how well the pose is known, ``trouble`` why not better, ``unsure`` the standard
    deviation of its place, m, infinite where none is told; ``twist`` is by the wheels, and its
    turning speed by the gyro where there is one; ``cliff_left`` tells that the left cliff sensors
    see no floor; ``lifted`` that both wheels hang in the air, ``wheel_hangs`` that one does, or
    both; ``grains`` is what the dirt sensor counts, 1/s; ``in_bin`` what was picked up, g;
    ``brush_current`` what the brush's motor takes, A; ``emptying`` what the station tells that
    empties the bin, None of one that does not.
    """

    now: float
    pose: Pose
    _: KW_ONLY
    twist: Twist = STANDSTILL
    knowledge: Knowledge = Knowledge.KNOWN
    trouble: str = ""
    bumper_left: bool = False
    bumper_right: bool = False
    cliff_left: bool = False
    cliff_right: bool = False
    lifted: bool = False
    wheel_hangs: bool = False
    beams: StationBeams = NO_BEAMS
    battery: Battery = _FULL
    grains: float = 0.0
    in_bin: float = 0.0
    brush_current: float = 0.0
    emptying: EmptyingTold | None = None
    unsure: float = math.inf

    @property
    def cliff(self) -> bool:
        """Whether the cliff sensors of one side, or of both, see no floor."""
        return self.cliff_left or self.cliff_right

    @property
    def touches(self) -> tuple[bool, bool]:
        """Whether something is in the way on the left, on the right: felt, or no floor seen."""
        return self.bumper_left or self.cliff_left, self.bumper_right or self.cliff_right

    @property
    def where(self) -> str:
        """The robot's place as text, m, map frame."""
        return f"({self.pose.x:.2f}, {self.pose.y:.2f})"
