"""All numbers of the robot as it knows itself, read from ``configuration/robot.yaml``.

What is true of a simulated robot, and unknown to its brain, is in ``configuration/simulation.py``.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final

from pydantic import model_validator

from roomba.configuration.body import (
    BatteryConfig,
    BodyConfig,
    BrushConfig,
    FanConfig,
    HealthConfig,
)
from roomba.configuration.frozen import Frozen, Period, read_yaml, validated
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.loops import (
    ControlConfig,
    LookingAroundConfig,
    TrackingConfig,
    WalkConfig,
)
from roomba.configuration.sensors import (
    SIMULATION,
    CameraConfig,
    CliffConfig,
    DirtSensorConfig,
    GyroConfig,
    LidarConfig,
    StationConfig,
    WheelsConfig,
    with_model,
)

UNKNOWN: Final = "unknown; what is true of the simulated robot alone stands under simulation:"
"""What is said of a key that a robot's file must not have."""
STANDSTILL_WITHIN: Final = 0.5
"""s; the robot must stand within this after its commands end, for any reason."""


class TimingConfig(Frozen):
    """How often the robot does what, headless and on ROS alike: s of its clock.

    ``scan_period``
        From one scan that the robot looks at to the next; those between are left out.
    ``map_period``
        From one drawing of a map that grows to the next.
    """

    tick: Period = 0.05
    world_step: Period = 0.025
    scan_period: Period = 0.2
    map_period: Period = 1.0

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
    health: HealthConfig = HealthConfig()
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

    @model_validator(mode="after")
    def _brush_fits(self) -> RobotConfig:
        if self.brush.width > self.body.diameter:
            raise ValueError(
                f"expected brush.width of at most body.diameter ({self.body.diameter} m), got "
                f"{self.brush.width} m: it cleans no floor beside the body"
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
