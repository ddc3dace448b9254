"""Where the robot has been: floor that leads back through doors, the way that it came or shorter.

Cells lie in the frame of the robot's estimated pose; the older a cell, the larger its error.
"""

from __future__ import annotations

import math
from collections import deque

from roomba.configuration.bumping import BumpingConfig
from roomba.geometry import Pose

_Cell = tuple[int, int]
_AROUND = [(x, y) for x in range(-2, 3) for y in range(-2, 3) if (x, y) != (0, 0)]
"""Offsets of cells that count as neighbours: between two ticks the robot may skip a cell."""


class DrivenFloor:
    """The cells where the robot's middle was, and how many steps each is from a destination."""

    def __init__(self, config: BumpingConfig) -> None:
        """Begin with none."""
        self._config = config
        self._driven: set[_Cell] = set()
        self._steps: dict[_Cell, int] = {}

    def forget(self) -> None:
        """Begin anew."""
        self._driven.clear()
        self._steps.clear()

    def drive(self, pose: Pose) -> None:
        """Note that the robot is at this pose."""
        self._driven.add(self._cell_at(pose.x, pose.y))

    def lead_to(self, x: float, y: float) -> None:
        """Find the ways over driven floor to the driven place nearest to (x, y), m."""
        self._steps.clear()
        if not self._driven:
            return
        place = self._cell_at(x, y)
        last = min(self._driven, key=lambda cell: math.dist(cell, place))
        self._steps[last] = 0
        coming = deque([last])
        while coming:
            cell = coming.popleft()
            for across, up in _AROUND:
                beside = cell[0] + across, cell[1] + up
                if beside in self._driven and beside not in self._steps:
                    self._steps[beside] = self._steps[cell] + 1
                    coming.append(beside)

    def next_from(self, pose: Pose) -> tuple[float, float] | None:
        """Return the place within reach that has the fewest steps left, m; None: no way."""
        side, reach = self._config.driven_cell, self._config.driven_ahead
        here, most = self._cell_at(pose.x, pose.y), math.ceil(reach / side)
        near = [
            (self._steps[cell], cell)
            for across in range(-most, most + 1)
            for up in range(-most, most + 1)
            if math.hypot(across, up) <= most
            and (cell := (here[0] + across, here[1] + up)) in self._steps
        ]
        if not near:
            return None
        _, (column, row) = min(near)
        return (column + 0.5) * side, (row + 0.5) * side

    def _cell_at(self, x: float, y: float) -> _Cell:
        side = self._config.driven_cell
        return math.floor(x / side), math.floor(y / side)
