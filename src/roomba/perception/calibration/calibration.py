"""The robot's errors as measured so far, as a value: to be shown, saved and restored."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.perception.calibration.state import AHEAD, DRIFT, ERRORS, GYRO, LEFT, TURN, TURNED, WAY

_TOLD: Final = 2.0
"""Standard deviations; an error is shown to people from this many of its own on."""
_MOST: Final = 0.5
_ROUNDING: Final = 1e-9
"""The limit of errors that a robot can have, and how far rounding puts a variance below 0."""


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """The measured ``errors``, float64 [ERRORS]: :mod:`roomba.perception.calibration.state`.

    ``covariance`` [ERRORS, ERRORS] is theirs; ``applied`` [ERRORS] are those that the robot is
    corrected by. ``windows`` is over how many windows they were measured, and ``base`` the
    configured distance of the wheels, m, 0 if not known.
    """

    errors: Floats
    covariance: Floats
    applied: Floats
    windows: int
    base: float

    @staticmethod
    def of(beliefs: NDArray[np.void]) -> Calibration:
        """Return the calibration of a BELIEF [1]."""
        row = beliefs[0]["calibration"]
        return Calibration(
            row["errors"].copy(),
            row["covariance"].copy(),
            row["applied"].copy(),
            int(row["windows"]),
            float(row["base"]),
        )

    def take_up(self, beliefs: NDArray[np.void]) -> None:
        """Replace the calibration of a BELIEF [1] by this one."""
        row = beliefs[0]["calibration"]
        row["errors"], row["covariance"], row["applied"] = (
            self.errors,
            self.covariance,
            self.applied,
        )
        row["base"] = row["base"] or self.base
        row["windows"], row["is_applied"] = self.windows, bool(self.applied[: GYRO + 1].any())
        # The window under way was measured with other corrections, and perhaps in another frame.
        row["is_open"] = False

    @property
    def deviations(self) -> Floats:
        """Standard deviations, float64 [ERRORS]."""
        deviations: Floats = np.sqrt(np.maximum(np.diag(self.covariance), 0.0))
        return deviations

    @property
    def is_sensible(self) -> bool:
        """Whether these can be numbers of a robot: finite, and no error as large as 0.5."""
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

        If the distance of the wheels is known, these are the errors of both radii and of the
        distance; else those of the odometry.
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

        Let the radii be (1 + l) and (1 + r) times the configured ones, and the distance b (1 + e).
        Then odometry's way is off by (l + r) / 2, its turn by (1 + (l + r) / 2) / (1 + e) - 1, and
        it drifts by (r - l) / (b (1 + e)).
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
