"""Percentiles of the figures of many runs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from roomba.commands.trials.figures import Figures

PERCENTS: Final = (0, 5, 50, 95, 100)
ROWS: Final[dict[str, tuple[str, str]]] = {
    "fraction": ("coverage, % of what the tool can reach", ".2f"),
    "path_ratio": ("path ratio", ".3f"),
    "coverable_m2": ("coverable floor, m²", ".1f"),
    "distance_m": ("distance, m", ".1f"),
    "turning_rad": ("turning, rad", ".0f"),
    "duration_s": ("robot time, s", ".0f"),
    "rate": ("m² a minute", ".2f"),
    "times_least": ("times the least time", ".2f"),
    "energy_wh": ("energy, Wh", ".2f"),
    "dirt_g": ("dirt, g", ".1f"),
    "hits": ("hits", ".0f"),
    "planning_s": ("planning, s", ".3f"),
    "wall_s": ("wall time, s", ".3f"),
    "times_real_time": ("times real time", ".0f"),
}
"""A figure's name with what a table calls it, and how it is written."""


def percentiles_of(figures: Iterable[Figures]) -> dict[str, dict[str, float]]:
    """Return for each figure its percentiles, by "p0", "p5" …; nothing of no runs."""
    found = list(figures)
    spread: dict[str, dict[str, float]] = {}
    for name in ROWS:
        values = [value for each in found if (value := getattr(each, name)) is not None]
        if values:
            numbers = np.percentile(np.array(values, np.float64), PERCENTS).tolist()
            spread[name] = {
                f"p{percent}": round(number, 6)
                for percent, number in zip(PERCENTS, numbers, strict=True)
            }
    return spread
