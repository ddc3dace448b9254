"""What is known of the robot's errors, as a value: to be told, kept and taken up again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.perception.calibration.state import AHEAD, DRIFT, ERRORS, GYRO, LEFT, TURN, TURNED, WAY

_TOLD: Final = 2.0
"""Deviations from which on an error is told as one."""
_MOST: Final = 0.5
_ROUNDING: Final = 1e-9
"""The largest error that is one of a robot; and of a variance, what is none."""


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """``errors`` is float64 [ERRORS], as of :mod:`roomba.perception.calibration.state`.

    ``covariance`` is theirs, ``applied`` what of them the robot goes by. They were measured over so
    many ``windows``; ``base`` is what is told of the wheels' distance, m, 0 if nothing.
    """

    errors: Floats
    covariance: Floats
    applied: Floats
    windows: int
    base: float

    @staticmethod
    def of(beliefs: NDArray[np.void]) -> Calibration:
        """Return what a BELIEF [1] knows now."""
        row = beliefs[0]["calibration"]
        return Calibration(
            row["errors"].copy(),
            row["covariance"].copy(),
            row["applied"].copy(),
            int(row["windows"]),
            float(row["base"]),
        )

    def take_up(self, beliefs: NDArray[np.void]) -> None:
        """Let a BELIEF [1] go on with this, in place of what it knows."""
        row = beliefs[0]["calibration"]
        row["errors"], row["covariance"], row["applied"] = (
            self.errors,
            self.covariance,
            self.applied,
        )
        row["base"] = row["base"] or self.base
        row["windows"], row["is_applied"] = self.windows, bool(self.applied[: GYRO + 1].any())
        # What was under way was measured by other corrections, and perhaps in another frame.
        row["is_open"] = False

    @property
    def deviations(self) -> Floats:
        """Standard deviations, float64 [ERRORS]."""
        deviations: Floats = np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        return deviations

    @property
    def is_sensible(self) -> bool:
        """Whether these can be numbers of a robot: finite, and none is off by half."""
        arrays = (self.errors, self.covariance, self.applied)
        shapes = ((ERRORS,), (ERRORS, ERRORS), (ERRORS,))
        if any(each.shape != shape for each, shape in zip(arrays, shapes, strict=True)):
            return False
        is_finite = all(np.isfinite(each).all() for each in arrays)
        is_symmetric = bool(np.allclose(self.covariance, self.covariance.T))
        if not (is_finite and is_symmetric and self.windows >= 0):
            return False
        least = float(np.linalg.eigvalsh(self.covariance).min())
        small = np.abs(np.concatenate((self.errors, self.applied))).max() < _MOST
        return bool(small) and least > -_ROUNDING

    def told(self) -> list[tuple[str, float, float, str]]:
        """Return name, value, deviation and unit of each error, for people.

        Of wheels whose distance is known: both radii and the distance; else what the odometry does.
        """
        errors, deviations = self.errors, self.deviations
        rows = self._wheels() if self.base > 0.0 else self._odometry()
        rows.append(("gyro", 100.0 * errors[GYRO], 100.0 * deviations[GYRO], "%"))
        rows.append(("lidar ahead", 1e3 * errors[AHEAD], 1e3 * deviations[AHEAD], "mm"))
        rows.append(("lidar left", 1e3 * errors[LEFT], 1e3 * deviations[LEFT], "mm"))
        turned, deviation = math.degrees(errors[TURNED]), math.degrees(deviations[TURNED])
        rows.append(("lidar turned", turned, deviation, "°"))
        return [(name, float(value), float(unsure), unit) for name, value, unsure, unit in rows]

    def _odometry(self) -> list[tuple[str, Any, Any, str]]:
        errors, deviations = self.errors, self.deviations
        return [
            ("distance", 100.0 * errors[WAY], 100.0 * deviations[WAY], "%"),
            ("rotation", 100.0 * errors[TURN], 100.0 * deviations[TURN], "%"),
            ("drift", math.degrees(errors[DRIFT]), math.degrees(deviations[DRIFT]), "°/m"),
        ]

    def _wheels(self) -> list[tuple[str, Any, Any, str]]:
        """Return the errors of the left and the right wheel's radius, and of their distance.

        With radii (1 + l), (1 + r) and distance b (1 + e), in those that are told, odometry's way
        is off by (l + r) / 2, its turn by (1 + (l + r) / 2) / (1 + e) - 1, and it drifts by
        (r - l) / (b (1 + e)).
        """
        way, turn, drift = self.errors[:GYRO].tolist()
        base = (1.0 + way) / (1.0 + turn)
        half = 0.5 * self.base * base
        slopes = np.zeros((3, ERRORS))
        slopes[0, [WAY, DRIFT]], slopes[1, [WAY, DRIFT]] = (1.0, -half), (1.0, half)
        slopes[2, [WAY, TURN]] = 1.0 / (1.0 + turn), -base / (1.0 + turn)
        unsure = 100.0 * np.sqrt(np.diag(slopes @ self.covariance @ slopes.T))
        return [
            ("left wheel", 100.0 * (way - half * drift), unsure[0], "%"),
            ("right wheel", 100.0 * (way + half * drift), unsure[1], "%"),
            ("wheel distance", 100.0 * (base - 1.0), unsure[2], "%"),
        ]

    def __str__(self) -> str:
        """Return one line for people: what is off, and how sure that is."""
        if not self.windows:
            return "nothing was measured yet"
        parts = [
            f"{name} {value:+.{_digits(unit)}f} ± {unsure:.{_digits(unit)}f} {unit}"
            for name, value, unsure, unit in self.told()
            if abs(value) > _TOLD * unsure
        ]
        return ", ".join(parts) or "nothing is off by more than is sure"


def _digits(unit: str) -> int:
    return {"%": 2, "mm": 1}.get(unit, 2)
