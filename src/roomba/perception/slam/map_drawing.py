"""Drawing of a map that is being made: once a period, if the map grew.

All users of such a map get the newest drawing, headless and on ROS alike.
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
        """A number that changes whenever the map does; 0 before there is a map."""

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now."""


class MapDrawing:
    """Draws a map that is being made; times are in s of the robot's clock."""

    def __init__(self, source: MapSource, timing: TimingConfig) -> None:
        """Begin with nothing drawn: the first map is drawn at once.

        Ticks do not fall exactly on periods: a map is drawn up to half a tick early.
        """
        self._source, self._apart = source, timing.map_period - 0.5 * timing.tick
        self._version, self._drawn_at = 0, -math.inf

    @property
    def due_at(self) -> float:
        """Time of the next drawing, s; infinite if the map has not grown since the last one."""
        return self._drawn_at + self._apart if self._source.version != self._version else math.inf

    def draw(self, now: float) -> OccupancyMap | None:
        """Return the map at ``now`` if it is time to draw it; None if not, or if there is no map.

        If the clock was set back, a new period begins.
        """
        if self._source.version == self._version or 0.0 <= now - self._drawn_at < self._apart:
            return None
        self._version, self._drawn_at = self._source.version, now
        return self._source.occupancy()
