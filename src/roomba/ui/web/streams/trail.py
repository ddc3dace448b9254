"""The robot's trail for viewers: where it drove, with breaks where it was carried."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from roomba.ui.web.streams.told import Told

_STEP: Final = 0.03
"""m between two places of the trail."""
_MOST_PLACES: Final = 20000
_FASTEST: Final = 1.0
"""m/s; no robot drives faster."""
_CORRECTED: Final = 0.15
"""m by which localization may correct the pose between two looks."""

Place = tuple[float, float] | tuple[float, float, bool]
"""x and y, m; a third value True: the robot was carried here, so no line leads here."""


class ShownTrail:
    """The newest places of the robot's way; viewers count all places that there ever were."""

    def __init__(self) -> None:
        """Begin with no place."""
        self._places: list[Place] = []
        self._began = 0
        """Number of places that were dropped, which came before the first kept one."""
        self._told: dict[int, Told] = {}
        """Messages with the places after a count, by that count; cleared when a place is added."""
        self._seen: tuple[float, float, float] | None = None
        """Time, s, and x and y, m, of the last look at the robot."""

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
        """Stop following: until the next look it is unknown what the robot does."""
        self._seen = None

    def replace(self, way: Sequence[tuple[float, float]]) -> None:
        """Replace the trail by another way, places in m."""
        self._seen = None
        self._told.clear()
        self._began += len(self._places) + 1
        self._places = [(round(x, 3), round(y, 3)) for x, y in way[-_MOST_PLACES:]]

    def since(self, count: int) -> Told | None:
        """Return the places after the first ``count`` of all that there ever were; None for none.

        It is marked ``whole`` for viewers that have no places, or only places that are dropped by
        now.
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
        """Whether the robot can have driven here since the last look."""
        if self._seen is None:  # unknown what the robot did meanwhile
            return not self._places or math.dist(self._places[-1][:2], (x, y)) <= _CORRECTED
        then, *before = self._seen
        reach = _FASTEST * max(now - then, 0.0) + _CORRECTED
        return math.dist(before, (x, y)) <= reach
