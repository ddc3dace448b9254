"""The dust bin: whether it is full, by its level sensor and by the grains that come in."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.mission import BinConfig
from roomba.mission.phases.dust_bin_kernels import DUST, note_dust

_REMEMBERED: Final = 4000
"""Places of the last ticks that are kept: longer than the silence that tells a full bin."""


class DustBin:
    """The bin: ``is_full`` until it is emptied; ``full_at`` is its level as it became full, g.

    It is ticked while the robot sweeps. Below ``nearly_full`` a level sensor that reads more than
    nothing is trusted. Without a level sensor the grains alone tell, if some came in before: a full
    bin takes none in. They tell something only on floor on which there usually are some.
    """

    def __init__(self, config: BinConfig, capacity: float) -> None:
        """Begin with an empty one that takes ``capacity`` g."""
        self._config, self._capacity = config, capacity
        self.is_full = False
        self.rows = np.zeros(1, DUST)
        self.rows["least_grains"] = config.least_grains
        self.full_at = 0.0
        self._places: deque[tuple[float, float]] = deque(maxlen=_REMEMBERED)

    @property
    def full_from(self) -> float:
        """From how much in it, g, it is full in any case."""
        return self._config.full * self._capacity

    def look(self, in_bin: float, cell_area: float, usual: Callable[[], float]) -> bool:
        """Take the level sensor's reading, g; return whether the bin became full by it.

        Cells are of ``cell_area`` m2, with ``usual`` grains/m2 on the floor of this clean.
        """
        if self.is_full:
            if in_bin < self._config.emptied * self.full_at:
                self.emptied()
            return False
        if in_bin >= self.full_from or self._is_silent(in_bin, cell_area, usual):
            self.fill(in_bin)
        return self.is_full

    def fill(self, in_bin: float) -> None:
        """Mark the bin as full, with so much in it by its level sensor, g."""
        self.is_full, self.full_at = True, in_bin

    def emptied(self) -> None:
        """Mark the bin as empty."""
        self.is_full = False
        for name in ("silent_cells", "silent_way", "heard"):
            self.rows[name] = 0
        self._places.clear()

    def note(self, x: float, y: float, grains: float, way: float, cells: int) -> None:
        """Note a tick: the place, m, grains/s, m driven, and cells that became clean."""
        note_dust(self.rows, grains, way, cells)
        self._places.append((x, y))

    def passed(self, places: NDArray[np.float64]) -> None:
        """Note ``places``, float64 [n, 2], m, of ticks that ``rows`` have counted already."""
        self._places.extend((x, y) for x, y in places.tolist())

    def forget_places(self) -> None:
        """Forget where the robot was: the map is another one."""
        self._places.clear()

    @property
    def most_silent(self) -> float:
        """m2 of floor without a grain after which :meth:`look` may find it full."""
        return self._config.silent

    def heeds_silence(self, in_bin: float) -> bool:
        """Whether silence tells anything, with so much in it by its level sensor, g."""
        if in_bin > 0.0:
            return in_bin >= self._config.nearly_full * self._capacity
        return bool(self.rows[0]["heard"])

    def swept_in_vain(self) -> NDArray[np.float64]:
        """Return the way since the last grain came in, float64 [n, 2], m; none while they come."""
        silent = float(self.rows[0]["silent_way"])
        if silent <= 0.0 or not self._places:
            return np.empty((0, 2))
        left = silent + self._config.fading_way
        points = [self._places[-1]]
        for place in list(self._places)[-2::-1]:
            left -= math.dist(place, points[-1])
            points.append(place)
            if left <= 0.0:
                break
        return np.array(points, np.float64)

    def _is_silent(self, in_bin: float, cell_area: float, usual: Callable[[], float]) -> bool:
        silent = float(self.rows[0]["silent_cells"]) * cell_area
        if silent < self._config.silent or not self.heeds_silence(in_bin):
            return False
        return usual() >= self._config.dusty
