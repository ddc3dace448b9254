"""What is seen on a path before the robot: how far the path is clear."""

from __future__ import annotations

from typing import Final

from roomba.mission.driving.obstacles import Obstacles, Way

_HORIZON: Final = 2.0
"""m; so far ahead a path is looked at."""
LEAVING: Final = 0.25
"""m; on so much of a new path the robot may still be near to what the path goes around."""
_NEVER: Final = -1


class WayAhead:
    """Looks along a path, and again when other things stand there or the robot has come farther.

    Up to ``clear_to``, m along the path, nothing that is known is in the way.
    """

    def __init__(
        self, way: Way, obstacles: Obstacles, look_ahead: float, leaves_until: float = 0.0
    ) -> None:
        """Begin before the first look.

        The path is clear until ``look_ahead`` m before the first thing; before ``leaves_until``, m
        along the path, no thing counts.
        """
        self._way, self._obstacles = way, obstacles
        self._look_ahead, self._leaves_until = look_ahead, leaves_until
        self._checked = _NEVER
        self.clear_to = 0.0
        self.blocked_at: float | None = None
        """Where the first thing stands in the way, m along the path, as of the last look."""

    @property
    def is_current(self) -> bool:
        """Whether nothing came or went since the last look."""
        return self._checked == self._obstacles.version

    def is_blocked(self, along: float) -> bool:
        """Whether the path is not clear any more for a robot that is ``along``, m."""
        if not self.is_current or along >= self.clear_to:
            self._look(along)
        return along >= self.clear_to

    def _look(self, along: float) -> None:
        self._checked = self._obstacles.version
        # What the path was just planned to leave is not in the way.
        first, last = max(along, self._leaves_until), along + _HORIZON
        # A path that begins beside a thing is the way out of there: station 0 does not count.
        self.blocked_at = self._obstacles.first_in_way(self._way, first, last) or None
        clear = last if self.blocked_at is None else self.blocked_at
        self.clear_to = clear - self._look_ahead
