"""Numbers of the robot as it knows itself: its body, its sensors, and how it drives.

What is true of a simulated robot, and unknown to its brain, is in ``configuration/simulation.py``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Final

from pydantic import Field, model_validator

from roomba.configuration.frozen import (
    Degrees,
    Frozen,
    NotNegative,
    Positive,
    Ratio,
    read_yaml,
    validated,
)
from roomba.configuration.lidars import with_model
from roomba.vocabulary import FanLevel

FASTEST_SPEED: Final = 3.0
"""m/s; a speed above this is a slip of the finger, not a robot for a home."""
SIMULATION: Final = "simulation"
"""The part of a robot's file that is the simulator's; a brain does not read it."""
UNKNOWN: Final = "unknown; what is true of the simulated robot alone stands under simulation:"
"""What is said of a key that the robot's file does not have."""
STANDSTILL_WITHIN: Final = 0.5
"""s; the robot stands so soon after its commands end, for whatever reason."""
Angles = Annotated[
    tuple[Annotated[float, Field(ge=-math.pi, le=math.pi)], ...], Field(min_length=1)
]


class BodyConfig(Frozen):
    """The round differential-drive body; lengths in m, speeds in m/s and rad/s."""

    diameter: Positive = 0.32
    height: Positive = 0.092
    wheel_separation: Positive = 0.235
    wheel_diameter: Positive = 0.072
    max_speed: Annotated[float, Field(gt=0.0, le=FASTEST_SPEED, allow_inf_nan=False)] = 0.5
    max_angular_speed: Positive = 4.25
    max_acceleration: Positive = 0.9
    max_deceleration: Positive = 2.0
    max_angular_acceleration: Positive = 7.7
    command_timeout: Positive = 0.15
    backing_speed: Positive = 0.1
    """m/s; away from a cliff, and from what the bumper met."""
    cliff_backing_time: Positive = 2.5
    """s; then it stands: no sensor looks behind, and a cliff sensor may be dirty."""
    bumper_backing_time: Positive = 0.6
    """s; the longest time that it backs off from what the bumper met."""
    bumper_side: Angles = (0.35, 0.95)
    """rad; where on the left half of the rim a press of that half may come from; the right half is
    its mirror image."""
    bumper_middle: Angles = (-0.45, 0.0, 0.45)
    """rad; the same of a press of both halves."""

    @property
    def radius(self) -> float:
        """Radius of the body's disc, m."""
        return self.diameter / 2.0

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
    """Brushes and bin: the cleaned width, m, the duty at the start, 0..1, and the bin, g."""

    width: Positive = 0.20
    duty: Ratio = 1.0
    bin_capacity: Positive = 100.0


class FanConfig(Frozen):
    """The fan's duty at the start and at each level of a clean, 0..1."""

    duty: Ratio = 0.60
    quiet: Ratio = 0.30
    standard: Ratio = 0.60
    strong: Ratio = 1.0

    @model_validator(mode="after")
    def _levels_in_order(self) -> FanConfig:
        if not self.quiet <= self.standard <= self.strong:
            raise ValueError(
                "expected quiet <= standard <= strong, got "
                f"{self.quiet}, {self.standard}, {self.strong}"
            )
        return self

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


class LidarConfig(Frozen):
    """The lidar: beams evenly spaced, counter-clockwise; ranges in m, times in s.

    One that looks all around, ``field`` 360 degrees, has beam 0 ahead; another one's middle is
    ahead. It takes ``sweep_time`` from its first beam to where a next one would be; with 0 all are
    measured at once. ``model`` is the file of ``data/configuration/lidars`` whose numbers stand
    for what is not given.
    """

    model: str = "ideal_12m"
    beams: Annotated[int, Field(ge=8, le=4096)] = 360
    field: Annotated[float, Field(ge=10.0, le=360.0)] = 360.0
    min_range: Positive = 0.15
    max_range: Positive = 12.0
    rate: Positive = 10.0
    sweep_time: NotNegative = 0.0
    mount_height: Positive = 0.085

    @property
    def beam_step(self) -> float:
        """Angle from one beam to the next, rad."""
        is_around = self.field == 360.0
        return math.radians(self.field) / (self.beams if is_around else self.beams - 1)

    @property
    def first_angle(self) -> float:
        """Where beam 0 points, rad, 0 ahead."""
        return 0.0 if self.field == 360.0 else -0.5 * math.radians(self.field)

    @property
    def time_increment(self) -> float:
        """Time from one beam to the next, s."""
        return self.sweep_time / self.beams

    @model_validator(mode="after")
    def _sweeps_fit(self) -> LidarConfig:
        if self.sweep_time > 1.0 / self.rate + 1e-9:
            raise ValueError(f"expected a sweep_time of at most 1 / rate ({1.0 / self.rate:g} s)")
        return self

    @model_validator(mode="after")
    def _ranges_in_order(self) -> LidarConfig:
        if self.min_range >= self.max_range:
            raise ValueError(f"expected min_range below max_range ({self.max_range})")
        return self


class WheelsConfig(Frozen):
    """The wheel encoders."""

    counts_per_turn: Positive = 508.8


class GyroConfig(Frozen):
    """The gyro as its data sheet has it, rad/s: standard deviations of a sample and of the bias.

    What a simulated gyro does is :class:`roomba.configuration.simulation.SimulatedGyro`.
    """

    noise: NotNegative = 0.0015
    bias: NotNegative = 0.0005


class CliffConfig(Frozen):
    """Four cliff sensors under the front rim, left to right; degrees and m."""

    angles: tuple[Degrees, Degrees, Degrees, Degrees] = (60.0, 15.0, -15.0, -60.0)
    radius: Positive = 0.155


class StationConfig(Frozen):
    """What the charging station sends out: a halo, and two beams that overlap; m and degrees."""

    halo: Positive = 0.6
    beam: Positive = 1.0
    beam_angle: Positive = 20.0
    overlap: Positive = 4.0


class DirtSensorConfig(Frozen):
    """The dirt sensor in the intake: it counts grains, ug each, up to ``most`` per second."""

    grain: Positive = 50.0
    most: Annotated[float, Field(gt=0.0, le=65535.0)] = 2550.0


class CameraConfig(Frozen):
    """The pan camera; ``horizontal_field`` and ``max_pan`` in degrees, as in the report."""

    width: Annotated[int, Field(gt=0)] = 1024
    height: Annotated[int, Field(gt=0)] = 768
    horizontal_field: Annotated[float, Field(gt=10.0, lt=150.0)] = 75.0
    mount_forward: float = 0.15
    mount_height: Positive = 0.085
    max_pan: Positive = 30.0


class LocalizationConfig(Frozen):
    """Knowing where the robot is: how much motion and scans are trusted, and when not at all.

    Noises of way, side and wheels grow with the square root of the way (per sqrt(m)), that of turns
    with that of the turn, the gyro's with that of the time; deviations are standard ones, m;
    time-outs in s; evidence is the natural logarithm of how much likelier.
    """

    way_noise: Positive = 0.02
    side_noise: Positive = 0.005
    wheel_turn_noise: Positive = 0.012
    turn_noise: Positive = 0.01
    gyro_drift: Positive = 0.001
    beam_deviation: Positive = 0.03
    known_deviation: Positive = 0.06
    lost_deviation: Positive = 1.0
    least_beams: Annotated[int, Field(ge=1)] = 30
    scan_timeout: Positive = 0.5
    search_timeout: Positive = 30.0
    needed_evidence: Annotated[float, Field(gt=0.0, le=12.0)] = 8.0

    @model_validator(mode="after")
    def _deviations_in_order(self) -> LocalizationConfig:
        if self.known_deviation >= self.lost_deviation:
            raise ValueError(
                f"expected known_deviation below lost_deviation ({self.lost_deviation})"
            )
        return self


class ControlConfig(Frozen):
    """The position loop."""

    approach_deceleration: Positive = 0.5
    heading_gain: Positive = 4.0
    turn_in_place_angle: Annotated[float, Field(gt=0.0, lt=math.pi / 2)] = 0.9
    arrival_tolerance: Positive = 0.02
    restart_distance: Positive = 0.03
    turning_speed: Positive = 2.5
    stream_timeout: Positive = 0.15


class WalkConfig(Frozen):
    """Walking to a point: the path, the setpoint moving along it, and when to give up."""

    lookahead: Positive = 0.25
    clearance: Positive = 0.04
    tight_clearance: Positive = 0.01
    look_ahead: Positive = 0.5
    corner_speed: Positive = 0.25
    careful_speed: Positive = 0.15
    astray_timeout: Positive = 60.0
    arrival_tolerance: Positive = 0.03
    bump_radius: Positive = 0.06
    progress_timeout: Positive = 6.0
    max_replans: Annotated[int, Field(ge=0)] = 12
    max_ways_around: Annotated[int, Field(ge=0)] = 60
    blocked_wait: Positive = 10.0
    look_period: Positive = 1.0
    """s; from one look for a way around, while it waits, to the next."""
    off_path: Positive = 0.35
    """m; farther off its path the robot was carried or pushed, and plans anew."""
    carried: Positive = 1.0
    """m; a robot that finds itself farther from its last known place was carried: what it
    remembers of things is of another place. Of cleans as well."""
    least_progress: Positive = 0.05
    """m; coming nearer to the goal by less is no progress."""
    standstill: Positive = 0.03
    """m/s; slower than this the robot stands."""
    sharp_corner: Annotated[float, Field(gt=0.0, lt=math.pi / 2)] = 0.3
    """rad; at a sharper corner the setpoint waits for the robot; softer ones are cut."""
    corner_reached: Positive = 0.04
    """m; the setpoint goes on when the robot is as near to a sharp corner."""
    braking: Positive = 0.4
    """m/s2; before corners."""
    slowest: Positive = 0.08
    """m/s; never slower than this before the goal."""


class LookingAroundConfig(Frozen):
    """Driving by what is in sight while the place is not known: m, m/s, rad, rad/s, s."""

    speed: Positive = 0.25
    turning_speed: Positive = 1.5
    backing_speed: Positive = 0.1
    """Away from what it touched."""
    backing_time: Positive = 0.8
    clearance: Positive = 0.06
    """Between the body and all that is in sight."""
    tight_clearance: Positive = 0.02
    """The same where there is no other way to go."""
    longest_leg: Positive = 1.5
    shortest_leg: Positive = 0.15
    """Shorter legs are driven only where there is no longer one."""
    arrival_tolerance: Positive = 0.02
    """So near to where it goes, or to what is in its way, a leg has ended."""
    aimed: Positive = 0.08
    """Tolerance of the heading before it drives."""

    @model_validator(mode="after")
    def _legs_in_order(self) -> LookingAroundConfig:
        if self.shortest_leg > self.longest_leg:
            raise ValueError(f"expected shortest_leg of at most longest_leg ({self.longest_leg})")
        return self


class TrackingConfig(Frozen):
    """Following a path exactly, as cleaning does: m, s, rad."""

    sharp_corner: Annotated[float, Field(gt=0.0, lt=math.pi / 2)] = 0.35
    off_corner: Positive = 0.0015
    braking: Positive = 1.2
    reach: Positive = 0.12
    heading_gain: Positive = 5.0
    turning_speed: Positive = 2.5
    corner_turning: Positive = 2.0
    corner_acceleration: Positive = 5.0
    slowest_corner: Positive = 0.06
    longest_blend: Positive = 0.10
    """m; so far before and after a soft corner the heading changes at most."""
    aimed: Positive = 0.01
    arrival_tolerance: Positive = 0.003
    turn_in_place_angle: Annotated[float, Field(gt=0.0, lt=math.pi / 2)] = 0.6
    """rad; with a larger error of the heading it turns on the spot first."""
    turning_delay: NotNegative = 0.06
    """s; until the drive has the turning speed that it is told."""
    late_ticks: NotNegative = 2.0
    """Ticks; by so much the drive is expected to brake late."""
    slowest: Positive = 0.015
    """m/s and rad/s; slower than this drives do not turn reliably."""


class TimingConfig(Frozen):
    """How often the robot does what, headless and on ROS alike: s of its clock.

    ``scan_period``
        From one scan that the robot looks at to the next; those between are left out.
    ``map_period``
        From one look at a map that grows to the next.
    """

    tick: Positive = 0.05
    world_step: Positive = 0.025
    scan_period: Positive = 0.2
    map_period: Positive = 1.0

    @model_validator(mode="after")
    def _steps_fill_a_tick(self) -> TimingConfig:
        if not math.isclose(self.world_step * self.steps_per_tick, self.tick):
            raise ValueError(
                f"expected a tick of whole world steps ({self.world_step} s), got {self.tick} s"
            )
        return self

    @property
    def steps_per_tick(self) -> int:
        """World steps in a tick of the robot."""
        return max(1, round(self.tick / self.world_step))


class RobotConfig(Frozen):
    """All of ``configuration/robot.yaml``; every part has the shipped file's values by default."""

    body: BodyConfig = BodyConfig()
    brush: BrushConfig = BrushConfig()
    fan: FanConfig = FanConfig()
    battery: BatteryConfig = BatteryConfig()
    lidar: LidarConfig = LidarConfig()
    wheels: WheelsConfig = WheelsConfig()
    gyro: GyroConfig = GyroConfig()
    cliff: CliffConfig = CliffConfig()
    station: StationConfig = StationConfig()
    dirt_sensor: DirtSensorConfig = DirtSensorConfig()
    camera: CameraConfig = CameraConfig()
    localization: LocalizationConfig = LocalizationConfig()
    control: ControlConfig = ControlConfig()
    walk: WalkConfig = WalkConfig()
    looking_around: LookingAroundConfig = LookingAroundConfig()
    tracking: TrackingConfig = TrackingConfig()
    timing: TimingConfig = TimingConfig()

    @property
    def longest_silence(self) -> float:
        """Longest time-out of a stream of commands, s, with which the robot stands in time.

        Beside braking there is a tick in which the silence is noticed, and one in which the drive
        is told.
        """
        return self._silence(self.body.braking_time)

    def longest_silence_at(self, speed: float) -> float:
        """Return the same for a stream by which the robot drives at ``speed`` m/s at most."""
        return self._silence(speed / self.body.max_deceleration)

    def _silence(self, braking_time: float) -> float:
        return STANDSTILL_WITHIN - braking_time - 2.0 * self.timing.tick

    @model_validator(mode="after")
    def _stands_in_time(self) -> RobotConfig:
        longest = self.longest_silence
        for name, timeout in (
            ("body.command_timeout", self.body.command_timeout),
            ("control.stream_timeout", self.control.stream_timeout),
        ):
            if timeout > longest + 1e-6:
                raise ValueError(
                    f"expected {name} of at most {longest:.3f} s, got {timeout} s: of the "
                    f"{STANDSTILL_WITHIN} s to standstill braking takes "
                    f"{self.body.braking_time:.3f} s and two ticks {2.0 * self.timing.tick:g} s; "
                    "lower it, or brake harder (body.max_deceleration)"
                )
        return self

    @property
    def scan_stride(self) -> int:
        """Scans of the lidar from one that is looked at to the next."""
        return max(1, round(self.timing.scan_period * self.lidar.rate))

    @model_validator(mode="after")
    def _walks_arrive(self) -> RobotConfig:
        control, walk = self.control, self.walk
        if control.restart_distance > walk.arrival_tolerance:
            raise ValueError(
                f"expected control.restart_distance ({control.restart_distance}) of at most "
                f"walk.arrival_tolerance ({walk.arrival_tolerance}), else a robot between the two "
                "stands and no walk arrives: lower the first or raise the second"
            )
        if control.restart_distance < control.arrival_tolerance:
            raise ValueError(
                f"expected control.restart_distance ({control.restart_distance}) of at least "
                f"control.arrival_tolerance ({control.arrival_tolerance}): raise it"
            )
        return self


def load_robot_config(path: Path) -> RobotConfig:
    """Read ``configuration/robot.yaml`` or a file like it, but for its part ``simulation``.

    Raises :class:`ConfigError` with the reason.
    """
    raw = read_yaml(path)
    if isinstance(raw, dict):
        raw.pop(SIMULATION, None)
        raw = with_model(raw)
    return validated(RobotConfig, raw, f"{path}: ", UNKNOWN)
