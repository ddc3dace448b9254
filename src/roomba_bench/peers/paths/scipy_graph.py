"""scipy: Dijkstra in C over a sparse graph, by the same rules as ours; making the graph is free.

It tells the optimal length independently of our own search.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from roomba_bench.peers.paths.grids import grid_case, links
from roomba_bench.peers.protocol import Parameters, Work, once

DISTRIBUTION = "scipy"


def prepare(parameters: Parameters) -> Work:
    """Make the graph."""
    fits, start, goal = grid_case(parameters)
    first, second, cost = links(fits)
    graph = coo_matrix((cost, (first, second)), shape=(fits.size, fits.size)).tocsr()
    source, target = (int(np.ravel_multi_index(cell, fits.shape)) for cell in (start, goal))

    def plan() -> float:
        return float(dijkstra(graph, directed=False, indices=source)[target])

    return Work(once(plan), {"length": plan(), "corners cut": 0.0})
