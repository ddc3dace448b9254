"""Validated, frozen configuration: ``config/robot.yaml`` and the seed's parameters."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from roomba.errors import ConfigError

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Ratio = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]

Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]

_Model = TypeVar("_Model", bound=BaseModel)

FASTEST_SPEED = 3.0
"""m/s; a `robot_max_speed` above this is a slip of the finger, not a robot for a home."""


class Frozen(BaseModel):
    """A part of a configuration: what it does not know it refuses."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


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
    command_timeout: Positive = 0.5

    @property
    def radius(self) -> float:
        """Radius of the body's disc, m."""
        return self.diameter / 2.0


class BrushConfig(Frozen):
    """Brushes and bin: what is picked up of the dirt that is driven over.

    One pass of the brush at full power picks up the share ``pickup``; with the fan see
    :func:`pickup_share`. Power in W, current in A.
    """

    width: Positive = 0.20
    depth: Positive = 0.05
    pickup: Ratio = 0.60
    carpet_pickup: Ratio = 0.45
    duty: Ratio = 1.0
    power: NotNegative = 3.0
    carpet_power: NotNegative = 6.0
    current_noise: NotNegative = 0.02
    noise_level: NotNegative = 58.0
    bin_capacity: Positive = 100.0


class FanConfig(Frozen):
    """The fan: suction, energy (W) and noise (dB(A) at 1 m) by its duty, 0..1."""

    pickup: Ratio = 0.83
    duty: Ratio = 0.60
    power: NotNegative = 25.0
    noise_level: NotNegative = 68.0


class BatteryConfig(Frozen):
    """The battery, and what everything draws from it: Wh, W, V, ohm, h, degrees Celsius."""

    capacity: Positive = 26.0
    nominal_voltage: Positive = 14.4
    resistance: NotNegative = 0.15
    idle_power: NotNegative = 5.3
    drive_power: NotNegative = 3.1
    drive_speed: Positive = 0.306
    stall_power: NotNegative = 15.0
    charge_hours: Positive = 2.2
    ambient: Annotated[float, Field(ge=-20.0, le=60.0)] = 22.0
    heating: NotNegative = 0.4
    heating_time: Positive = 900.0


class LidarConfig(Frozen):
    """The lidar: beams evenly all around, beam 0 ahead, counter-clockwise; ranges in m."""

    beams: Annotated[int, Field(ge=8, le=4096)] = 360
    min_range: Positive = 0.15
    max_range: Positive = 12.0
    rate: Positive = 10.0
    noise: NotNegative = 0.005
    misses: Ratio = 0.01
    mount_height: Positive = 0.085

    @model_validator(mode="after")
    def _ranges_in_order(self) -> LidarConfig:
        if self.min_range >= self.max_range:
            raise ValueError(f"expected min_range below max_range ({self.max_range})")
        return self


class WheelsConfig(Frozen):
    """Wheel encoders, and how wheels slip: shares of the way, and what varies, m/sqrt(m)."""

    counts_per_turn: Positive = 508.8
    scale_error: NotNegative = 0.001
    slip: Ratio = 0.001
    carpet_slip: Ratio = 0.02
    slip_noise: NotNegative = 0.002
    blocked_slip: Ratio = 0.3


class GyroConfig(Frozen):
    """The gyro about the vertical and the accelerometer ahead: rad/s, m/s2; walk rad/s/sqrt(s)."""

    noise: NotNegative = 0.0015
    bias: NotNegative = 0.0005
    bias_walk: NotNegative = 0.00002
    scale_error: NotNegative = 0.003
    acceleration_noise: NotNegative = 0.03


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
    position_tolerance: Positive = 0.015
    angle_tolerance: Positive = 8.0


class DirtSensorConfig(Frozen):
    """The dirt sensor in the intake: it counts grains, ug each, up to ``most`` per second."""

    grain: Positive = 50.0
    most: Annotated[float, Field(gt=0.0, le=65535.0)] = 2550.0


class CameraConfig(Frozen):
    """The pan camera; ``horizontal_field`` and ``max_pan`` in degrees as the seed's angles are."""

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
    stream_timeout: Positive = 0.3


class WalkConfig(Frozen):
    """Walking to a point: the path, the setpoint moving along it, and when to give up."""

    lookahead: Positive = 0.25
    clearance: Positive = 0.04
    tight_clearance: Positive = 0.01
    corner_speed: Positive = 0.25
    careful_speed: Positive = 0.15
    astray_timeout: Positive = 60.0
    arrival_tolerance: Positive = 0.03
    bump_radius: Positive = 0.06
    progress_timeout: Positive = 6.0
    max_replans: Annotated[int, Field(ge=0)] = 12


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
    aimed: Positive = 0.01
    arrival_tolerance: Positive = 0.003


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
    """All of ``config/robot.yaml``; every part has the shipped file's values by default.

    ``sensors``: "noisy" ones have the errors given here, and wheels slip; "ideal" ones tell the
    truth, and wheels slip by faults only.
    """

    sensors: Literal["ideal", "noisy"] = "noisy"
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
    tracking: TrackingConfig = TrackingConfig()
    timing: TimingConfig = TimingConfig()

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


def pickup_share(brush: float, fan: float) -> float:
    """Return the share that one pass picks up, of those that brush and fan would alone: 0..1."""
    return 1.0 - (1.0 - brush) * (1.0 - fan)


class SeedParameters(Frozen):
    """The original's parameters (see the README's table), validated; metres and m/s.

    Other spellings of the report (``initial_pos_x``, ``max_coordinate`` …) are accepted by
    :func:`parse_seed_parameters`.
    """

    robot_name: Annotated[str, Field(min_length=1, strict=True)] = "roomba_robot"
    robot_max_speed: Annotated[float, Field(gt=0.0, le=FASTEST_SPEED, allow_inf_nan=False)] = 0.5
    initial_post_x: Annotated[float, Field(allow_inf_nan=False)] = 0.0
    initial_post_y: Annotated[float, Field(allow_inf_nan=False)] = 0.0
    initial_post_theta: Annotated[float, Field(allow_inf_nan=False)] = 0.0
    min_cordinate: Annotated[float, Field(allow_inf_nan=False)] = -100.0
    max_cordinate: Annotated[float, Field(allow_inf_nan=False)] = 100.0

    @model_validator(mode="after")
    def _limits_in_order(self) -> SeedParameters:
        if self.min_cordinate >= self.max_cordinate:
            raise ValueError(
                f"min_cordinate ({self.min_cordinate}) must be below max_cordinate "
                f"({self.max_cordinate})"
            )
        return self

    def allows(self, x: float, y: float) -> bool:
        """Whether a point, m, is finite and within the limits of both coordinates."""
        return all(
            math.isfinite(value) and self.min_cordinate <= value <= self.max_cordinate
            for value in (x, y)
        )


SEED_SPELLINGS: dict[str, tuple[str, ...]] = {
    "robot_name": ("robot_name",),
    "robot_max_speed": ("robot_max_speed",),
    "initial_post_x": ("initial_post_x", "initial_pos_x"),
    "initial_post_y": ("initial_post_y", "initial_pos_y"),
    "initial_post_theta": ("initial_post_theta",),
    "min_cordinate": ("min_cordinate", "min_coordinate"),
    "max_cordinate": ("max_cordinate", "max_coordinate"),
}
"""Each parameter with the spellings that mean it, the first one its own."""


def parse_seed_parameters(values: dict[str, Any]) -> SeedParameters:
    """Return the validated parameters; what is missing has its default.

    ``values`` maps names, in any spelling of :data:`SEED_SPELLINGS`, to raw values. Another
    spelling counts before the parameter's own, which the launch file always sets.
    Raises :class:`ConfigError` with one line that names the parameter, its value and what is meant.
    """
    known: dict[str, Any] = {}
    for name, spellings in SEED_SPELLINGS.items():
        for spelling in spellings:
            if spelling in values:
                known[name] = values[spelling]
    for name, value in known.items():
        if name != "robot_name" and (isinstance(value, bool) or not isinstance(value, int | float)):
            raise ConfigError(f"parameter {name}: expected a number, got {value!r}")
    return _validated(SeedParameters, known, "parameter ")


def load_robot_config(path: Path) -> RobotConfig:
    """Read ``config/robot.yaml`` or a file like it; raises :class:`ConfigError` with the reason."""
    return load_config(RobotConfig, path)


def load_config(model: type[_Model], path: Path) -> _Model:
    """Read a file of some configuration; raises :class:`ConfigError` with the reason."""
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise ConfigError(f"{path}: cannot be read as YAML: {error}") from error
    return _validated(model, raw or {}, f"{path}: ")


def _validated(model: type[_Model], raw: Any, where: str) -> _Model:
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        first = error.errors()[0]
        name = ".".join(str(part) for part in first["loc"])
        reason = first["msg"].removeprefix("Value error, ")
        got = f", got {first['input']!r}" if name else ""
        raise ConfigError(f"{where}{name}: {reason}{got}".replace(": :", ":")) from error
