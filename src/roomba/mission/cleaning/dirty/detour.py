"""A detour over some floor, put into a path where the path comes nearest to that floor."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Final

import numpy as np

from roomba.arrays import Floats
from roomba.geometry import Point
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.path.planner import NoPathError
from roomba.planning.path.polyline import Path

PlanFrom = Callable[[Point], CoveragePlan]
"""Plans a way from a place over the floor and back there; raises NoPathError."""

_STEP: Final = 0.05
"""m between two points at which a path is looked at."""


def with_detour(
    points: Floats, floor: Floats, plan_from: PlanFrom, ahead: float, most: float
) -> Floats | None:
    """Return a path, float64 [n >= 2, 2], m, with a way over floor put in, or None.

    ``floor``, float64 [k >= 1, 2], m, are places of it. The detour branches off where the next
    ``ahead`` m of the path come nearest to them. If it is longer than ``most`` m from there, or a
    wall lets no way through, it branches off where the path begins. None if that is no better. A
    plan without length sweeps nothing.
    """
    path = Path(points)
    for station in dict.fromkeys((nearest_station(path, floor, ahead), 0.0)):
        with contextlib.suppress(NoPathError):
            plan = plan_from(path.point_at(station))
            if 0.0 < plan.length <= most:
                return _put_in(path, station, plan)
    return None


def nearest_station(path: Path, floor: Floats, ahead: float) -> float:
    """Return where in the first ``ahead`` m of a path it is nearest to places, [k >= 1, 2], m."""
    stations = np.arange(0.0, min(ahead, path.length) + _STEP, _STEP)
    x, y = (np.interp(stations, path.stations, path.points[:, axis]) for axis in (0, 1))
    away = np.hypot(x[:, None] - floor[:, 0], y[:, None] - floor[:, 1]).min(axis=1)
    return float(min(stations[np.argmin(away)], path.length))


def _put_in(path: Path, station: float, plan: CoveragePlan) -> Floats:
    """Return a path with a plan from there, and back, put in at a station, m."""
    before = path.points[path.stations < station]
    after = path.points[path.stations > station]
    return np.concatenate((before, plan.points, after))
