"""When a mission goes on with a map that has grown: as seldom as makes no difference to it."""

from __future__ import annotations

import math
from typing import Final

from roomba.grid import OccupancyMap
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Phase
from roomba.perception.slam.mapper import Mapper

_AROUND_GOAL: Final = 0.4
"""m; farther from the frontier that it is on its way to nothing tells whether it still is one."""
_PLANNING: Final = (Phase.CLEANING, Phase.EXPLORING, Phase.RETURNING)
"""In the others no way is planned: the map may wait."""


class GrowingMap:
    """Looks at the map that a mapper makes, at most once in ``period`` s while the robot drives."""

    def __init__(self, mapper: Mapper, period: float) -> None:
        """Begin with nothing shown."""
        self._mapper, self._period = mapper, period
        self._used = self._looked = 0
        self._looked_at = -math.inf
        self.is_whole = False

    @property
    def next_look(self) -> float:
        """When it is looked at the next time if it does not grow before, s."""
        is_news = not self.is_whole and self._mapper.version != self._looked
        return self._looked_at + self._period if is_news else math.inf

    def newer(self, now: float, mission: Mission) -> OccupancyMap | None:
        """Return the map at ``now``, s, if it makes a difference to the mission, else None."""
        version = self._mapper.version
        if self.is_whole:
            return None
        if mission.driver is None:
            if version == self._used or mission.state.phase not in _PLANNING:
                return None
        elif version == self._looked or now - self._looked_at < self._period:
            return None
        else:
            self._looked_at, self._looked = now, version
            if not mission.wants_map(self._around_goal(mission)):
                return None
        self._looked_at, self._looked, self._used = now, version, version
        return self._mapper.occupancy()

    def finish(self) -> OccupancyMap:
        """Return the whole map; from now on nothing is newer."""
        self.is_whole = True
        return self._mapper.finish()

    def _around_goal(self, mission: Mission) -> OccupancyMap:
        """Return the map around the mission's frontier, which is all that it asks for."""
        exploration = mission.exploration
        goal = None if exploration is None else exploration.goal
        x, y = mission.last_place if goal is None else goal.middle
        return self._mapper.occupancy_around(x, y, _AROUND_GOAL)
