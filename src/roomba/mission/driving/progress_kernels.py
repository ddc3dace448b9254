"""How far a drive came on its path, and whether it stays near it, as compiled code tells it."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry, inner_part
from roomba.control.curve_kernels import Course

Rows = NDArray[np.void]
Row = Any
"""One row of an array, in a kernel."""

PROGRESS: Final = np.dtype(
    [
        ("at", "f8"),  # s; when it last came farther
        ("along", "f8"),  # m; how far along its path it was then
        ("leg", "i8"),
        ("recoveries", "i8"),  # in vain, one after the other
        # what does not change
        ("least", "f8"),  # m along the path; less is no progress
        ("leaves_trouble", "f8"),  # m of progress after which earlier recoveries count no more
    ]
)
"""What a drive remembers of its progress, one row."""


@inner_part
def along_of(track: Row, course: Course) -> float:
    """Return how far along its path a tracker, a row of TRACK, is, m."""
    length = course.stations[course.stations.size - 1]
    if track.done > 0.0 or course.sections.size == 0:
        return float(length)
    return float(min(max(track.along, 0.0), length))


@inner_part
def off_path(track: Row, course: Course, x: float, y: float) -> float:
    """Return how far a place is from the leg that a tracker is on, m."""
    first_x, first_y = course.points[0, 0], course.points[0, 1]
    if course.sections.size == 0:
        return math.hypot(x - first_x, y - first_y)
    first_x, first_y = course.points[track.leg, 0], course.points[track.leg, 1]
    way_x = course.points[track.leg + 1, 0] - first_x
    way_y = course.points[track.leg + 1, 1] - first_y
    share = ((x - first_x) * way_x + (y - first_y) * way_y) / (way_x * way_x + way_y * way_y)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(x - (first_x + share * way_x), y - (first_y + share * way_y))


@entry
def mark_progress(rows: Rows, along: float, leg: int, now: float) -> float:
    """Remember whether a drive came farther by a time, s; return for how long it has not."""
    progress = rows[0]
    if along > progress.along + progress.least or leg > progress.leg:
        progress.at, progress.leg = now, leg
        if along > progress.leaves_trouble:
            progress.recoveries = 0
        progress.along = max(along, progress.along)
    return float(now - progress.at)
