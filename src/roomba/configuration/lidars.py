"""Lidars as they are sold, by name: a file each in ``data/configuration/lidars``.

Under ``lidar`` a file has what the robot knows of it, under ``simulation`` its errors.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from roomba.configuration.frozen import read_yaml
from roomba.errors import ConfigError

LIDARS: Final = Path(__file__).resolve().parent.parent / "data" / "configuration" / "lidars"
"""A YAML file for each."""
LIDAR: Final = "lidar"
"""The part of a robot's file, of a lidar's file and of the simulation that is the lidar's."""
SIMULATION: Final = "simulation"
"""The part of a robot's file and of a lidar's file that is the simulator's; no brain reads it."""


def lidar_models() -> list[str]:
    """Return the names of all lidars that come along, sorted."""
    return sorted(path.stem for path in LIDARS.glob("*.yaml"))


def lidar_file(model: object) -> dict[str, dict[str, Any]]:
    """Return both parts of a lidar's file; raises ConfigError for a model that there is not."""
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
