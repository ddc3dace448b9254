"""The plain way to simulate a lidar, compiled: each beam goes from cell to cell until one is solid.

Amanatides & Woo, "A fast voxel traversal algorithm for ray tracing", Eurographics 1987. It is the
reference for the speed and for the exactness of edge projection.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from roomba.raster.distance import distance_to_nearest
from roomba_bench.floors import Floor
from roomba_bench.peers.protocol import Work
from roomba_bench.peers.simulators.arena import LONGEST_TURN, SHORTEST_TURN, SPEED, TURNING_SPEED

Poses = NDArray[np.float64]
Scans = NDArray[np.float32]

_NEVER = 1e30
_PAD = 1
_BATCH = 200
"""Steps of the robot between two looks at the clock."""


class RayMarching:
    """A lidar, and a robot that drives about with it, on one floor."""

    def __init__(self, floor: Floor, beams: int, reach: float, radius: float) -> None:
        """Lengths in m."""
        self._frame = floor.frame
        # With a wall around the grid no beam leaves it, so that no cell is checked for that.
        self._solid = np.pad(floor.solid, _PAD, constant_values=True)
        self._reach = reach
        self._beams = beams
        self._room = distance_to_nearest(self._solid) * floor.frame.resolution >= radius

    def scan(self, poses: Poses) -> Scans:
        """Return ranges, m, float32 [poses, beams]; what is beyond reach reads as reach."""
        ranges = np.empty((len(poses), self._beams), np.float32)
        _scan_all(self._solid, self._in_cells(poses), self._reach / self._size, ranges)
        return ranges * np.float32(self._size)

    def drive(self, start: Poses, dt: float, scan_every: int) -> Work:
        """Return the work of driving about from ``start``, float64 [3]; units are steps."""
        state = np.append(self._in_cells(start[None])[0], 0.0)
        ranges = np.empty((1, self._beams), np.float32)

        def steps() -> float:
            reach = self._reach / self._size
            _drive(
                self._solid, self._room, state, dt, self._size, _BATCH, scan_every, reach, ranges
            )
            return float(_BATCH)

        return Work(steps)

    @property
    def _size(self) -> float:
        return self._frame.resolution

    def _in_cells(self, poses: Poses) -> Poses:
        origin = np.array([self._frame.origin_x, self._frame.origin_y, 0.0])
        cells: Poses = (poses - origin) / np.array([self._size, self._size, 1.0])
        cells += np.array([_PAD, _PAD, 0.0])
        return cells


@njit(cache=True, fastmath=True, nogil=True)
def _march(
    solid: NDArray[np.bool_], x: float, y: float, toward_x: float, toward_y: float, reach: float
) -> float:
    column, row = int(x), int(y)
    step_x, step_y = 1 if toward_x > 0.0 else -1, 1 if toward_y > 0.0 else -1
    each_x = _NEVER if toward_x == 0.0 else 1.0 / abs(toward_x)
    each_y = _NEVER if toward_y == 0.0 else 1.0 / abs(toward_y)
    next_x = (column + 1 - x if toward_x > 0.0 else x - column) * each_x
    next_y = (row + 1 - y if toward_y > 0.0 else y - row) * each_y
    way = 0.0
    while way < reach:
        if next_x < next_y:
            way, next_x, column = next_x, next_x + each_x, column + step_x
        else:
            way, next_y, row = next_y, next_y + each_y, row + step_y
        if solid[row, column]:
            return min(way, reach)
    return reach


@njit(cache=True, fastmath=True, nogil=True)
def _scan(
    solid: NDArray[np.bool_], x: float, y: float, theta: float, reach: float, ranges: Scans
) -> None:
    toward_x, toward_y = math.cos(theta), math.sin(theta)
    turn_x, turn_y = math.cos(2.0 * math.pi / len(ranges)), math.sin(2.0 * math.pi / len(ranges))
    for beam in range(len(ranges)):
        ranges[beam] = _march(solid, x, y, toward_x, toward_y, reach)
        toward_x, toward_y = (
            toward_x * turn_x - toward_y * turn_y,
            toward_x * turn_y + toward_y * turn_x,
        )


@njit(cache=True, fastmath=True, nogil=True)
def _scan_all(solid: NDArray[np.bool_], poses: Poses, reach: float, ranges: Scans) -> None:
    for number in range(len(poses)):
        x, y, theta = poses[number]
        _scan(solid, x, y, theta, reach, ranges[number])


@njit(cache=True, fastmath=True, nogil=True)
def _drive(
    solid: NDArray[np.bool_],
    room: NDArray[np.bool_],
    state: NDArray[np.float64],
    dt: float,
    size: float,
    steps: int,
    scan_every: int,
    reach: float,
    ranges: Scans,
) -> None:
    """Drive straight on, and after a bump turn for a random time; ``state``: x, y, theta, turn."""
    for step in range(steps):
        if state[3] > 0.0:
            state[2] += TURNING_SPEED * dt
            state[3] -= dt
        else:
            x = state[0] + SPEED * dt / size * math.cos(state[2])
            y = state[1] + SPEED * dt / size * math.sin(state[2])
            if room[int(y), int(x)]:
                state[0], state[1] = x, y
            else:
                state[3] = SHORTEST_TURN + (LONGEST_TURN - SHORTEST_TURN) * np.random.random()
        if step % scan_every == 0:
            _scan(solid, state[0], state[1], state[2], reach, ranges[0])
