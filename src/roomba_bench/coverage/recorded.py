"""Coverage planners that come from no package index: what they planned, as recorded once.

The same evaluator judged them on the same maps, for a body that keeps 0.17 m and a tool of 0.20 m.
None was driven: each plan counts as driven without error. Planning times depend on the machine, so
they are in the README alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True)
class Recorded:
    """A planner's way over one map: %, path length by (area by width), and rad if recorded."""

    name: str
    coverage: float
    ratio: float
    turning: float | None = None


def _planner(name: str, figures: dict[str, tuple[float, ...]]) -> dict[str, Recorded]:
    return {home: Recorded(name, *values) for home, values in figures.items()}


_PLANNERS: Final = (
    _planner(
        "grid wavefront (PythonRobotics)",
        {"empty": (98.3, 0.98, 223), "lshape": (96.2, 0.99, 633), "apartment": (92.1, 0.96, 930)},
    ),
    _planner(
        "spiral spanning tree (PythonRobotics)",
        {"empty": (94.3, 0.94, 148), "lshape": (90.3, 0.91, 314), "apartment": (74.3, 0.77, 484)},
    ),
    _planner(
        "BSA (nobleo, C++)",
        {
            "empty": (98.5, 0.98, 151),
            "lshape": (96.7, 1.00, 352),
            "apartment": (92.6, 1.07, 619),
            "small_house": (93.8, 1.02),
            "lab_ipa": (89.7, 1.03),
            "freiburg79": (88.4, 1.06),
        },
    ),
    _planner(
        "energy functional (ipa, C++)",
        {
            "empty": (98.0, 0.98, 151),
            "lshape": (96.4, 1.06, 312),
            "apartment": (95.9, 1.29, 931),
            "small_house": (95.2, 1.07),
            "freiburg79": (93.3, 1.28),
        },
    ),
    _planner(
        "boustrophedon (ipa, C++)",
        {
            "empty": (99.9, 1.04, 158),
            "lshape": (97.5, 1.40, 345),
            "apartment": (98.2, 1.41, 589),
            "small_house": (97.4, 1.57),
            "lab_ipa": (95.6, 1.66),
            "freiburg79": (96.2, 1.60),
        },
    ),
    _planner(
        "Fields2Cover 2.1 (C++)",
        {
            "empty": (99.3, 1.03, 154),
            "lshape": (98.7, 1.25, 931),
            "apartment": (98.8, 1.36, 1116),
            "small_house": (99.0, 1.39),
            "lab_ipa": (97.9, 1.55),
            "freiburg79": (98.4, 1.62),
        },
    ),
)

FAILED: Final = MappingProxyType({"lab_ipa": ("energy functional (ipa, C++)",)})
"""Planners that found no way over a map, and why."""
NOTE: Final = "as recorded, planned only"


def recorded(home: str) -> list[Recorded]:
    """Return the recorded plans for a map; empty for most."""
    return [planner[home] for planner in _PLANNERS if home in planner]
