"""The measures by which runs are compared: figures in the rows of the results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

COMPLETED: Final = "completed"
"""1 for a run that cleaned all and docked; 0 for any other, also for one without figures."""


@dataclass(frozen=True, slots=True)
class Measure:
    """A figure's name in a table, with its unit, and the digits that are written."""

    label: str
    digits: int
    scale: float = 1.0


MEASURES: Final = {
    COMPLETED: Measure("completed, % of runs", 1, 100.0),
    "fraction": Measure("coverage, % of what the tool can reach", 3, 100.0),
    "duration_s": Measure("robot time, s", 1),
    "distance_m": Measure("distance, m", 2),
    "turning_rad": Measure("turning, rad", 1),
    "path_ratio": Measure("path ratio", 4),
    "energy_wh": Measure("energy, Wh", 3),
    "dirt_g": Measure("dirt, g", 2),
    "hits": Measure("hits", 2),
    "odometry_error": Measure("error of wheels and gyro, m per m", 5),
    "planning_s": Measure("planning, s of wall time", 3),
    "wall_s": Measure("wall time, s", 3),
}
"""By the name of the figure in a row."""
DEFAULT_MEASURES: Final = (
    COMPLETED, "fraction", "duration_s", "distance_m", "turning_rad", "energy_wh", "dirt_g", "hits",
)  # fmt: skip


def value_of(row: Mapping[str, Any], measure: str) -> float | None:
    """Return a row's value of a measure; None where there is none."""
    figures = row["figures"]
    if measure == COMPLETED:
        return float(figures is not None and is_completed(figures))
    value = None if figures is None else figures.get(measure)
    return None if value is None else float(value)


def is_completed(figures: Mapping[str, Any]) -> bool:
    """Whether a run did all, and stands on its station."""
    return figures["outcome"] == "COMPLETED" and bool(figures["docked"])
