"""Planning on a map whose walls are not quite in their places, as while a map is being made."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from roomba.geometry import Point, RoundObstacle
from roomba.grid import OccupancyMap
from roomba.planning.path.planner import NoPathError, Path, PathPlanner


class CarefulPathPlanner(PathPlanner):
    """Goes as near to walls as the tight clearance only if no path exists that keeps more.

    A map draws round or oblique surfaces up to two fifths of a cell behind their true places. The
    shortest path with tight clearance, along the drawn surface, would then lead through the true
    one.
    """

    def __init__(
        self,
        map: OccupancyMap,
        body_radius: float,
        clearance: float,
        careful_clearance: float,
        tight_clearance: float,
    ) -> None:
        """Take three distances from walls, m: wanted, kept if any path does, and still accepted.

        Raises ValueError if one of them is larger than the one before.
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

        A body that stands nearer to a wall first leaves it by the shortest way. All else is as in
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
