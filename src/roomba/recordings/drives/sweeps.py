"""How a lidar measures the beams of a scan one after the other, where its driver tells it wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from roomba.perception.matching.scan_view import LidarModel
from roomba.recordings.readings import LidarScan


@dataclass(frozen=True, slots=True)
class Sweep:
    """A sweep that begins at a scan's stamp with the first beam, or, ``is_backwards``, the last.

    ``turn`` is how long the lidar takes for a whole turn, s; 0: all beams are measured at once;
    None: from beam to beam it takes as long as its driver tells.
    """

    is_backwards: bool = False
    turn: float | None = None

    def __str__(self) -> str:
        """Return it in words."""
        if self.turn == 0.0:
            return "all at once"
        order = "from the last to the first" if self.is_backwards else "from the first to the last"
        return order if self.turn is None else f"{order}, {self.turn:.3f} s for a whole turn"


class SweptScans:
    """Makes scans whose beams are listed in the order in which they were measured."""

    def __init__(self, sweep: Sweep) -> None:
        """Take how the scans were measured."""
        self._sweep = sweep
        self._newest: tuple[LidarModel, LidarModel] | None = None

    def of(self, scan: LidarScan) -> LidarScan:
        """Return a scan with its beams in the order of time."""
        is_backwards = self._sweep.is_backwards
        ranges = scan.ranges[::-1] if is_backwards else scan.ranges
        if self._newest is None or self._newest[0] is not scan.lidar:
            self._newest = scan.lidar, self._swept(scan.lidar)
        return LidarScan(np.ascontiguousarray(ranges), self._newest[1])

    def _swept(self, lidar: LidarModel) -> LidarModel:
        increment, turn = abs(lidar.time_increment), self._sweep.turn
        if turn is not None:
            increment = turn * abs(lidar.step) / math.tau
        return lidar.swept(increment, is_backwards=self._sweep.is_backwards)
