"""Planning on a map whose walls are not quite where they stand, as one is that is being made."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from roomba.geometry import Point, RoundObstacle
from roomba.grid import OccupancyMap
from roomba.planning.path.planner import NoPathError, Path, PathPlanner


class CarefulPathPlanner(PathPlanner):
    """Goes as near to walls as the tight clearance only where no way leads that keeps more.

    A drawn map has a surface that is round or lies aslant up to two fifths of a cell behind where
    it stands: the shortest of the tight ways, which lies along that, would be one through it.
    """

    def __init__(
        self,
        map: OccupancyMap,
        body_radius: float,
        clearance: float,
        careful_clearance: float,
        tight_clearance: float,
    ) -> None:
        """Take the distances wanted, kept wherever any way does, and the least one accepted, m.

        Raises ValueError unless they are in order, none larger than the one before.
        """
        super().__init__(map, body_radius, clearance, tight_clearance)
        if not clearance >= careful_clearance >= tight_clearance:
            raise ValueError(
                f"expected a careful_clearance of {tight_clearance} to {clearance} m, "
                f"got {careful_clearance} m"
            )
        self._home = map, body_radius, clearance, careful_clearance

    def plan(self, start: Point, goal: Point, obstacles: Iterable[RoundObstacle] = ()) -> Path:
        """Return the shortest path that keeps the careful clearance, or else the tight one.

        A body that is nearer to a wall first leaves it by the shortest way; all else as
        :meth:`roomba.planning.path.planner.PathPlanner.plan`.
        """
        among = list(obstacles)
        try:
            return self._careful.plan(start, goal, among)
        except NoPathError:
            return super().plan(start, goal, among)

    @cached_property
    def _careful(self) -> PathPlanner:
        return PathPlanner(*self._home)
