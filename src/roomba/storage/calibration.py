"""Keeps between runs what a robot measured of its own errors, in YAML."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import numpy as np
import yaml
from pydantic import Field, ValidationError

from roomba.errors import RoombaError
from roomba.files.kept import KeptFileError, read_kept, write_kept
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
    write_kept(path, f"# {_COMMENT}\n{text}".encode())


def load_calibration(path: Path, tell: Callable[[str], object]) -> Calibration | None:
    """Return the calibration that was kept; None if there is none.

    A damaged file is set aside, the one before it is used, and ``tell`` is told so. Raises
    CalibrationError if there is none that can be used, so that the robot measures anew.
    """
    try:
        return read_kept(path, _parsed, tell)
    except KeptFileError as error:
        raise CalibrationError(f"{error}; the robot measures itself anew") from error


def _parsed(content: bytes) -> Calibration:
    try:
        file = _CalibrationFile.model_validate(load_yaml(content.decode("utf-8")))
        calibration = Calibration(
            np.array(file.errors),
            np.array(file.covariance),
            np.array(file.applied),
            file.windows,
            file.base,
        )
    except (yaml.YAMLError, ValidationError, ValueError) as cause:
        raise CalibrationError(f"expected a kept calibration ({_first_line(cause)})") from cause
    if not calibration.is_sensible:
        raise CalibrationError("expected a kept calibration, got numbers that are none of a robot")
    return calibration


def _first_line(cause: Exception) -> str:
    return str(cause).splitlines()[0]
