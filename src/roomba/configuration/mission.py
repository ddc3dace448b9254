"""Validated, frozen configuration of the mission: ``configuration/mission.yaml``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from roomba.configuration.frozen import Frozen, Positive, Ratio, load_config
from roomba.configuration.robot import BodyConfig
from roomba.errors import ConfigError


class DrivingConfig(Frozen):
    """Driving a path, and around what the map does not show: m, m/s, s."""

    speed: Positive = 0.30
    clearance: Positive = 0.005
    way_clearance: Positive = 0.04
    look_ahead: Positive = 0.15
    thing_clearance: Positive = 0.004
    off_path: Positive = 0.12
    backing_way: Positive = 0.08
    backing_speed: Positive = 0.10
    progress_timeout: Positive = 5.0
    most_recoveries: Annotated[int, Field(ge=1)] = 6
    felt_memory: Positive = 180.0


class CleaningConfig(Frozen):
    """Covering the floor: shares 0..1, m2."""

    enough: Ratio = 0.9965
    least_patch: Positive = 0.004
    least_while_growing: Positive = 0.5
    most_rounds: Annotated[int, Field(ge=0)] = 4
    dirty_times: Positive = 6.0


class ExploringConfig(Frozen):
    """Driving where the map is being made: m, m/s."""

    speed: Positive = 0.40
    clearance: Positive = 0.12
    tight_clearance: Positive = 0.02
    look_first: Positive = 10.0
    most_stuck: Annotated[int, Field(ge=0)] = 3


class EnergyConfig(Frozen):
    """When to go home for energy: shares of the capacity 0..1, Wh/m."""

    reserve: Ratio = 0.08
    margin: Positive = 1.3
    per_metre: Positive = 0.02
    full_enough: Ratio = 0.90
    least_to_start: Ratio = 0.15


class MissionConfig(Frozen):
    """All of ``configuration/mission.yaml``; the defaults are the shipped file's values."""

    driving: DrivingConfig = DrivingConfig()
    cleaning: CleaningConfig = CleaningConfig()
    exploring: ExploringConfig = ExploringConfig()
    energy: EnergyConfig = EnergyConfig()

    @property
    def top_speed(self) -> float:
        """The fastest that it wants to drive, m/s."""
        return max(self.driving.speed, self.exploring.speed)

    def require_possible(self, body: BodyConfig) -> None:
        """Raise ConfigError when a speed is more than a body can do."""
        for name, speed in (
            ("driving.speed", self.driving.speed),
            ("exploring.speed", self.exploring.speed),
        ):
            if speed > body.max_speed:
                raise ConfigError(
                    f"{name}: expected at most {body.max_speed:g} m/s, the robot's body.max_speed, "
                    f"got {speed:g}; lower it, or raise body.max_speed if the drive can do more"
                )


def load_mission_config(path: Path, body: BodyConfig) -> MissionConfig:
    """Read ``configuration/mission.yaml`` or a file like it; raises ConfigError with the reason.

    One of them is a speed that the ``body`` cannot do.
    """
    config = load_config(MissionConfig, path)
    try:
        config.require_possible(body)
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from error
    return config
