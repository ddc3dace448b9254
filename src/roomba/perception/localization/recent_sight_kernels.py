"""Keeping what was seen a moment ago, as compiled code does it: a ring of scans."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry

KEPT: Final = 12
"""Scans that are kept."""


class Sights(NamedTuple):
    """The newest scans, in a ring of KEPT.

    ``ring`` int64 [2] is the row of the next scan and the number of scans. In each row ``stamps``
    [KEPT] has its time, s, ``places`` [KEPT, 3] the pose of dead reckoning, and ``ends``
    [KEPT, beams, 4] its ends, of which the first ``counts`` [KEPT] count. Scans are kept that are
    ``apart``, s, or more.
    """

    ring: NDArray[np.int64]
    stamps: Floats
    places: Floats
    counts: NDArray[np.int64]
    ends: Floats
    apart: float


@entry
def note_sight(sights: Sights, stamp: float, place: Floats, ends: Floats, count: int) -> None:
    """Keep a scan, the first ``count`` of ``ends`` [n, 4], taken at a time, s, and a place [3]."""
    ring = sights.ring
    if ring[1] > 0:
        newest = sights.stamps[newest_of(ring, 0)]
        if stamp < newest:
            # The clock was set back.
            ring[1] = 0
        elif stamp - newest < sights.apart:
            return
    kept = ring[0]
    sights.stamps[kept], sights.counts[kept] = stamp, count
    for axis in range(3):
        sights.places[kept, axis] = place[axis]
    for row in range(count):
        for column in range(4):
            sights.ends[kept, row, column] = ends[row, column]
    ring[0] = (kept + 1) % KEPT
    ring[1] = min(ring[1] + 1, KEPT)


@entry
def newest_of(ring: NDArray[np.int64], number: int) -> int:
    """Return the row of the scan that came ``number`` scans before the newest one."""
    return int((ring[0] - 1 - number) % KEPT)
