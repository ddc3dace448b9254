"""How far a drive came on its path, as compiled code tells it."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.compilation import entry

Rows = NDArray[np.void]

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
