"""The progress of a drive on its path, in compiled code."""

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
        ("to_turn", "f8"),  # rad; the least that was left of a turn on the spot since then
        ("recoveries", "i8"),  # in vain, one after the other
        # what does not change
        ("timeout", "f8"),  # s without progress, after which it is held
        ("least", "f8"),  # m along the path; less is no progress
        ("least_turn", "f8"),  # rad of a turn on the spot; less is none either
        ("leaves_trouble", "f8"),  # m of progress after which earlier recoveries count no more
    ]
)
"""What a drive remembers of its progress, one row."""


@entry
def is_held(rows: Rows, along: float, leg: int, to_turn: float, now: float) -> bool:
    """Note the progress of a drive at ``now``, s; tell whether it made none for too long.

    ``to_turn`` is what is left of a turn on the spot, rad, infinite where it drives. A turn on the
    spot counts as progress as long as less and less of it is left, so not for ever.
    """
    progress = rows[0]
    if along > progress.along + progress.least or leg > progress.leg:
        progress.at, progress.leg, progress.to_turn = now, leg, np.inf
        if along > progress.leaves_trouble:
            progress.recoveries = 0
        progress.along = max(along, progress.along)
    elif to_turn < progress.to_turn - progress.least_turn:
        progress.at, progress.to_turn = now, to_turn
    return bool(now - progress.at > progress.timeout)
