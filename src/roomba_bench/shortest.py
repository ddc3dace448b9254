"""Shortest ways among polygons, by a visibility graph: exact, slow, and independent.

It uses nothing of the robot's search: straight lines that keep out of obstacles join their corners
(Lozano-Pérez & Wesley, "An algorithm for planning collision-free paths among polyhedral obstacles",
CACM 1979), and shapely says which do.
"""

from __future__ import annotations

import heapq
import math

import numpy as np
import shapely
from shapely.geometry.polygon import orient

from roomba.arrays import Floats, Mask
from roomba.geometry import Point
from roomba.grid import GridFrame

_CHORDS = 8
"""Chords of a quarter circle. They lie inside the true arc, so lengths are never too long; they are
too short by less than 0.2 % of the way around corners."""
_TOUCH = 1e-6
"""cells; the tolerance by which a line may touch an obstacle."""

_ROUNDING = 1e-12


class ShortestWays:
    """Shortest ways of a disc of ``radius`` m among ``solid`` cells, which it may touch.

    ``solid`` is bool [rows, columns] of ``frame``.
    """

    def __init__(self, solid: Mask, frame: GridFrame, radius: float) -> None:
        """Build the obstacles for the disc's middle, in cells, where corners are exact."""
        self._frame = frame
        closed = _area(solid).buffer(radius / frame.resolution, quad_segs=_CHORDS)
        self._closed = closed.buffer(-_TOUCH)
        shapely.prepare(self._closed)
        self._corners, self._sides = _convex_corners(closed)

    def length(self, start: Point, goal: Point) -> float:
        """Return the length of the shortest way between points (x, y), m; infinite if none."""
        origin = (self._frame.origin_x, self._frame.origin_y)
        ends = (np.array([start, goal]) - origin) / self._frame.resolution
        return self._length(ends) * self._frame.resolution

    def _length(self, ends: Floats) -> float:
        points = np.vstack([self._corners, ends])
        sides = np.vstack([self._sides, np.zeros((2, 2, 2))])
        first, last = len(points) - 2, len(points) - 1
        best = np.full(len(points), math.inf)
        best[first] = 0.0
        left = np.hypot(*(points - points[last]).T)
        open_ = [(float(left[first]), first)]
        done = np.zeros(len(points), np.bool_)
        while open_:
            _, here = heapq.heappop(open_)
            if here == last:
                return float(best[last])
            if done[here]:
                continue
            done[here] = True
            leg = points - points[here]
            far = np.hypot(leg[:, 0], leg[:, 1])
            useful = ~done & (best[here] + far < best) & (best[here] + far + left < best[last])
            # A shortest way passes a corner only so that the whole wall lies on one side of the
            # way.
            useful &= _passes(leg, sides) & _passes(leg, sides[here][None])
            nearer = np.flatnonzero(useful)
            for there in nearer[self._sees(points[here], points[nearer])].tolist():
                best[there] = best[here] + far[there]
                heapq.heappush(open_, (float(best[there] + left[there]), there))
        return math.inf

    def _sees(self, here: Floats, there: Floats) -> Mask:
        lines = shapely.linestrings(np.stack([np.broadcast_to(here, there.shape), there], axis=1))
        free: Mask = ~shapely.intersects(self._closed, lines)
        return free


def _convex_corners(closed: shapely.Geometry) -> tuple[Floats, Floats]:
    """Return corners at which a way can bend, float64 [n, 2], and both sides of each, [n, 2, 2]."""
    corners, sides = [], []
    for polygon in shapely.get_parts(closed):
        turned = orient(polygon)  # obstacles lie to the left of all rings
        for ring in (turned.exterior, *turned.interiors):
            points = shapely.get_coordinates(ring)[:-1]
            before, after = (
                np.roll(points, 1, axis=0) - points,
                np.roll(points, -1, axis=0) - points,
            )
            convex = _cross(after, before) > 0.0
            corners.append(points[convex])
            sides.append(np.stack([before, after], axis=1)[convex])
    return np.concatenate(corners), np.concatenate(sides)


def _passes(leg: Floats, sides: Floats) -> Mask:
    """Whether lines, [n, 2], have both sides of a corner, [n or 1, 2, 2], on the same side."""
    passes: Mask = _cross(leg, sides[:, 0]) * _cross(leg, sides[:, 1]) >= -_ROUNDING
    return passes


def _cross(first: Floats, second: Floats) -> Floats:
    return first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]


def _area(cells: Mask) -> shapely.Geometry:
    """Return the polygon of the true cells."""
    rows, columns = np.nonzero(cells)
    return shapely.union_all(shapely.box(columns, rows, columns + 1.0, rows + 1.0)).simplify(0.0)
