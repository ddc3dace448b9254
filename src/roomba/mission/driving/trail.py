"""Where the robot came from: the way back out of a pocket."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.planning.path.costmap import Point

Floats = NDArray[np.float64]

_STEP: Final = 0.05
"""m; between two places that are remembered."""
_LENGTH: Final = 100
"""Places: the last five metres."""
_EVERY: Final = 4
"""Stride over the places that are tried as a start."""


class Trail:
    """The places where the robot was last, m, map frame."""

    def __init__(self) -> None:
        """Begin anywhere."""
        self._places: deque[Point] = deque(maxlen=_LENGTH)

    def add(self, x: float, y: float) -> None:
        """The robot is here; what is near to the last place is left out."""
        if self._places:
            last_x, last_y = self._places[-1]
            if abs(x - last_x) + abs(y - last_y) < _STEP:
                return
        self._places.append((x, y))

    def forget(self) -> None:
        """The robot was carried: there is no way back."""
        self._places.clear()

    def back_and_on(self, plan: Callable[[Point], Floats | None]) -> tuple[Floats | None, float]:
        """Return the way back to the nearest place from which ``plan`` finds one, and that one.

        Also how long the way back is, m. None where there is no such place.
        """
        back = np.array(self._places, np.float64).reshape(-1, 2)[::-1]
        for count in range(_EVERY, len(back) + 1, _EVERY):
            points = plan((float(back[count - 1, 0]), float(back[count - 1, 1])))
            if points is not None:
                way = float(np.hypot(*np.diff(back[:count], axis=0).T).sum())
                return np.concatenate((back[:count], points)), way
        return None, 0.0
