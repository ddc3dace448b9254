"""scikit-image: ``route_through_array``, minimum cost paths in Cython; it cuts corners."""

from __future__ import annotations

import numpy as np
from skimage.graph import route_through_array

from roomba_bench.peers.paths.grids import grid_case, path_facts
from roomba_bench.peers.protocol import Parameters, Work, once

DISTRIBUTION = "scikit-image"


def prepare(parameters: Parameters) -> Work:
    """Make the grid of costs; closed cells are negative."""
    fits, start, goal = grid_case(parameters)
    costs = np.where(fits, 1.0, -1.0)

    def plan() -> object:
        path, _ = route_through_array(costs, start, goal, fully_connected=True, geometric=True)
        return path

    return Work(once(plan), path_facts(fits, np.asarray(plan(), np.int64)))
