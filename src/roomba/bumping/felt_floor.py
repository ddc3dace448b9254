"""What the wheels say was swept, and where something was felt: cells around the robot's start."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose
from roomba.grid import GridFrame
from roomba.perception.swept.coverage_bits import SWEPT
from roomba.perception.swept.coverage_map import CoverageMap


class FeltFloor:
    """A grid in the frame of the odometry; what lies beyond its ends is not remembered.

    ``coverage`` is what was swept, ``felt`` bool [rows, columns] where something was felt. Both
    are as wrong as the odometry: by a metre and more after a quarter of an hour.
    """

    def __init__(self, config: BumpingConfig, tool_width: float) -> None:
        """Begin with nothing."""
        cells = math.ceil(config.floor_size / config.cell)
        corner = -0.5 * cells * config.cell
        self._frame = GridFrame(config.cell, corner, corner, cells, cells)
        self._tool_width = tool_width
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        everywhere = np.ones(self._frame.shape, np.bool_)
        self.coverage = CoverageMap(self._frame, everywhere, self._tool_width)
        self.felt: NDArray[np.bool_] = np.zeros(self._frame.shape, np.bool_)

    def sweep(self, pose: Pose) -> None:
        """Note that the robot swept up to this pose."""
        if self._frame.contains(pose.x, pose.y):
            self.coverage.sweep(pose.x, pose.y)

    def feel(self, pose: Pose, ahead: float) -> None:
        """Note that the robot felt something ``ahead`` m before its middle."""
        x, y = pose.x + ahead * math.cos(pose.theta), pose.y + ahead * math.sin(pose.theta)
        if self._frame.contains(x, y):
            self.felt[self._frame.cell_of(x, y)] = True

    def new_ahead(self, pose: Pose, heading: float, reach: float) -> float:
        """Return how much way of ``reach`` m in a direction was not swept yet, m.

        The look ends where something was felt, and at the edge of the grid.
        """
        step = self._frame.resolution
        new = 0.0
        for number in range(1, int(reach / step) + 1):
            way = (number - 0.5) * step
            x, y = pose.x + way * math.cos(heading), pose.y + way * math.sin(heading)
            if not self._frame.contains(x, y):
                break
            cell = self._frame.cell_of(x, y)
            if self.felt[cell]:
                break
            new += 0.0 if self.coverage.cells[cell] & SWEPT else step
        return new
