"""Where the robot came from: the way back out of a pocket."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.compilation import entry
from roomba.geometry import Point, Pose
from roomba.perception.swept.coverage_kernels import LONGEST_STEP

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
        self._places = np.zeros((_LENGTH, 2))
        self._count = np.zeros(1, np.int64)

    def add(self, x: float, y: float) -> None:
        """Remember that the robot is here; a place near to the last one is left out."""
        self.add_all(np.array([[x, y]]))

    def add_all(self, places: Floats) -> None:
        """Remember where the robot was, float64 [n, 2], m, one place after the other."""
        remember(self._places, self._count, places)

    def move(self, moved: Pose) -> None:
        """Go on in another frame, in which this one lies at ``moved``."""
        self._places[:] = moved.transform(self._places)

    def forget(self) -> None:
        """Forget all places: the robot was carried, and there is no way back."""
        self._count[0] = 0

    def back_and_on(self, plan: Callable[[Point], Floats | None]) -> tuple[Floats | None, float]:
        """Return the way back to the nearest place from which ``plan`` finds a way, and that way.

        Also how long the way back is, m. None where there is no such place.
        """
        count = int(self._count[0])
        newest = np.arange(count - 1, max(count - _LENGTH, 0) - 1, -1)
        back = self._places[newest % _LENGTH]
        for places in range(_EVERY, len(back) + 1, _EVERY):
            points = plan((float(back[places - 1, 0]), float(back[places - 1, 1])))
            if points is not None:
                way = float(np.hypot(*np.diff(back[:places], axis=0).T).sum())
                return np.concatenate((back[:places], points)), way
        return None, 0.0


@entry
def remember(kept: Floats, count: NDArray[np.int64], places: Floats) -> None:
    """Keep those of ``places``, [n, 2], m, that are not near to the one kept before.

    ``kept`` is a ring; ``count`` [1] tells how many were put there since it was begun. When a place
    is too far off for a step, the robot was carried, and the ring is begun anew there.
    """
    for number in range(places.shape[0]):
        x, y = places[number, 0], places[number, 1]
        last = (count[0] - 1) % kept.shape[0]
        off = abs(x - kept[last, 0]) + abs(y - kept[last, 1])
        if off > LONGEST_STEP:
            count[0] = 0
        if count[0] == 0 or off >= _STEP:
            at = count[0] % kept.shape[0]
            kept[at, 0], kept[at, 1] = x, y
            count[0] += 1
