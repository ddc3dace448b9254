"""The figures of a run: plain values, for tables, files and other processes."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from roomba.time_spent import NOT_COUNTED, TimeSpent, square_metres_a_minute


@dataclass(frozen=True, slots=True)
class MissedShare:
    """Floor that was wanted and is not clean, as the robot tells it: m2, m, and why.

    ``code`` is the reason for programs, as of :func:`roomba.vocabulary.word_of`.
    """

    area_m2: float
    x: float
    y: float
    room: str
    reason: str
    code: str = ""


@dataclass(frozen=True, slots=True)
class Figures:
    """What a run achieved; each name ends with its unit.

    The figures are explained where they are written: :mod:`roomba.commands.sim.json_file`.

    ``calibration`` tells the errors that the robot measured of itself. ``wheels_error`` is the
    error of dead reckoning by the wheels alone, m per m of way, ``odometry_error`` that by wheels
    and gyro; None if the way is too short. ``calibrated_...`` are the same after correction by the
    calibration.
    """

    outcome: str
    message: str
    docked: bool
    duration_s: float
    wall_s: float
    planning_s: float
    plans: int
    distance_m: float
    turning_rad: float
    energy_wh: float
    dirt_g: float
    coverable_m2: float
    covered_m2: float
    tool_width_m: float
    hits: int
    missed: tuple[MissedShare, ...]
    times: TimeSpent = NOT_COUNTED
    bins_emptied: int = 0
    calibration: str = ""
    wheels_error: float | None = None
    calibrated_wheels_error: float | None = None
    odometry_error: float | None = None
    calibrated_error: float | None = None

    @property
    def is_completed(self) -> bool:
        """Whether all was done, and the robot stands on its station."""
        return self.outcome == "COMPLETED" and self.docked

    @property
    def fraction(self) -> float:
        """Share of the reachable floor that the tool passed over, 0..1."""
        return self.covered_m2 / self.coverable_m2 if self.coverable_m2 > 0.0 else 1.0

    @property
    def path_ratio(self) -> float | None:
        """Way driven by the least way: the reachable floor's area by the tool's width."""
        least = self.coverable_m2 / self.tool_width_m
        return self.distance_m / least if least > 0.0 else None

    @property
    def rate(self) -> float | None:
        """m2 that became clean in a minute of robot time; None where no time passed."""
        return square_metres_a_minute(self.covered_m2, self.duration_s)

    @property
    def times_least(self) -> float | None:
        """Time under way by the least time; charging and waiting are left out."""
        return self.times.times_least

    @property
    def times_real_time(self) -> float:
        """Robot time by wall time."""
        return self.duration_s / max(self.wall_s, 1e-9)

    def as_json(self) -> dict[str, Any]:
        """Return plain values; lengths to 0.1 mm, areas to 1 cm2."""
        ratio = self.path_ratio
        return {
            "outcome": self.outcome,
            "message": self.message,
            "docked": self.docked,
            "duration_s": round(self.duration_s, 3),
            "wall_s": round(self.wall_s, 4),
            "planning_s": round(self.planning_s, 4),
            "plans": self.plans,
            "rate_m2_a_minute": _rounded(self.rate),
            "times_least": _rounded(self.times_least),
            "times_s": {name: round(value, 3) for name, value in asdict(self.times).items()},
            "distance_m": round(self.distance_m, 4),
            "turning_rad": round(self.turning_rad, 4),
            "energy_wh": round(self.energy_wh, 4),
            "dirt_g": round(self.dirt_g, 4),
            "bins_emptied": self.bins_emptied,
            "coverable_m2": round(self.coverable_m2, 4),
            "covered_m2": round(self.covered_m2, 4),
            "fraction": round(self.fraction, 6),
            "path_ratio": None if ratio is None else round(ratio, 4),
            "hits": self.hits,
            "calibration": self.calibration,
            "wheels_error": _rounded(self.wheels_error),
            "calibrated_wheels_error": _rounded(self.calibrated_wheels_error),
            "odometry_error": _rounded(self.odometry_error),
            "calibrated_error": _rounded(self.calibrated_error),
            "missed": [
                {
                    "area_m2": round(each.area_m2, 4),
                    "x": round(each.x, 4),
                    "y": round(each.y, 4),
                    "room": each.room,
                    "reason": each.reason,
                }
                for each in self.missed
            ],
        }


def _rounded(number: float | None) -> float | None:
    """Return a number for a file."""
    return None if number is None else round(number, 6)
