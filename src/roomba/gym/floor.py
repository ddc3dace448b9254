"""The floor of a home for the reward: the cells that a brush can reach, and has reached."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import RobotConfig
from roomba.errors import HomeError
from roomba.grid import GridFrame
from roomba.raster.distance import distance_to_nearest
from roomba.raster.regions import dilated, numbered_regions
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import Home

_STANDS_WITHIN = 0.5
"""m; within this distance of the docked robot there must be floor where it can stand free."""


@dataclass(frozen=True, slots=True, eq=False)
class FloorDistances:
    """What can be reached from the station; make it with :meth:`of`.

    For a home that was turned, all is in the home's own axes, as the fleet's dirt and poses are.
    """

    frame: GridFrame
    """The frame of the dirt's grid."""
    places: NDArray[np.float64]
    """[places, 2]: x, y, m, where the robot's middle can stand and get to."""
    reachable: NDArray[np.bool_]
    """[rows, columns]: cells whose middles are within ``reach`` of a place."""
    reach: float
    """m; half the brush's width, but less than the body's radius, so that it ends on the grid."""
    window: int
    """Cells along an axis from the robot's own cell to the farthest that can be within reach."""

    @staticmethod
    def of(home: Home, config: RobotConfig) -> FloorDistances:
        """Return the floor of a home; raises HomeError where the robot can stand nowhere."""
        exact = home.exact
        frame, blocked = exact.frame, exact.blocked
        # A wall's face is half a cell nearer than its cell's middle.
        away = distance_to_nearest(np.pad(blocked, 1, constant_values=True))[1:-1, 1:-1] - 0.5
        regions = numbered_regions(away * frame.resolution >= config.body.radius)
        rows, columns = np.nonzero(regions)
        x, y = frame.centres(rows, columns)
        from_station = np.hypot(x - exact.station.x, y - exact.station.y)
        if not len(rows) or from_station.min() > max(_STANDS_WITHIN, 2.0 * frame.resolution):
            raise HomeError(
                f"home {home.name}: expected floor to stand on within {_STANDS_WITHIN} m of the "
                f"docked robot at ({home.station.x:.2f}, {home.station.y:.2f}), found none; move "
                "the station or what stands there"
            )
        nearest = int(np.argmin(from_station))
        region = regions == regions[rows[nearest], columns[nearest]]
        dirt = DirtField.of(exact)
        fineness = dirt.frame.rows // frame.rows
        reach = min(0.5 * config.brush.width, 0.99 * config.body.radius)
        cells = reach / dirt.frame.resolution
        standing = np.repeat(np.repeat(region, fineness, axis=0), fineness, axis=1)
        there = region[rows, columns]
        return FloorDistances(
            frame=dirt.frame,
            places=np.stack([x[there], y[there]], axis=1),
            reachable=dilated(standing, _disc(cells)) & dirt.floor,
            reach=reach,
            window=math.floor(min(cells + 0.5, config.body.radius / dirt.frame.resolution)),
        )


class Coverage:
    """Which reachable cells the brushes of many robots have been over, each robot in its own home.

    A cell is covered once its middle was within reach.
    """

    def __init__(self, floor: FloorDistances, robots: int) -> None:
        """Begin with nothing covered."""
        self._frame = floor.frame
        self._squared_reach = (floor.reach / floor.frame.resolution) ** 2 + 1e-9
        window = np.arange(-floor.window, floor.window + 1)
        self._rows = np.repeat(window, len(window))
        self._columns = np.tile(window, len(window))
        self._near = self._rows * floor.frame.columns + self._columns
        self._total = max(1, int(np.count_nonzero(floor.reachable)))
        self._open = np.repeat(floor.reachable.reshape(1, -1), robots, axis=0)
        self._reachable = floor.reachable.ravel()
        self._covered = np.zeros(robots, np.int64)
        self._robots = np.arange(robots)[:, None]

    @property
    def shares(self) -> NDArray[np.float64]:
        """How much of the reachable floor is covered, 0..1, float64 [robots]."""
        return self._covered / self._total

    def forget(self, robot: int) -> None:
        """Begin anew for a robot."""
        self._open[robot] = self._reachable
        self._covered[robot] = 0

    def add(self, poses: NDArray[np.float64]) -> None:
        """Cover what the brushes reach at poses, float64 [robots, 3], of the floor's frame."""
        frame = self._frame
        x = (poses[:, :1] - frame.origin_x) / frame.resolution - 0.5
        y = (poses[:, 1:2] - frame.origin_y) / frame.resolution - 0.5
        columns, rows = np.rint(x), np.rint(y)
        away = (self._columns + (columns - x)) ** 2 + (self._rows + (rows - y)) ** 2
        is_covered = away <= self._squared_reach
        cells = (rows * frame.columns + columns).astype(np.int64) + self._near
        was_open = self._open[self._robots, cells]
        self._covered += np.count_nonzero(was_open & is_covered, axis=1)
        self._open[self._robots, cells] = was_open & ~is_covered


def _disc(radius: float) -> NDArray[np.bool_]:
    """Return the cells within ``radius`` cells of the middle one, bool [2 n + 1, 2 n + 1]."""
    reach = math.floor(radius + 1e-9)
    away = np.arange(-reach, reach + 1)
    disc: NDArray[np.bool_] = away[:, None] ** 2 + away[None, :] ** 2 <= (radius + 1e-9) ** 2
    return disc
