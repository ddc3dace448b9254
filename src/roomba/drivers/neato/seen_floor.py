"""How far the wheels may roll ahead on floor that the drop sensors have seen.

The sensors are ahead of the wheels. Where they told a floor, no edge is nearer to a wheel than the
sensor that is least ahead: so far the wheels may roll before the sensors are asked again.
"""

from __future__ import annotations

import math

from roomba.configuration.sensors import CliffConfig
from roomba.drivers.neato.planned import Ways


class SeenFloor:
    """The floor before the wheels; ``ways`` are those of both wheels since any time, m."""

    def __init__(self, sensors: CliffConfig) -> None:
        """Know of none: the drop sensors have told nothing yet."""
        self._reach = min(sensors.radius * math.cos(math.radians(at)) for at in sensors.angles)
        self._seen_at: Ways | None = None

    def take(self, ways: Ways, *, has_edge: bool) -> None:
        """Take what the sensors told when the wheels had come so far."""
        self._seen_at = None if has_edge else ways

    def left(self, ways: Ways) -> float:
        """Return how much farther than ``ways`` a wheel may roll ahead, m."""
        if self._seen_at is None:
            return 0.0
        rolled = max(abs(now - then) for now, then in zip(ways, self._seen_at, strict=True))
        return max(0.0, self._reach - rolled)
