"""Numbers of the sensors as the robot knows them, and of the station that they look for.

Lidars as they are sold have a file each, by name, in ``data/configuration/lidars``: under ``lidar``
what the robot knows of it, under ``simulation`` its errors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final

from pydantic import Field, model_validator

from roomba.configuration.frozen import (
    Degrees,
    Duration,
    Frozen,
    Length,
    NotNegative,
    Positive,
    read_yaml,
)
from roomba.errors import ConfigError

LIDARS: Final = Path(__file__).resolve().parent.parent / "data" / "configuration" / "lidars"
"""The folder with a YAML file for each lidar."""
EXACT_LIDAR: Final = "ideal_12m"
"""The lidar for figures that must not depend on one: exact to some mm, all beams at once."""
LIDAR: Final = "lidar"
"""The part of a robot's file, of a lidar's file and of the simulation that is the lidar's."""
Range = Annotated[float, Field(ge=1e-6, le=1000.0)]
"""m; of a lidar."""
HalfCircle = Annotated[float, Field(gt=0.0, le=180.0)]
"""Degrees."""
SIMULATION: Final = "simulation"
"""The part of a robot's file and of a lidar's file that is the simulator's; no brain reads it."""


class LidarConfig(Frozen):
    """The lidar: beams evenly spaced, counter-clockwise; ranges in m, times in s.

    With a ``field`` of 360 degrees beam 0 points ahead, with a smaller one the middle of the field
    does. The lidar takes ``sweep_time`` from its first beam to where a next one would be; with 0
    all are measured at once. It sits ``mount_ahead`` of the middle between the wheels. ``model`` is
    the file of ``data/configuration/lidars`` whose numbers stand for what is not given.
    """

    model: str = "lds_02"
    beams: Annotated[int, Field(ge=8, le=4096)] = 360
    field: Annotated[float, Field(ge=10.0, le=360.0)] = 360.0
    min_range: Range = 0.16
    max_range: Range = 8.0
    rate: Annotated[float, Field(ge=0.5, le=100.0)] = 5.0
    sweep_time: NotNegative = 0.2
    mount_height: Length = 0.085
    mount_ahead: Annotated[float, Field(ge=-0.3, le=0.3)] = 0.0

    in_order: ClassVar[tuple[str, ...]] = ("min_range < max_range",)

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
            raise ValueError(
                f"expected a sweep_time of at most 1 / rate ({1.0 / self.rate:g} s), "
                f"got {self.sweep_time:g} s"
            )
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
    radius: Length = 0.155


class StationConfig(Frozen):
    """What the charging station sends out: a halo, and two beams that overlap; m and degrees.

    A station that sends out nothing is found by its place on the map alone.
    """

    has_beams: bool = True
    empties: bool = False
    """Whether it takes the dirt out of the robot's bin into a bag of its own."""
    halo: Length = 0.6
    beam: Length = 1.0
    beam_angle: HalfCircle = 20.0
    overlap: HalfCircle = 4.0


class DirtSensorConfig(Frozen):
    """The dirt sensor in the intake: it counts grains, ug each, up to ``most`` per second.

    The rate that it tells is that of the last ``window`` s.
    """

    grain: Positive = 50.0
    most: Annotated[float, Field(gt=0.0, le=65535.0)] = 2550.0
    window: Duration = 0.1


class CameraConfig(Frozen):
    """The pan camera; ``horizontal_field`` and ``max_pan`` in degrees, as in the report."""

    width: Annotated[int, Field(gt=0, le=8192)] = 1024
    height: Annotated[int, Field(gt=0, le=8192)] = 768
    horizontal_field: Annotated[float, Field(gt=10.0, lt=150.0)] = 75.0
    mount_forward: Annotated[float, Field(ge=-1.0, le=1.0)] = 0.15
    mount_height: Length = 0.085
    max_pan: HalfCircle = 30.0


def lidar_models() -> list[str]:
    """Return the names of all lidars that come along, sorted."""
    return sorted(path.stem for path in LIDARS.glob("*.yaml"))


def lidar_file(model: object) -> dict[str, dict[str, Any]]:
    """Return both parts of a lidar's file; raises ConfigError for an unknown model."""
    if model not in lidar_models():
        raise ConfigError(
            f"lidar.model: expected one of {', '.join(lidar_models())}, got {model!r}"
        )
    found: dict[str, dict[str, Any]] = read_yaml(LIDARS / f"{model}.yaml")
    return found


def with_model(raw: Mapping[str, Any]) -> dict[str, Any]:
    """Return a robot's file with all numbers of its lidar's model, but for those that it has.

    The lidar's errors are filled in where the file has a part ``simulation``. Raises ConfigError
    for a model that there is not.
    """
    own, simulation = raw.get(LIDAR), raw.get(SIMULATION)
    if not isinstance(own, Mapping) or "model" not in own:
        return dict(raw)
    model = lidar_file(own["model"])
    filled = {**raw, LIDAR: {**model[LIDAR], **own}}
    if isinstance(simulation, Mapping):
        errors = simulation.get(LIDAR, {})
        if isinstance(errors, Mapping):
            filled[SIMULATION] = {**simulation, LIDAR: {**model[SIMULATION], **errors}}
    return filled
