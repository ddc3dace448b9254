"""Joining: straight ways from any point to near cell centres where the body fits."""

from __future__ import annotations

import math

import numpy as np

from roomba.geometry import Point
from roomba.planning.path.costmap import FitMap
from roomba.planning.path.search.any_angle import Joints

_NEAR = 2.0
"""cells; a point at which the body fits is joined to centres up to so far, along each axis."""
_ROUNDING = 1e-9


def join_goal(fit: FitMap, goal: Point) -> Joints | None:
    """Join a goal to near centres: to the four around it if the body fits at all of them.

    If the body fits at another goal, close to a wall, the goal is joined to all near centres to
    which the body can go straight, possibly none. Returns None if the body does not fit at the
    goal.
    """
    near = _centres_near(fit, goal, _NEAR)
    if len(near.legs) and near.legs[0] < _ROUNDING:
        return near.among(np.arange(len(near.legs)) == 0)
    around = np.abs(near.cells - _in_cells(fit, goal)).max(axis=1, initial=0.0) < 1.0
    if np.count_nonzero(around) == 4:
        return near.among(around)
    if not fit.fits_at(*goal):
        return None
    ways = [fit.map.frame.centre_of(int(row), int(column)) for row, column in near.cells]
    return near.among(np.array([fit.fits_along(goal, way) for way in ways], np.bool_))


def join_start(fit: FitMap, start: Point) -> Joints:
    """Join a start to the near centres as a goal is.

    A body may not fit where it stands, because it has bumped into something or was put there. Then
    the start is joined to the nearest centre at which the body fits, and to which it can go
    straight without coming nearer to anything than it is now. It is joined to none if no such
    centre is within the body's reach and two cells, or if the start is off the map.
    """
    if not fit.map.frame.contains(*start):
        return _none()
    joints = join_goal(fit, start)
    if joints is not None and len(joints.legs):
        return joints
    frame = fit.map.frame
    room = fit.room_along(start, start)
    reach = fit.reach / frame.resolution + _NEAR
    near = _centres_near(fit, start, reach)
    for index, (row, column) in enumerate(near.cells):
        if near.legs[index] > reach:
            break
        if fit.room_along(start, frame.centre_of(int(row), int(column))) >= room - _ROUNDING:
            return near.among(np.arange(len(near.legs)) == index)
    return _none()


def _none() -> Joints:
    return Joints(np.zeros((0, 2), np.int64), np.zeros(0))


def _in_cells(fit: FitMap, point: Point) -> tuple[float, float]:
    """Return (row, column) of a point; whole numbers are centres."""
    frame = fit.map.frame
    return (
        (point[1] - frame.origin_y) / frame.resolution - 0.5,
        (point[0] - frame.origin_x) / frame.resolution - 0.5,
    )


def _centres_near(fit: FitMap, point: Point, reach: float) -> Joints:
    """Return the centres that fit within ``reach`` cells along each axis, the nearest first."""
    row, column = _in_cells(fit, point)
    rows, columns = fit.fits.shape
    if not (-reach < row < rows + reach and -reach < column < columns + reach):
        return _none()
    first_row = max(math.ceil(row - reach - _ROUNDING), 0)
    first_column = max(math.ceil(column - reach - _ROUNDING), 0)
    window = fit.fits[
        first_row : max(math.floor(row + reach + _ROUNDING) + 1, 0),
        first_column : max(math.floor(column + reach + _ROUNDING) + 1, 0),
    ]
    cells = np.argwhere(window) + np.array((first_row, first_column))
    legs = np.hypot(cells[:, 0] - row, cells[:, 1] - column)
    order = np.argsort(legs, kind="stable")
    return Joints(cells[order], legs[order])
