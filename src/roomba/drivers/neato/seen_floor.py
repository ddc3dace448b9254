"""How far the wheels may roll ahead on floor that the drop sensors have seen.

The sensors are ahead of the wheels. Where they see floor, any edge is farther ahead of a wheel than
the sensor that is least ahead. The wheels may roll that far before the sensors are asked again.
"""

from __future__ import annotations

import math

from roomba.configuration.sensors import CliffConfig


class SeenFloor:
    """The floor before the wheels; times in s, of a clock that never goes back."""

    def __init__(self, sensors: CliffConfig) -> None:
        """Know of none: the drop sensors have told nothing yet, and the robot stands."""
        self._reach = min(sensors.radius * math.cos(math.radians(at)) for at in sensors.angles)
        self._rolled = 0.0
        self._at, self._way, self._speed = 0.0, 0.0, 0.0
        self._seen: float | None = None

    def go(self, at: float, way: float, speed: float) -> None:
        """Take what the wheels were told at a time: ``way`` m of the faster one, at ``speed`` m/s.

        Any way counts: a wheel that rolls back leaves the floor that was seen as well.
        """
        self._rolled = self._most(at)
        self._at, self._way, self._speed = at, way, speed

    def take(self, at: float, *, has_edge: bool) -> None:
        """Take what the sensors saw at a time."""
        self._seen = None if has_edge else self._most(at)

    def left(self, at: float) -> float:
        """Return how far a wheel may roll ahead from where it is at a time, m."""
        if self._seen is None:
            return 0.0
        return max(0.0, self._reach - (self._most(at) - self._seen))

    def _most(self, at: float) -> float:
        """Return how far a wheel has rolled at most, m: as if it had its full speed at once."""
        return self._rolled + min(self._way, self._speed * max(0.0, at - self._at))
