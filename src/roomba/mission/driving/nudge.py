"""Moving a piece of a path aside a little, from things that turn out to stand nearer to it.

Each look at a thing shows a bit more of it. A path along the thing is moved aside and kept, so that
the floor beside the thing gets clean without leaving the path and coming back another time.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.control.path_tracker import PathTracker
from roomba.geometry import RoundObstacle
from roomba.planning.coverage.floor.floor import CoverageFloor

_STEP: Final = 0.02
_AHEAD: Final = 1.0
"""m; the length of path that is moved, and its steps."""
_ROUNDS: Final = 8
_NEARLY: Final = 0.003
"""m; tolerance of the wanted distance."""


def nudged(
    tracker: PathTracker,
    floor: CoverageFloor,
    obstacles: Sequence[RoundObstacle],
    keep: float,
    most: float,
) -> Floats | None:
    """Return the rest of a path, float64 [n, 2], m, that keeps ``keep`` m from round things.

    ``floor`` tells where walls leave room. None when some of it would have to be moved by more than
    ``most`` m.
    """
    along, length = tracker.along, tracker.length
    last = min(along + _AHEAD, length)
    stations = np.append(np.arange(along, last, _STEP), last)
    course = tracker.course
    before = np.column_stack(
        [np.interp(stations, course.stations, course.points[:, axis]) for axis in (0, 1)]
    )
    things = _near(obstacles, before)
    if not len(things):
        return None
    points = _pushed(before, things, keep)
    moved = np.hypot(*(points - before).T)
    is_moved = moved > 1e-6
    has_room = _fits(floor, points) | ~is_moved
    # Where the moved piece joins the rest of the path, it must not have moved.
    if moved.max() > most or not has_room.all() or (last < length and is_moved[-1]):
        return None
    if (_too_near(points, things, keep)[0] > _NEARLY).any():
        return None
    rest: Floats = np.concatenate((points, course.points[course.stations > last]))
    return rest


def _near(obstacles: Sequence[RoundObstacle], points: Floats) -> Floats:
    """Return the round things, [n, 3], around the piece of a path."""
    things = np.array(obstacles, np.float64).reshape(-1, 3)
    low, high = points.min(axis=0) - 0.5, points.max(axis=0) + 0.5
    inside = ((things[:, :2] > low) & (things[:, :2] < high)).all(axis=1)
    near: Floats = things[inside]
    return near


def _pushed(points: Floats, things: Floats, keep: float) -> Floats:
    """Return points, each moved away from what it is nearest to as far as it takes."""
    points = points.copy()
    for _ in range(_ROUNDS):
        lack, nearest = _too_near(points, things, keep)
        if not (lack > 0.0).any():
            break
        away = points - things[nearest, :2]
        away /= np.maximum(np.hypot(*away.T), 1e-9)[:, None]
        points += away * np.maximum(lack, 0.0)[:, None]
    return points


def _too_near(points: Floats, things: Floats, keep: float) -> tuple[Floats, NDArray[np.int64]]:
    """Return by how much, m, each point is too near to the thing next to it, and which that is."""
    away = np.hypot(*(points[:, None, :] - things[None, :, :2]).transpose(2, 0, 1))
    lack = keep + things[:, 2] - away
    nearest = lack.argmax(axis=1)
    return lack[np.arange(len(points)), nearest], nearest


def _fits(floor: CoverageFloor, points: Floats) -> NDArray[np.bool_]:
    """Return at which points the body keeps away from walls."""
    frame = floor.frame
    rows, columns = frame.cells_of(points[:, 0], points[:, 1])
    rows, columns = np.clip(rows, 0, frame.rows - 1), np.clip(columns, 0, frame.columns - 1)
    return np.asarray(floor.fits[rows, columns])
