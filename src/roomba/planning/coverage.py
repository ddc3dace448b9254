"""The coverage planner: one way for a round robot that sweeps all the floor it can get to.

Its stages: :mod:`~roomba.planning.coverage_floor` tells what floor can be swept,
:mod:`~roomba.planning.coverage_edges` goes along walls and furniture,
:mod:`~roomba.planning.coverage_swaths` sweeps the floor between them in straight parallel ways,
:mod:`~roomba.planning.coverage_order` puts these pieces in order, and
:mod:`~roomba.planning.coverage_connection` joins them to one way.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from roomba.grid import OccupancyMap
from roomba.planning.costmap import Mask, Point, RoundObstacle
from roomba.planning.coverage_connection import connected
from roomba.planning.coverage_edges import edges
from roomba.planning.coverage_floor import CoverageFloor
from roomba.planning.coverage_masks import sweep
from roomba.planning.coverage_order import Weights, ordered
from roomba.planning.coverage_plan import CoveragePlan
from roomba.planning.coverage_swaths import swaths
from roomba.planning.coverage_ways import net_over
from roomba.planning.path import NoPathError, NoPathReason

__all__ = ["CoverageFloor", "CoveragePlan", "CoveragePlanner"]

_PIECE = 6.0
"""Widths of the tool; edges can be left for swaths about this often."""


class CoveragePlanner:
    """Plans over one map for one body and one tool; all lengths in m, map frame."""

    def __init__(self, map: OccupancyMap, reach: float, tool_width: float) -> None:
        """Take the map, how far the middle keeps from all that is solid, and the tool's width.

        Raises ValueError for lengths that are not finite or not above 0.
        """
        self.floor = CoverageFloor.build(map, reach, tool_width)

    def plan(
        self,
        start: Point,
        end: Point | None = None,
        todo: Mask | None = None,
        obstacles: Iterable[RoundObstacle] = (),
        edges_only: bool = False,
    ) -> CoveragePlan:
        """Return a way from ``start``, to ``end`` if given, that sweeps what is to do.

        ``todo``, bool on ``floor.frame``, marks the floor to sweep, all by default; what cannot be
        reached does not count. ``obstacles`` are round things that the map does not show. With
        ``edges_only`` only the floor along walls and furniture is swept. Raises
        :class:`~roomba.planning.path.NoPathError` when the robot cannot move from the start, or
        not get to the end, and ValueError for a ``todo`` of another shape or numbers that are not
        finite.
        """
        floor = self.floor.with_obstacles(obstacles)
        if todo is not None and todo.shape != floor.frame.shape:
            raise ValueError(f"expected todo of shape {floor.frame.shape}, got {todo.shape}")
        seed = floor.cell_near(start)
        if seed is None:
            raise NoPathError(start, NoPathReason.START_BLOCKED, None)
        middles = floor.middles(start)
        goal = None
        if end is not None:
            goal = floor.cell_near(end)
            if goal is None or not middles[goal]:
                raise NoPathError(end, NoPathReason.GOAL_UNREACHABLE, None)
        need = floor.swept_from(middles)
        if todo is not None:
            need &= todo
        return self._planned(floor, middles, need, start, seed, end, goal, edges_only)

    def _planned(
        self,
        floor: CoverageFloor,
        middles: Mask,
        need: Mask,
        start: Point,
        seed: tuple[int, int],
        end: Point | None,
        goal: tuple[int, int] | None,
        edges_only: bool,
    ) -> CoveragePlan:
        window = _window(middles)
        origin = np.array([window[1].start, window[0].start], np.float64)
        middles = np.ascontiguousarray(middles[window])
        need = np.ascontiguousarray(need[window])
        resolution = floor.frame.resolution
        radius = floor.tool_width / 2 / resolution
        edge_pieces = edges(middles, need, radius, _PIECE * 2 * radius)
        swath_pieces: list[NDArray[np.float64]] = []
        if not edges_only:
            left = _left(need, edge_pieces, radius) & middles
            swath_pieces = swaths(left, middles, radius)
        net = net_over(middles)
        first = np.array([seed[1], seed[0]], np.float64) - origin
        last = None if goal is None else np.array([goal[1], goal[0]], np.float64) - origin
        pieces = ordered(net, edge_pieces + swath_pieces, first, last, Weights())
        line = connected(net, pieces, first, last)

        def metres(cells: NDArray[np.float64]) -> NDArray[np.float64]:
            corner = np.array([floor.frame.origin_x, floor.frame.origin_y])
            result: NDArray[np.float64] = corner + (cells + origin + 0.5) * resolution
            return result

        return CoveragePlan(
            _from_to(metres(line), start, end),
            tuple(metres(piece) for piece in swath_pieces),
            tuple(metres(piece) for piece in edge_pieces),
        )


def _window(mask: Mask) -> tuple[slice, slice]:
    """Return the smallest window with all true cells and a margin."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    margin = 40
    return (
        slice(max(int(rows[0]) - margin, 0), int(rows[-1]) + margin + 1),
        slice(max(int(columns[0]) - margin, 0), int(columns[-1]) + margin + 1),
    )


def _left(need: Mask, lines: list[NDArray[np.float64]], radius: float) -> Mask:
    """Return the needed cells that the lines do not sweep."""
    counts = np.zeros(need.shape, np.int16)
    for line in lines:
        sweep(counts, line, radius, 1)
    left: Mask = need & (counts == 0)
    return left


def _from_to(points: NDArray[np.float64], start: Point, end: Point | None) -> NDArray[np.float64]:
    """Return the points with exactly these ends."""
    ends = [np.array([start])]
    ends.append(points[1:] if math.dist(points[0], start) < 0.01 else points)
    if end is not None:
        if math.dist(ends[-1][-1] if len(ends[-1]) else start, end) < 0.01 and len(ends[-1]):
            ends[-1] = ends[-1][:-1]
        ends.append(np.array([end]))
    joined = np.concatenate(ends)
    kept = np.concatenate(([True], np.hypot(*np.diff(joined, axis=0).T) > 1e-9))
    result: NDArray[np.float64] = joined[kept]
    return result
