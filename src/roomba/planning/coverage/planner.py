"""The coverage planner: one way for a round robot that sweeps all the floor it can reach.

Its stages: :mod:`~roomba.planning.coverage.floor.floor` tells what floor can be swept,
:mod:`~roomba.planning.coverage.passes.edges` goes along walls and furniture,
:mod:`~roomba.planning.coverage.passes.swaths` sweeps the floor between them in straight parallel
ways, :mod:`~roomba.planning.coverage.tour.order` puts these pieces in order,
:mod:`~roomba.planning.coverage.tour.connection` joins them to one way,
:mod:`~roomba.planning.coverage.tour.polish` makes that shorter and straighter, and
:mod:`~roomba.planning.coverage.tour.rounding` puts bends in place of its sharp corners. All but the
first can be replaced: :class:`~roomba.planning.coverage.stages.CoverageStages`.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable
from contextlib import AbstractContextManager
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask, Polyline
from roomba.configuration.coverage import CoverageConfig
from roomba.geometry import Point, RoundObstacle
from roomba.grid import OccupancyMap
from roomba.planning.coverage.floor.floor import CoverageFloor
from roomba.planning.coverage.floor.masks import way_fits
from roomba.planning.coverage.ground import Ground
from roomba.planning.coverage.passes.sweep import unswept
from roomba.planning.coverage.plan import CoveragePlan
from roomba.planning.coverage.stages import OUR_STAGES, CoverageStages
from roomba.planning.coverage.tour.connection import tidy
from roomba.planning.path.planner import NoPathError, NoPathReason

__all__ = ["CoverageFloor", "CoveragePlan", "CoveragePlanner"]


_OFF_MIDDLES = 0.2
"""cells; shift of a swath. The tool is a whole number of cells wide, so that seams would lie on the
middles of cells, where the least error of the drive leaves a whole row unswept."""


UNWATCHED: Final = contextlib.nullcontext()
"""The context of plans that nothing counts."""


class CoveragePlanner:
    """Plans over one map for one body and one tool; all lengths in m, map frame."""

    def __init__(
        self,
        map: OccupancyMap,
        reach: float,
        tool_width: float,
        sharp_corner: float,
        config: CoverageConfig,
        stages: CoverageStages = OUR_STAGES,
        watch: AbstractContextManager[object] = UNWATCHED,
    ) -> None:
        """Take the map, the distance that the middle keeps from solid things, and the tool's width.

        At corners of more than ``sharp_corner``, rad, the robot turns on the spot. ``watch`` is
        entered for each plan, also one that fails, and may count them. Raises ValueError for
        lengths that are not finite or not above 0.
        """
        self._watch = watch
        self.floor = CoverageFloor.build(map, reach, tool_width, config)
        self._sharp_corner, self._config, self._stages = sharp_corner, config, stages
        self._ground: Ground | None = None

    def plan(
        self,
        start: Point,
        end: Point | None = None,
        todo: Mask | None = None,
        obstacles: Iterable[RoundObstacle] = (),
        edges_only: bool = False,
    ) -> CoveragePlan:
        """Return a way from ``start``, to ``end`` if given, that sweeps the floor to do.

        If the middle may not be at ``end``, the way ends at the nearest place where it may.
        ``todo``, bool on ``floor.frame``, marks the floor to sweep, all by default; floor that
        cannot be reached is left out. ``obstacles`` are round things not on the map. With
        ``edges_only`` only the floor along walls and furniture is swept. Raises
        :class:`~roomba.planning.path.planner.NoPathError` when the robot cannot leave the start or
        reach the end, and ValueError for a ``todo`` of another shape or numbers that are not
        finite.
        """
        if todo is not None and (todo.shape != self.floor.frame.shape or todo.dtype != np.bool_):
            raise ValueError(
                f"expected todo as bool of shape {self.floor.frame.shape}, "
                f"got {todo.dtype} of shape {todo.shape}"
            )
        with self._watch:
            return self._plan(start, end, todo, obstacles, edges_only=edges_only)

    def _plan(
        self,
        start: Point,
        end: Point | None,
        todo: Mask | None,
        obstacles: Iterable[RoundObstacle],
        *,
        edges_only: bool,
    ) -> CoveragePlan:
        ground, first = self._ground_from(start, obstacles)
        last = None
        if end is not None:
            last, end = _end_on(ground, end)
        need = ground.coverable if todo is None else ground.coverable & todo[ground.window]
        config, radius, stages = self._config, ground.radius, self._stages
        length = config.piece * 2 * radius
        edge_pieces = stages.edges(ground.rings, need, ground.middles, radius, length, config)
        swath_pieces: list[Polyline] = []
        if not edges_only:
            left = unswept(need, edge_pieces, radius) & ground.middles
            swath_pieces = [
                _off_middles(line, ground.middles)
                for line in stages.swaths(left, ground.middles, radius, config)
            ]
        pieces = stages.order(ground.net, edge_pieces + swath_pieces, first, last, config)
        line = stages.connection(ground.net, pieces, first, last)
        line = stages.polish(line, need, ground.middles, radius, config)
        line = stages.rounding(line, need, ground.middles, radius, self._sharp_corner, config)
        return CoveragePlan(
            _from_to(ground, line, start, end),
            tuple(ground.metres(piece) for piece in swath_pieces),
            tuple(ground.metres(piece) for piece in edge_pieces),
        )

    def rounded_off(self, start: Point, obstacles: Iterable[RoundObstacle] = ()) -> Mask:
        """Return the floor that could be swept, but that plans from ``start`` leave.

        Bool on ``floor.frame``. It lies in dips of slanted walls, past which plans go smoothly.
        Raises :class:`~roomba.planning.path.planner.NoPathError` as :meth:`plan` does.
        """
        ground, _ = self._ground_from(start, obstacles)
        left = np.zeros(self.floor.frame.shape, np.bool_)
        left[ground.window] = ground.rounded_off
        return left

    def _ground_from(
        self, start: Point, obstacles: Iterable[RoundObstacle]
    ) -> tuple[Ground, Floats]:
        """Return the ground around a start, and the place on it where the way begins.

        The last ground is cached: it is used again for the same obstacles and any start on it.
        """
        known = self._ground
        floor = (self.floor if known is None else known.floor).with_obstacles(obstacles)
        if not floor.obstacles:
            floor = self.floor
        seed = floor.cell_near(start)
        if seed is None:
            raise NoPathError(start, NoPathReason.START_BLOCKED, None)
        if known is None or known.floor is not floor or not known.holds(seed):
            known = Ground.around(floor, seed)
            self._ground = known
        return known, known.place_of(seed)


def _off_middles(line: Polyline, middles: Mask) -> Polyline:
    """Return a swath shifted a little, so that no seam between two lies on centres of cells.

    It is shifted to a side on which it fits, or not at all if there is none. Slanted swaths are not
    shifted: they overlap instead.
    """
    along = np.abs(line[-1] - line[0])
    if along.all():
        return line
    aside = np.array([0.0, _OFF_MIDDLES]) if along[0] >= along[1] else np.array([_OFF_MIDDLES, 0.0])
    sides: tuple[Polyline, Polyline] = line + aside, line - aside
    return next((moved for moved in sides if way_fits(middles, *moved.ravel().tolist())), line)


def _end_on(ground: Ground, end: Point) -> tuple[Floats, Point]:
    """Return the place where the way ends, and the point there, m: ``end``, if the middle may be
    there."""
    cell = ground.floor.cell_near(end)
    if cell is None or not ground.holds(cell):
        raise NoPathError(end, NoPathReason.GOAL_UNREACHABLE, None)
    frame = ground.floor.frame
    return ground.place_of(cell), end if cell == frame.cell_of(*end) else frame.centre_of(*cell)


def _from_to(ground: Ground, line: Polyline, start: Point, end: Point | None) -> Polyline:
    """Return the line in m, with exactly these ends and without redundant points."""
    ends = np.array([start] if end is None else [start, end], np.float64)
    places = ground.places(ends)
    if end is None and len(line) == 1:
        line = line[:0]
    points = ground.metres(tidy(ground.middles, np.concatenate((places[:1], line, places[1:]))))
    points[-1], points[0] = ends[-1] if end is not None else points[-1], ends[0]
    return points
