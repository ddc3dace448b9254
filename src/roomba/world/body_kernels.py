"""Compiled motion of the round body: speed ramps, exact arcs, and contact with what is solid.

Metres, radians, seconds, map frame. ``solid`` is bool [rows, columns]; all outside is solid.
``room`` is float32 of the same shape: no solid thing is nearer to any point of the cell, m.
``place`` is float64 [3]: resolution, origin x, origin y of both grids.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]

X, Y, THETA, LINEAR, ANGULAR, HIT, LEFT, RIGHT = range(8)
"""Slots of a body's state, float64 [8]: pose, velocities, and 0 or 1 for hit and both bumpers."""
STATE_SIZE = 8

PROBE_STEP = 1e-3
"""m; how finely contact is felt for when something solid is nearer than the way to go."""
CONTACT_GAP = 1e-3
"""m; a bumper stays pressed until what it touches is farther away than this."""
BOTH_BUMPERS_ANGLE = 0.3
"""rad; contact nearer to straight ahead than this presses both halves of the bumper."""


@njit(cache=True, nogil=True)
def wrapped(angle: float) -> float:
    """Return the same direction in [-pi, pi)."""
    return angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5)


@njit(cache=True, nogil=True)
def ramp(value: float, target: float, speeding_up: float, braking: float, dt: float) -> float:
    """Return ``value`` brought towards ``target`` within the limits (1/s2), not past it."""
    target_now = 0.0 if value * target < 0.0 else target
    limit = (speeding_up if abs(target_now) > abs(value) else braking) * dt
    return value + min(max(target_now - value, -limit), limit)


@njit(cache=True, nogil=True)
def arc(x: float, y: float, theta: float, length: float, turn: float) -> tuple[float, float]:
    """Return the point after ``length`` m of an arc that changes the heading by ``turn`` rad."""
    if abs(turn) < 1e-9:
        middle = theta + 0.5 * turn
        return x + length * math.cos(middle), y + length * math.sin(middle)
    radius = length / turn
    return (
        x + radius * (math.sin(theta + turn) - math.sin(theta)),
        y - radius * (math.cos(theta + turn) - math.cos(theta)),
    )


@njit(cache=True, nogil=True)
def distance_to_solid(
    solid: NDArray[np.bool_], place: Floats, x: float, y: float, reach: float
) -> float:
    """Return the distance from a point to the nearest solid cell's square, at most ``reach``."""
    resolution = place[0]
    u = (x - place[1]) / resolution
    v = (y - place[2]) / resolution
    cells = reach / resolution
    rows, columns = solid.shape
    nearest = cells * cells
    for row in range(math.floor(v - cells), math.floor(v + cells) + 1):
        dv = max(row - v, v - row - 1.0, 0.0)
        if dv * dv >= nearest:
            continue
        for column in range(math.floor(u - cells), math.floor(u + cells) + 1):
            inside = 0 <= row < rows and 0 <= column < columns
            if inside and not solid[row, column]:
                continue
            du = max(column - u, u - column - 1.0, 0.0)
            nearest = min(nearest, du * du + dv * dv)
    return float(math.sqrt(nearest) * resolution)


@njit(cache=True, nogil=True)
def gap_around(
    solid: NDArray[np.bool_],
    room: NDArray[np.float32],
    place: Floats,
    radius: float,
    x: float,
    y: float,
    way: float,
) -> float:
    """Return how far the disc is from what is solid, m; exact when nearer than ``way``."""
    row = math.floor((y - place[2]) / place[0])
    column = math.floor((x - place[1]) / place[0])
    rows, columns = solid.shape
    if 0 <= row < rows and 0 <= column < columns and room[row, column] - radius > way:
        return float(room[row, column]) - radius
    return distance_to_solid(solid, place, x, y, radius + way) - radius


@njit(cache=True, nogil=True)
def free_share(
    solid: NDArray[np.bool_],
    room: NDArray[np.float32],
    place: Floats,
    radius: float,
    state: Floats,
    length: float,
    turn: float,
) -> float:
    """Return the share of an arc, 0..1, that the disc can go before it touches something solid.

    A disc that already overlaps may go where the overlap does not grow.
    """
    way = abs(length)
    done = 0.0
    x, y = state[X], state[Y]
    while done < 1.0 and way > 0.0:
        left = way * (1.0 - done)
        gap = gap_around(solid, room, place, radius, x, y, left + PROBE_STEP)
        if gap > left:
            return 1.0
        step = min(1.0, done + max(gap - 1e-9, PROBE_STEP) / way)
        least = min(gap, 0.0)
        nx, ny = arc(state[X], state[Y], state[THETA], length * step, turn * step)
        if gap_around(solid, room, place, radius, nx, ny, PROBE_STEP) < least:
            low, high = done, step
            for _ in range(24):
                middle = 0.5 * (low + high)
                nx, ny = arc(state[X], state[Y], state[THETA], length * middle, turn * middle)
                if gap_around(solid, room, place, radius, nx, ny, PROBE_STEP) < least:
                    high = middle
                else:
                    low = middle
            return low
        done, x, y = step, nx, ny
    return 1.0


@njit(cache=True, nogil=True)
def feel_bumper(solid: NDArray[np.bool_], place: Floats, radius: float, state: Floats) -> None:
    """Press and release the bumper's halves by what touches the front half of the disc.

    A half is pressed by a hit, and stays so while the contact lasts.
    """
    x, y, theta = state[X], state[Y], state[THETA]
    held = state[HIT] > 0.0 or state[LEFT] > 0.0 or state[RIGHT] > 0.0
    state[LEFT] = 0.0
    state[RIGHT] = 0.0
    if not held:
        return
    resolution = place[0]
    u = (x - place[1]) / resolution
    v = (y - place[2]) / resolution
    reach = (radius + CONTACT_GAP) / resolution
    rows, columns = solid.shape
    for row in range(math.floor(v - reach), math.floor(v + reach) + 1):
        for column in range(math.floor(u - reach), math.floor(u + reach) + 1):
            inside = 0 <= row < rows and 0 <= column < columns
            if inside and not solid[row, column]:
                continue
            du = min(max(u, column), column + 1.0) - u
            dv = min(max(v, row), row + 1.0) - v
            if du * du + dv * dv > reach * reach:
                continue
            angle = wrapped(math.atan2(dv, du) - theta)
            if abs(angle) > 0.5 * math.pi:
                continue
            if angle > -BOTH_BUMPERS_ANGLE:
                state[LEFT] = 1.0
            if angle < BOTH_BUMPERS_ANGLE:
                state[RIGHT] = 1.0


@njit(cache=True, nogil=True)
def drive(
    solid: NDArray[np.bool_],
    room: NDArray[np.float32],
    place: Floats,
    limits: Floats,
    state: Floats,
    linear: float,
    angular: float,
    dt: float,
) -> None:
    """Move the body by one step of ``dt`` s towards the wanted velocities; ``state`` is changed.

    ``limits`` is float64 [6]: radius, top speed, top turning speed, acceleration, deceleration,
    angular acceleration. The distance and the turn of a step are those of the ramped velocities'
    means, driven as one arc; at contact the disc stays there and its forward speed is zero.
    """
    radius = limits[0]
    wanted = min(max(linear, -limits[1]), limits[1])
    wanted_turn = min(max(angular, -limits[2]), limits[2])
    new_linear = ramp(state[LINEAR], wanted, limits[3], limits[4], dt)
    new_angular = ramp(state[ANGULAR], wanted_turn, limits[5], limits[5], dt)
    length = 0.5 * (state[LINEAR] + new_linear) * dt
    turn = 0.5 * (state[ANGULAR] + new_angular) * dt
    share = free_share(solid, room, place, radius, state, length, turn)
    x, y = arc(state[X], state[Y], state[THETA], length * share, turn * share)
    state[X] = x
    state[Y] = y
    state[THETA] = wrapped(state[THETA] + turn)
    state[HIT] = 1.0 if share < 1.0 else 0.0
    state[LINEAR] = 0.0 if share < 1.0 else new_linear
    state[ANGULAR] = new_angular
    feel_bumper(solid, place, radius, state)
