"""The planner: the shortest way for a round body from one point to another, clear of all walls.

:class:`PathPlanner` keeps a comfortable distance from walls where there is room, and a tight one
where there is not. Its stages: :mod:`~roomba.planning.path.costmap` tells where the body fits, the
ends are joined to the cells that do, :mod:`~roomba.planning.path.search.grid_path` finds what
narrow places cannot be avoided, :mod:`~roomba.planning.path.search.any_angle` the shortest path
over the cells, and :mod:`~roomba.planning.path.string_pulling` makes it the shortest between the
walls.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Mask
from roomba.errors import RoombaError
from roomba.geometry import Point, RoundObstacle
from roomba.grid import GridFrame, OccupancyMap
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.joining import join_goal, join_start
from roomba.planning.path.polyline import Path
from roomba.planning.path.search.any_angle import AnyAngleSearch, FreeSpace, Joints
from roomba.planning.path.search.grid_path import GridSearch
from roomba.planning.path.string_pulling import StringPulling
from roomba.raster.regions import dilated

__all__ = ["NoPathError", "NoPathReason", "Path", "PathPlanner"]

_SAME = 1e-6
"""m; points of a path nearer to each other than this are one."""
_STRAIGHT = 1e-9
"""rad; a smaller bend counts as straight."""
_NEXT_DOOR = 4.0
"""cells; ends this near are joined straight, if that is legal, even where it is not comfortable."""
_OPENING = 5
"""cells; how wide the floor is opened along a narrow place that cannot be avoided."""


class NoPathReason(Enum):
    """Why there is no path."""

    GOAL_OFF_MAP = "the map ends before it"
    """The goal lies outside the map."""
    GOAL_IN_OBSTACLE = "the body does not fit there"
    """A wall, unknown cell or obstacle is nearer to the goal than body and tight clearance."""
    GOAL_UNREACHABLE = "no way leads there"
    """The body fits at the goal, but nowhere on the way: walls or narrow places lie between."""
    START_BLOCKED = "the body cannot move from where it stands"
    """No place near the start has room for the body and can be reached straight from there."""


class NoPathError(RoombaError):
    """There is no path: ``reason``, and the ``nearest`` point to the goal, m, that can be reached.

    ``nearest`` is None when nothing can be reached from the start.
    """

    def __init__(self, goal: Point, reason: NoPathReason, nearest: Point | None) -> None:
        """Take the goal, the reason, and the nearest point that can be reached."""
        text = f"({goal[0]:.2f}, {goal[1]:.2f}) cannot be reached: {reason.value}"
        if nearest is not None:
            text += f"; nearest reachable point: ({nearest[0]:.2f}, {nearest[1]:.2f})"
        super().__init__(text)
        self.reason = reason
        self.nearest = nearest


@dataclass(frozen=True, eq=False)
class _Room:
    """Where the body fits among the obstacles of the moment."""

    comfortable: FitMap
    tight: FitMap

    @cached_property
    def floor(self) -> FreeSpace:
        """The comfortable floor."""
        return FreeSpace.of(self.comfortable.fits)


class PathPlanner:
    """Plans over one map for one body; all lengths in m, map frame. Not for two threads at once."""

    def __init__(
        self, map: OccupancyMap, body_radius: float, clearance: float, tight_clearance: float
    ) -> None:
        """Take the map, the body, the distance wanted from walls, and the least one accepted.

        Raises ValueError unless ``body_radius`` > 0 and ``clearance`` >= ``tight_clearance`` >= 0.
        """
        if not clearance >= tight_clearance:
            raise ValueError(
                f"expected a clearance of tight_clearance ({tight_clearance} m) or more, "
                f"got {clearance} m"
            )
        self.frame: GridFrame = map.frame
        self._among_walls = _Room(
            FitMap.build(map, body_radius, clearance),
            FitMap.build(map, body_radius, tight_clearance),
        )
        self._among_obstacles = self._among_walls
        self._any_angle = AnyAngleSearch(map.frame.shape)
        self._string = StringPulling(self._among_walls.comfortable)
        self._grid = GridSearch()
        self._reachable: dict[frozenset[int], Mask] = {}

    def plan(self, start: Point, goal: Point, obstacles: Iterable[RoundObstacle] = ()) -> Path:
        """Return the shortest path from exactly ``start`` to exactly ``goal``.

        ``obstacles`` are round things that the map does not show. A body that does not fit at
        ``start`` first leaves by the shortest straight way to where it does. Raises
        :class:`NoPathError`, and ValueError for numbers that are not finite.
        """
        _check_finite("start", start)
        _check_finite("goal", goal)
        room = self._room(obstacles)
        start_joints = join_start(room.tight, start)
        if not self.frame.contains(*goal):
            raise self._refusal(room, start_joints, goal, NoPathReason.GOAL_OFF_MAP)
        goal_joints = join_goal(room.tight, goal)
        if goal_joints is None:
            raise self._refusal(room, start_joints, goal, NoPathReason.GOAL_IN_OBSTACLE)
        if not len(start_joints.legs):
            raise NoPathError(goal, NoPathReason.START_BLOCKED, None)
        if math.dist(start, goal) <= _NEXT_DOOR * self.frame.resolution and (
            room.tight.fits_along(start, goal)
        ):
            return Path(_without_repeats(np.array((start, goal))))
        floor = self._floor(room, start_joints, goal_joints)
        if floor is None:
            raise self._refusal(room, start_joints, goal, NoPathReason.GOAL_UNREACHABLE)
        bends = self._any_angle.shortest_path(
            floor, self._to_cells(start), start_joints, self._to_cells(goal), goal_joints
        )
        if bends is None:
            raise self._refusal(room, start_joints, goal, NoPathReason.GOAL_UNREACHABLE)
        way = _without_repeats(np.vstack((start, self._to_metres(bends), goal)))
        return _path(self._string.pulled(way, room.tight.obstacles))

    def reachable(self, start: Point, obstacles: Iterable[RoundObstacle] = ()) -> Mask:
        """Return the cells whose centres can be reached from ``start``, bool [rows, columns].

        ``obstacles`` as for :meth:`plan`. Raises :class:`NoPathError` (START_BLOCKED), and
        ValueError for numbers that are not finite.
        """
        _check_finite("start", start)
        room = self._room(obstacles)
        tight = room.tight
        joints = join_start(tight, start)
        if not len(joints.legs):
            raise NoPathError(start, NoPathReason.START_BLOCKED, None)
        regions = frozenset(_regions(tight, joints).tolist())
        if room is not self._among_walls:
            return np.isin(tight.regions, list(regions))
        if regions not in self._reachable:
            mask = np.isin(tight.regions, list(regions))
            mask.flags.writeable = False
            self._reachable[regions] = mask
        return self._reachable[regions]

    def roomy(self, obstacles: Iterable[RoundObstacle] = ()) -> Mask:
        """Return the cells on whose centres the body keeps the distance wanted, bool as the map.

        ``obstacles`` as for :meth:`plan`. Raises ValueError for numbers that are not finite.
        """
        return self._room(obstacles).comfortable.fits

    def is_free(self, points: NDArray[np.float64]) -> bool:
        """Whether the body fits everywhere on a way, float64 [n, 2], m, with tight clearance."""
        tight = self._among_walls.tight
        corners = [(float(x), float(y)) for x, y in points]
        return all(tight.fits_along(start, end) for start, end in pairwise(corners))

    def _room(self, obstacles: Iterable[RoundObstacle]) -> _Room:
        """Return where the body fits; the result is cached until the obstacles change."""
        walls = self._among_walls
        tight = walls.tight.with_obstacles(obstacles)
        if not tight.obstacles:
            return walls
        if tight.obstacles != self._among_obstacles.tight.obstacles:
            comfortable = walls.comfortable.with_obstacles(tight.obstacles)
            self._among_obstacles = _Room(comfortable, tight)
        return self._among_obstacles

    def _floor(self, room: _Room, start: Joints, goal: Joints) -> FreeSpace | None:
        """Return the floor to search: the comfortable one, opened only where there is no other way.

        None when even with tight clearance no way leads from the start to the goal.
        """
        if np.intersect1d(
            _regions(room.comfortable, start), _regions(room.comfortable, goal)
        ).any():
            return room.floor
        shared = np.intersect1d(_regions(room.tight, start), _regions(room.tight, goal))
        if not len(shared):
            return None
        first = start.cells[np.isin(_regions(room.tight, start), shared)][0]
        region = room.tight.regions[tuple(first)]
        last = goal.cells[_regions(room.tight, goal) == region][0]
        way = self._grid.shortest_path(room.tight.fits, tuple(first), tuple(last))
        if way is None:
            return None
        cells = way.cells
        regions = room.comfortable.regions[cells[:, 0], cells[:, 1]]
        opened = np.zeros(self.frame.shape, np.bool_)
        comfortable = np.flatnonzero(regions)
        # A stretch that leaves a comfortable region and comes back to the same one can be avoided.
        edges = np.concatenate(([-1], comfortable, [len(cells)]))
        for before, after in pairwise(edges.tolist()):
            within = before >= 0 and after < len(cells) and regions[before] == regions[after]
            if not within:
                stretch = cells[max(before, 0) : after + 1]
                opened[stretch[:, 0], stretch[:, 1]] = True
        opened = dilated(opened, np.ones((_OPENING, _OPENING), np.bool_))
        return FreeSpace.of(room.comfortable.fits | (room.tight.fits & opened))

    def _refusal(
        self, room: _Room, start: Joints, goal: Point, reason: NoPathReason
    ) -> NoPathError:
        """Return the error, with the reachable cell centre nearest to the goal."""
        if not len(start.legs):
            return NoPathError(goal, reason, None)
        rows, columns = np.nonzero(np.isin(room.tight.regions, _regions(room.tight, start)))
        x, y = self._to_cells(goal)
        nearest = int(np.argmin(np.hypot(columns - x, rows - y)))
        return NoPathError(
            goal, reason, self.frame.centre_of(int(rows[nearest]), int(columns[nearest]))
        )

    def _to_cells(self, point: Point) -> Point:
        frame = self.frame
        return (
            (point[0] - frame.origin_x) / frame.resolution - 0.5,
            (point[1] - frame.origin_y) / frame.resolution - 0.5,
        )

    def _to_metres(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.column_stack(self.frame.centres(points[:, 1], points[:, 0]))


def _regions(fit: FitMap, joints: Joints) -> NDArray[np.int32]:
    """Return the number of the region of each joint, 0 where the body does not fit."""
    regions: NDArray[np.int32] = fit.regions[joints.cells[:, 0], joints.cells[:, 1]]
    return regions


def _check_finite(name: str, point: Point) -> None:
    if not (math.isfinite(point[0]) and math.isfinite(point[1])):
        raise ValueError(
            f"expected a {name} of two finite numbers, m, got ({point[0]}, {point[1]})"
        )


def _without_repeats(way: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a way's points, float64 [n, 2], without bends that repeat the point before."""
    start, *bends, goal = way.tolist()
    points = [start]
    for bend in bends:
        if math.dist(points[-1], bend) > _SAME and math.dist(bend, goal) > _SAME:
            points.append(bend)
    if goal != start:
        points.append(goal)
    return np.array(points, np.float64)


def _path(points: NDArray[np.float64]) -> Path:
    """Return the path along points, float64 [n, 2], without those that do not bend it."""
    path = Path(points)
    kept = np.abs(path.corner_angles) > _STRAIGHT
    kept[[0, -1]] = True
    return Path(points[kept])
