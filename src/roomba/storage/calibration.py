"""Keeps between runs what a robot measured of its own errors, in YAML."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
import yaml
from pydantic import Field, ValidationError

from roomba.errors import RoombaError
from roomba.files.atomic import write_whole
from roomba.files.bounded import read_text
from roomba.files.damaged import set_aside
from roomba.files.plain_yaml import load_yaml
from roomba.perception.calibration.calibration import Calibration
from roomba.storage.map_bound import Entry, yaml_text

_COMMENT = (
    "What the robot measured of its wheels (way, turn, drift), gyro and lidar (ahead, left, "
    "turned): shares, rad/m, m, rad."
)


class _CalibrationFile(Entry):
    errors: list[float]
    covariance: list[list[float]]
    applied: list[float]
    windows: Annotated[int, Field(ge=0)]
    base: Annotated[float, Field(ge=0.0, le=10.0)]


class CalibrationError(RoombaError):
    """A file of a calibration that cannot be used; the message names it, and where it is now."""


def save_calibration(calibration: Calibration, path: Path) -> None:
    """Write a calibration, atomically. Raises OSError when the disk refuses."""
    text = yaml_text(
        {
            "errors": calibration.errors.tolist(),
            "covariance": calibration.covariance.tolist(),
            "applied": calibration.applied.tolist(),
            "windows": calibration.windows,
            "base": calibration.base,
        }
    )
    write_whole(path, f"# {_COMMENT}\n{text}".encode())


def load_calibration(path: Path) -> Calibration | None:
    """Return the calibration that was kept; None if there is none.

    A damaged file is set aside, so that the robot measures anew: raises CalibrationError.
    """
    try:
        text = read_text(path)
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as cause:
        raise CalibrationError(_set_aside(path, str(cause))) from cause
    try:
        file = _CalibrationFile.model_validate(load_yaml(text))
        calibration = Calibration(
            np.array(file.errors),
            np.array(file.covariance),
            np.array(file.applied),
            file.windows,
            file.base,
        )
    except (yaml.YAMLError, ValidationError, ValueError) as cause:
        raise CalibrationError(_set_aside(path, str(cause).splitlines()[0])) from cause
    if not calibration.is_sensible:
        raise CalibrationError(_set_aside(path, "its numbers are none of a robot"))
    return calibration


def _set_aside(path: Path, why: str) -> str:
    return (
        f"{path}: expected a kept calibration ({why}); {set_aside(path)}, and the robot measures "
        "itself anew"
    )
