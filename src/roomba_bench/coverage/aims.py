"""The aims for each map; all cleans are driven closed loop, and judged by true poses."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

COVERAGE: Final = 99.5
"""%, with ideal sensors."""
NOISY_COVERAGE: Final = 99.0
MORE_BY_NOISE: Final = 0.08
"""The most by which noise may lengthen the way, as a factor of the least way."""
CLEAN: Final = 1.0
"""s of one core for the whole clean of the apartment."""
CHANGED_COVERAGE: Final = 98.0
"""%, of the floor that can truly be reached in a home that differs from its map."""


@dataclass(frozen=True)
class Aims:
    """The aims for one map, None without an aim: ratio, rad, and ms of planning."""

    ratio: float | None = None
    turning: float | None = None
    planning: float | None = None
    clean: float | None = None


_OF_MAPS: Final = MappingProxyType(
    {
        "empty": Aims(1.04, 160.0, 80.0),
        "lshape": Aims(1.12, 320.0, 100.0),
        "apartment": Aims(1.22, 600.0, 200.0, CLEAN),
        "small_house": Aims(1.17, planning=1000.0),
        "lab_ipa": Aims(1.26, planning=1000.0),
        "freiburg79": Aims(1.26, planning=1000.0),
        "lab_d": Aims(planning=1000.0),
        "lab_intel": Aims(planning=1000.0),
        "office_a": Aims(planning=3000.0),
    }
)


def aims_of(home: str) -> Aims:
    """Return the aims of a home or map by its name."""
    return _OF_MAPS.get(home, Aims())
