"""What happened on a headless clean, exploration or walk."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.grid import OccupancyMap
from roomba.mission.cleaning.result import CleanResult
from roomba.mission.exploring.exploration import ExploreResult
from roomba.mission.walking.walk import WalkState, WalkStep
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.world.home.home import Home

_LONGEST_CLEAN: Final = 12 * 3600.0
_LONGEST_PER_AREA: Final = 150.0
"""s, and s more per m2 of floor: in all more than twice what an office of 1,476 m2 takes, which is
26 h with ten charges."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CleanRecord:
    """What happened on a clean.

    ``poses`` has rows of t (s), x, y (m), theta (rad), true ones, map frame; ``truth`` is the floor
    that the tool really passed over; ``planning`` is the wall time of all ``plans``, s.
    ``occupancy`` is the map in the end; ``whole_at`` is when it became whole, s: for a map that was
    whole from the beginning, the time of the end.
    """

    result: CleanResult
    poses: NDArray[np.float64]
    truth: CoverageMap
    hits: int
    distance: float
    turning: float
    planning: float
    plans: int
    occupancy: OccupancyMap
    whole_at: float


@dataclass(frozen=True, slots=True, eq=False)
class ExploreRecord:
    """What happened on an exploration: ``occupancy`` is the map in the end.

    ``poses``, true ones in the map frame, and ``believed`` have a row per tick: t (s), x, y (m),
    theta (rad).
    """

    result: ExploreResult
    occupancy: OccupancyMap
    poses: NDArray[np.float64]
    believed: NDArray[np.float64]
    hits: int
    wall: float
    """s of wall time that the exploration took."""


@dataclass(frozen=True, slots=True, eq=False)
class WalkRecord:
    """What happened on a walk: rows of ``poses`` are t (s), x, y (m), theta (rad), true ones.

    ``believed`` has the same rows with the poses that the robot believed; ``planned`` is its last
    path, float64 [n, 2], m.
    """

    state: WalkState
    reason: str
    duration: float
    planned: NDArray[np.float64]
    poses: NDArray[np.float64]
    believed: NDArray[np.float64]
    bumps: int
    steps: list[WalkStep] = field(repr=False)

    @property
    def distance(self) -> float:
        """Length of the way that the robot travelled, m."""
        return float(np.hypot(*np.diff(self.poses[:, 1:3], axis=0).T).sum())


def longest_errand(home: Home) -> float:
    """Return how long an errand can last, s: if it lasts longer, the program has a fault."""
    return _LONGEST_CLEAN + _LONGEST_PER_AREA * home.map.free_area


def require_end(spent: float, longest: float) -> None:
    """Raise RoombaError for an errand that has taken longer than the ``longest`` one, s."""
    if spent > longest:
        raise RoombaError(
            f"expected an errand to end within {longest / 3600.0:.0f} h of the robot's time, it is "
            "still under way; that is a fault of the program"
        )
