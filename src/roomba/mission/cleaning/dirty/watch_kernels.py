"""The compiled check, made at each tick, of whether dirty floor may be close by."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats32, Mask
from roomba.clock import ROUNDING
from roomba.compilation import entry, part
from roomba.perception.swept.dirt_map import CELL, LEAST_WAY

WATCH: Final = np.dtype(
    [
        ("looked_at", "f8"),  # s; when dirty floor close by was looked for last
        ("measured_at", "f8"),  # s; when it was measured last how dirty floor usually is
        ("dirty_from", "f8"),  # grains/m2; from there on floor is dirty, as measured then
        # what does not change
        ("look_period", "f8"),  # s; from one look to the next
        ("measure_period", "f8"),  # s; from one measurement to the next
        ("reach", "f8"),  # m; so far off it is looked for
    ]
)
"""What a clean remembers of its looks for dirty floor, one row."""


@entry
def may_be_dirty(
    rows: NDArray[np.void],
    grains_of: Floats32,
    way_of: Floats32,
    done: Mask,
    place: NDArray[np.float64],
    x: float,
    y: float,
    now: float,
) -> bool:
    """Tell whether it is time to look closely for dirty floor near a place, m.

    That is when a cell close by, not yet ``done`` [rows, columns], is dirty, or it is to be
    measured anew how dirty floor usually is. Finding nothing close by counts as a look, too: the
    next one follows after a period. ``place`` is the dirt map's corner and cell, m.
    """
    watch = rows[0]
    if _is_recent(now, watch.looked_at, watch.look_period):
        return False
    if not _is_recent(now, watch.measured_at, watch.measure_period):
        return True
    cell, reach = place[2], watch.reach
    first_row = max(math.floor((y - reach - place[1]) / cell), 0)
    last_row = min(math.floor((y + reach - place[1]) / cell) + 1, grains_of.shape[0])
    first_column = max(math.floor((x - reach - place[0]) / cell), 0)
    last_column = min(math.floor((x + reach - place[0]) / cell) + 1, grains_of.shape[1])
    for row in range(first_row, last_row):
        for column in range(first_column, last_column):
            way = way_of[row, column]
            if done[row, column] or way <= LEAST_WAY:
                continue
            if grains_of[row, column] >= watch.dirty_from * way * CELL:
                return True
    watch.looked_at = now
    return False


@part
def _is_recent(now: float, heard: float, longest: float) -> bool:
    """Tell the same as :func:`roomba.clock.is_recent`."""
    return 0.0 <= now - heard < longest - ROUNDING
