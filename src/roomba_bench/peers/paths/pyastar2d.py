"""pyastar2d: A* in C++ over a grid of weights; it may cut corners."""

from __future__ import annotations

import numpy as np
import pyastar2d

from roomba_bench.peers.paths.grids import grid_case, path_facts
from roomba_bench.peers.protocol import Parameters, Work, once

DISTRIBUTION = "pyastar2d"


def prepare(parameters: Parameters) -> Work:
    """Make the grid of weights; closed cells are infinitely heavy."""
    fits, start, goal = grid_case(parameters)
    weights = np.where(fits, 1.0, np.inf).astype(np.float32)

    def plan() -> object:
        return pyastar2d.astar_path(weights, start, goal, allow_diagonal=True)

    return Work(once(plan), path_facts(fits, np.asarray(plan(), np.int64)))
