"""The way that viewers are shown: places where the robot was, and where it was carried between."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from roomba.ui.web.streams.told import Told

_STEP: Final = 0.03
"""m between two places of the trail."""
_MOST_PLACES: Final = 20000
_FASTEST: Final = 1.0
"""m/s that no robot drives."""
_CORRECTED: Final = 0.15
"""m by which a place may be corrected from one look to the next."""

Place = tuple[float, float] | tuple[float, float, bool]
"""x and y, m; True where the way begins anew: the robot did not drive there from the one before."""


class ShownTrail:
    """The newest places of a way that grows; viewers count the places that there ever were."""

    def __init__(self) -> None:
        """Begin with no place."""
        self._places: list[Place] = []
        self._began = 0
        """Places that there were before the first one that is kept."""
        self._told: dict[int, Told] = {}
        """What follows a count of places, until there are more."""
        self._seen: tuple[float, float, float] | None = None
        """When, s, and where it was at the last look, x and y, m."""

    @property
    def places(self) -> tuple[Place, ...]:
        """The places that are kept, the oldest first."""
        return tuple(self._places)

    def follow(self, now: float, x: float, y: float) -> None:
        """Go on to where the robot is at a time, s and m."""
        is_carried = not self._may_have_driven(now, x, y)
        self._seen = now, x, y
        if self._places and math.dist(self._places[-1][:2], (x, y)) < _STEP:
            return
        self._told.clear()
        place = round(x, 3), round(y, 3)
        self._places.append((*place, True) if is_carried else place)
        surplus = len(self._places) - _MOST_PLACES
        if surplus > 0:
            del self._places[:surplus]
            self._began += surplus

    def lose_sight(self) -> None:
        """From now on it is not known what the robot does, until it is followed again."""
        self._seen = None

    def replace(self, way: Sequence[tuple[float, float]]) -> None:
        """Let another way, places in m, be what was driven up to now."""
        self._seen = None
        self._told.clear()
        self._began += len(self._places) + 1
        self._places = [(round(x, 3), round(y, 3)) for x, y in way[-_MOST_PLACES:]]

    def since(self, count: int) -> Told | None:
        """Return the places after the first ``count`` of all that there ever were; None for none.

        It is told as the ``whole`` way to those who have none, or one that is not kept any more.
        """
        if count not in self._told:
            first = max(count - self._began, 0)
            if first >= len(self._places) and count >= self._began:
                return None
            self._told[count] = Told(
                {
                    "type": "trail",
                    "whole": count < self._began or count == 0,
                    "end": self._began + len(self._places),
                    "points": self._places[first:],
                }
            )
        return self._told[count]

    def _may_have_driven(self, now: float, x: float, y: float) -> bool:
        """Whether the robot can have come here by its wheels since it was seen last."""
        if self._seen is None:  # of what it did meanwhile nothing is known
            return not self._places or math.dist(self._places[-1][:2], (x, y)) <= _CORRECTED
        then, *before = self._seen
        reach = _FASTEST * max(now - then, 0.0) + _CORRECTED
        return math.dist(before, (x, y)) <= reach
