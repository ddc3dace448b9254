"""When a map that is being made is drawn: once a period, if it grew.

All that goes by such a map goes by what was drawn, headless and on ROS alike.
"""

from __future__ import annotations

import math
from typing import Protocol

from roomba.configuration.robot import TimingConfig
from roomba.grid import OccupancyMap


class MapSource(Protocol):
    """A map that grows, as a mapper makes it."""

    @property
    def version(self) -> int:
        """It changes whenever the map does; 0 before there is one."""

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now."""


class MapDrawing:
    """Draws a map that is being made; times are in s of the robot's clock."""

    def __init__(self, source: MapSource, timing: TimingConfig) -> None:
        """Begin with nothing drawn: the first map is drawn at once.

        Ticks do not fall on periods: half of one earlier is early enough.
        """
        self._source, self._apart = source, timing.map_period - 0.5 * timing.tick
        self._version, self._drawn_at = 0, -math.inf

    @property
    def due_at(self) -> float:
        """When it is drawn next if it does not grow before, s; infinite if it has not grown."""
        return self._drawn_at + self._apart if self._source.version != self._version else math.inf

    def draw(self, now: float) -> OccupancyMap | None:
        """Return the map at ``now`` if it is time to draw it; None if not, or before there is one.

        A clock that was set back begins a period.
        """
        if self._source.version == self._version or 0.0 <= now - self._drawn_at < self._apart:
            return None
        self._version, self._drawn_at = self._source.version, now
        return self._source.occupancy()
