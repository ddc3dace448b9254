"""Following a path: the setpoint that runs ahead of the robot, and how fast to go there."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right

import numpy as np

from roomba.configuration.loops import WalkConfig
from roomba.geometry import Pose
from roomba.planning.path.planner import Path

_SAME = 1e-9
"""m; a corner that is no farther behind the robot counts as where the robot is."""
_HALVINGS = 20
"""Bisections of the way to a setpoint that is brought nearer: to less than a micrometre."""
_SEARCH_AHEAD = 0.6
"""m; window of the path, from the robot's last place on, in which its place is searched."""


class PathFollower:
    """Keeps where on its path the robot is; lengths in m from the path's start."""

    def __init__(self, path: Path, config: WalkConfig) -> None:
        """Begin at the start of ``path``."""
        self._path = path
        self._config = config
        self._along = 0.0
        self._points: list[list[float]] = path.points.tolist()
        self._corners: list[float] = path.stations[1:-1].tolist()
        self._angles: list[float] = np.abs(path.corner_angles[1:-1]).tolist()

    @property
    def along(self) -> float:
        """How far along its path the robot is, m."""
        return self._along

    @property
    def left(self) -> float:
        """The length of path still before the robot, m."""
        return self._path.length - self._along

    def distance_off(self, pose: Pose) -> float:
        """Return how far a pose is from where the robot was last on the path, m."""
        return pose.distance_to(*self._path.point_at(self._along))

    def tick(self, pose: Pose, max_speed: float) -> tuple[tuple[float, float], float]:
        """Return the setpoint, map frame, and the cruise speed wanted, m/s."""
        self._along = self._path.project(pose.x, pose.y, self._along, _SEARCH_AHEAD)
        setpoint = self._path.point_at(self._carrot(pose))
        return setpoint, min(max_speed, self._corner_speed(max_speed))

    def _carrot(self, pose: Pose) -> float:
        """Return how far along the path the setpoint is.

        The setpoint runs ahead, but not beyond a sharp corner, and only so far that the straight
        way to it keeps to the path.
        """
        carrot = self._with_straight_way(
            min(self._along + self._config.lookahead, self._path.length)
        )
        first = bisect_right(self._corners, self._along - _SAME)
        for corner in range(first, bisect_right(self._corners, carrot)):
            station = self._corners[corner]
            if self._angles[corner] > self._config.sharp_corner:
                off = pose.distance_to(*self._path.point_at(station))
                if off > self._config.corner_reached:
                    return station
        return carrot

    def _with_straight_way(self, farthest: float) -> float:
        """Return how far along the setpoint may be at most, so that no bend is cut by too much."""
        if self._cut_by(farthest) <= self._config.corner_cut:
            return farthest
        # A setpoint that is nearer than this is as good as reached, and the robot stands.
        nearer = min(self._along + 2.0 * self._config.corner_reached, farthest)
        for _ in range(_HALVINGS):
            middle = 0.5 * (nearer + farthest)
            if self._cut_by(middle) <= self._config.corner_cut:
                nearer = middle
            else:
                farthest = middle
        return nearer

    def _cut_by(self, until: float) -> float:
        """Return by how much, m, the straight way from where it is to there leaves the path."""
        first, last = (
            bisect_right(self._corners, self._along),
            bisect_left(self._corners, until),
        )
        if first >= last:
            return 0.0
        x, y = self._path.point_at(self._along)
        to_x, to_y = self._path.point_at(until)
        length = math.hypot(to_x - x, to_y - y)
        if length < _SAME:
            return math.inf
        return max(
            abs((to_x - x) * (at_y - y) - (to_y - y) * (at_x - x)) / length
            for at_x, at_y in self._points[first + 1 : last + 1]
        )

    def _corner_speed(self, max_speed: float) -> float:
        """Return the fastest speed from which all corners ahead can be taken, m/s."""
        slower = max_speed - min(self._config.corner_speed, max_speed)
        twice_braking, allowed = 2.0 * self._config.braking, max_speed
        for corner in range(bisect_left(self._corners, self._along), len(self._corners)):
            gained = twice_braking * (self._corners[corner] - self._along)
            if gained >= max_speed * max_speed:
                break
            through = max_speed - slower * min(self._angles[corner] / (0.5 * math.pi), 1.0)
            allowed = min(allowed, math.sqrt(through * through + gained))
        return max(self._config.slowest, allowed)
