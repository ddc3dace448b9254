"""scikit-fmm: fast marching; the any-angle distance of each cell from the start, and no path."""

from __future__ import annotations

import numpy as np
import skfmm

from roomba_bench.peers.paths.grids import grid_case
from roomba_bench.peers.protocol import Parameters, Work, once

DISTRIBUTION = "scikit-fmm"


def prepare(parameters: Parameters) -> Work:
    """Mask the closed cells."""
    fits, start, goal = grid_case(parameters)
    front = np.ones(fits.shape)
    front[start] = -1.0
    masked = np.ma.array(front, mask=~fits)  # type: ignore[no-untyped-call]
    speed = np.ones(fits.shape)

    def plan() -> float:
        return float(skfmm.travel_time(masked, speed)[goal])

    return Work(once(plan), {"length": plan()})
