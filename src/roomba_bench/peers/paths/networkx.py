"""networkx: A* over a graph in plain Python, by our own rules; making the graph is free."""

from __future__ import annotations

import networkx
import numpy as np

from roomba_bench.peers.paths.grids import grid_case, links, path_facts
from roomba_bench.peers.protocol import LeftOutError, Parameters, Work, once

DISTRIBUTION = "networkx"

_MOST_CELLS = 200_000


def prepare(parameters: Parameters) -> Work:
    """Make the graph."""
    fits, start, goal = grid_case(parameters)
    if fits.size > _MOST_CELLS:
        raise LeftOutError(f"a graph of {fits.size} cells takes minutes and gigabytes to make")
    first, second, cost = links(fits)
    graph = networkx.Graph()
    graph.add_weighted_edges_from(zip(first.tolist(), second.tolist(), cost.tolist(), strict=True))
    columns = fits.shape[1]
    source, target = start[0] * columns + start[1], goal[0] * columns + goal[1]

    def estimate(here: int, there: int) -> float:
        up = abs(here // columns - there // columns)
        right = abs(here % columns - there % columns)
        return float(max(up, right) + (2.0**0.5 - 1.0) * min(up, right))

    def plan() -> list[int]:
        path: list[int] = networkx.astar_path(graph, source, target, estimate)
        return path

    numbers = np.array(plan())
    cells = np.column_stack([numbers // columns, numbers % columns])
    return Work(once(plan), path_facts(fits, cells))
