"""How late scans are against odometry, learned from how both tell the robot's turns.

Many drivers stamp a scan when it has come and not when it was taken. Of some latencies that one is
believed by which dead reckoning tells best how far matched scans turned.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from roomba.geometry import Pose, wrap_angle

_STEP: Final = 0.05
_COUNT: Final = 9
"""s; latencies from 0 on that are compared, so far apart and so many."""
_KEPT: Final = 0.99
"""Share of what was learned that counts after another scan: about the last hundred do."""
_LEAST_TURNED: Final = 0.1
"""rad2; sum of squared turns from which anything is said."""
_BETTER: Final = 0.7
"""A latency is believed whose squared errors are so much smaller than without any."""


class Latency:
    """Keeps the errors of each latency; ``seconds`` is the one to go by."""

    def __init__(self) -> None:
        """Begin without any."""
        self.seconds = 0.0
        self._errors = np.zeros(_COUNT)
        self._turned = 0.0
        self._before: list[float | None] = [None] * _COUNT

    def interrupted(self) -> None:
        """The next scan is not compared to the one before it."""
        self._before = [None] * _COUNT

    def learn(self, turn: float | None, stamp: float, at: Callable[[float], Pose | None]) -> None:
        """Take by how much a scan was turned against the one before it, rad, None if not known.

        ``stamp``, s, is the scan's; ``at`` returns the dead-reckoned pose at a time, if known.
        """
        now: list[float | None] = []
        for index in range(_COUNT):
            pose = at(stamp - index * _STEP)
            now.append(None if pose is None else pose.theta)
        before, self._before = self._before, now
        if turn is None:
            return
        reckoned = [
            wrap_angle(later - earlier)
            for later, earlier in zip(now, before, strict=True)
            if later is not None and earlier is not None
        ]
        if len(reckoned) < _COUNT:
            return
        self._errors = _KEPT * self._errors + (np.array(reckoned) - turn) ** 2
        self._turned = _KEPT * self._turned + turn * turn
        if self._turned > _LEAST_TURNED:
            best = int(np.argmin(self._errors))
            is_better = self._errors[best] < _BETTER * self._errors[0]
            self.seconds = best * _STEP if is_better else 0.0
