"""The map in the making, as the mission gets it."""

from __future__ import annotations

import math

from roomba.configuration.robot import TimingConfig
from roomba.grid import OccupancyMap
from roomba.mission.mission import Mission
from roomba.perception.slam.map_drawing import MapDrawing, MapSource


class GrowingMap:
    """Keeps the map that was drawn last, until it makes a difference to the mission.

    ``is_whole``: it grows no more.
    """

    def __init__(self, source: MapSource, timing: TimingConfig) -> None:
        """Begin with nothing drawn."""
        self._drawing = MapDrawing(source, timing)
        self._newest: OccupancyMap | None = None
        self.is_whole = False

    @property
    def next_look(self) -> float:
        """When it is drawn next if it does not grow before, s; infinite once it is whole."""
        return math.inf if self.is_whole else self._drawing.due_at

    def newer(self, now: float, mission: Mission | None) -> OccupancyMap | None:
        """Return the newest map at ``now``, s, once, if it makes a difference to the mission.

        Without a mission the first map does.
        """
        if self.is_whole:
            return None
        self._newest = self._drawing.draw(now) or self._newest
        if self._newest is None or not (mission is None or mission.wants_map(self._newest)):
            return None
        newest, self._newest = self._newest, None
        return newest
