"""The gyro's newest sample, as long as it tells of the same motion as the odometry."""

from __future__ import annotations

from typing import Final

_SAME_TIME: Final = 0.06
"""s; a sample so near to an odometry's time is of the same motion."""


class NewestTurning:
    """Keeps the newest sample of a gyro."""

    def __init__(self) -> None:
        """Begin with none."""
        self._sample: tuple[float, float] | None = None

    def hear(self, stamp: float, speed: float) -> None:
        """Keep a sample, rad/s, of the time ``stamp``, s."""
        self._sample = (stamp, speed)

    def at(self, stamp: float) -> float | None:
        """Return the sample, rad/s, if it is of about that time, s."""
        if self._sample is None or abs(self._sample[0] - stamp) > _SAME_TIME:
            return None
        return self._sample[1]
