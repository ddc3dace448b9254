"""When a mission goes on with a map that has grown: as seldom as makes no difference to it."""

from __future__ import annotations

import math
from typing import Final, Protocol

from roomba.grid import OccupancyMap
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Phase

_AROUND_GOAL: Final = 0.4
"""m; farther from the frontier that it is on its way to nothing tells whether it still is one."""
_BY_BEAMS: Final = (Phase.UNDOCKING, Phase.DOCKING)
"""By its station it goes by beams, and a new map would make it late."""


class MapSource(Protocol):
    """A map that grows, as a mapper makes it or as it is heard."""

    @property
    def version(self) -> int:
        """It changes whenever the map does; 0 before there is one."""

    def occupancy(self) -> OccupancyMap:
        """Return the map as it is now."""

    def occupancy_around(self, x: float, y: float, reach: float) -> OccupancyMap:
        """Return what lies up to ``reach`` m off a place of it, or more of it."""


class GrowingMap:
    """Looks at a map that grows, at most once in ``period`` s while the robot drives."""

    def __init__(self, source: MapSource, period: float) -> None:
        """Begin with nothing shown."""
        self._source, self._period = source, period
        self._used = self._looked = 0
        self._looked_at = -math.inf
        self.is_whole = False

    @property
    def next_look(self) -> float:
        """When it is looked at the next time if it does not grow before, s."""
        is_news = not self.is_whole and self._source.version != self._looked
        return self._looked_at + self._period if is_news else math.inf

    def newer(self, now: float, mission: Mission) -> OccupancyMap | None:
        """Return the map at ``now``, s, if it makes a difference to the mission, else None."""
        version = self._source.version
        if self.is_whole:
            return None
        if mission.driver is None:
            if version == self._used or mission.state.phase in _BY_BEAMS:
                return None
        elif version == self._looked or 0.0 <= now - self._looked_at < self._period:
            return None
        else:
            self._looked_at, self._looked = now, version
            if not mission.wants_map(self._around_goal(mission)):
                return None
        self._looked_at, self._looked, self._used = now, version, version
        return self._source.occupancy()

    def _around_goal(self, mission: Mission) -> OccupancyMap:
        """Return the map around the mission's frontier, which is all that it asks for."""
        exploration = mission.exploration
        goal = None if exploration is None else exploration.goal
        x, y = mission.last_place if goal is None else goal.middle
        return self._source.occupancy_around(x, y, _AROUND_GOAL)
