"""Looking around: driving a little, by what is in sight, while the robot's place is not known.

It needs no map and no place: it goes where the lidar shows room and where it has not been yet, so
that each scan shows something new.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import BodyConfig
from roomba.geometry import Pose, Twist
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.localization.localizer import Localizer

SPEED: Final = 0.25
"""m/s; slow, among unknown things."""
TURNING: Final = 1.5
"""rad/s."""
_MARGINS: Final = (0.06, 0.02)
"""m; clearance to all that is in sight; less only where there is no other way to go."""
_LONGEST_LEG: Final = 1.5
"""m; the longest leg."""
_SHORTEST_LEG: Final = 0.15
"""m; shorter legs are driven only where there is no longer one."""
_THERE: Final = 0.02
"""m; so near to where it goes, or to what is in its way, a leg has ended."""
_DIRECTIONS: Final = 36
_AIMED: Final = 0.08
"""rad; tolerance of the heading before it drives."""
_BACKING: Final = 0.8
"""s; how long it backs away from what it touched."""


class LookAround:
    """Ticked with what is in sight; poses are those of dead reckoning, in any frame."""

    def __init__(self, body: BodyConfig) -> None:
        """Begin standing."""
        self._radius = body.radius
        self._visited: list[tuple[float, float]] = []
        self._target: tuple[float, float] | None = None
        self._backs_until = -math.inf
        self._was_touching = False
        self._margin = _MARGINS[0]

    def tick(self, now: float, pose: Pose, ends: NDArray[np.float64], touches: bool) -> Twist:
        """Return the wanted twist; ``ends`` float64 [n, 2 or more] are the ends of beams, m.

        ``ends`` are in the robot's frame, of the newest scan; ``touches`` tells whether bumper or
        cliff sensors found something.
        """
        is_new, self._was_touching = touches and not self._was_touching, touches
        if is_new:
            self._visited.append((pose.x, pose.y))
            self._target, self._backs_until = None, now + _BACKING
        if now < self._backs_until <= now + _BACKING:
            return Twist(-0.4 * SPEED, 0.0)
        if self._target is None:
            self._target = self._next_target(pose, ends)
        return self._go(pose, ends, self._target)

    def _go(self, pose: Pose, ends: NDArray[np.float64], target: tuple[float, float]) -> Twist:
        bearing = pose.bearing_to(*target)
        left = pose.distance_to(*target)
        if left < _THERE:
            self._target = None
            return Twist()
        if abs(bearing) > _AIMED:
            return Twist(0.0, max(-TURNING, min(TURNING, 4.0 * bearing)))
        room = float(self._room(ends, np.array([0.0]))[0])
        if room < _THERE:
            # Something came into the way.
            self._visited.append((pose.x, pose.y))
            self._target = None
            return Twist()
        return Twist(min(SPEED, left + 0.05, room), 2.0 * bearing)

    def _next_target(self, pose: Pose, ends: NDArray[np.float64]) -> tuple[float, float]:
        """Choose the point, of those with room on the way, that is farthest from where it was."""
        self._visited.append((pose.x, pose.y))
        bearings = np.arange(_DIRECTIONS) * (2.0 * math.pi / _DIRECTIONS)
        for margin in _MARGINS:
            self._margin = margin
            ways = np.minimum(self._room(ends, bearings), _LONGEST_LEG)
            if ways.max() >= _SHORTEST_LEG:
                break
        headings = pose.theta + bearings
        points = np.array([pose.x, pose.y]) + ways[:, None] * np.column_stack(
            (np.cos(headings), np.sin(headings))
        )
        away = np.hypot(*(points[:, None, :] - np.array(self._visited)).transpose(2, 0, 1))
        worth = np.where(ways >= min(_SHORTEST_LEG, ways.max()), away.min(axis=1), -1.0)
        best = points[int(np.argmax(worth))]
        return float(best[0]), float(best[1])

    def _room(
        self, ends: NDArray[np.float64], bearings: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how far the body can go straight along each bearing, m, at most a long leg."""
        room = np.full(len(bearings), 2.0 * _LONGEST_LEG)
        cosine, sine = np.cos(bearings)[:, None], np.sin(bearings)[:, None]
        ahead = cosine * ends[:, 0] + sine * ends[:, 1]
        aside = np.abs(cosine * ends[:, 1] - sine * ends[:, 0])
        in_way = (aside < self._radius + self._margin) & (ahead > 0.0)
        reach = np.where(in_way, ahead - self._radius - self._margin, np.inf)
        return np.minimum(room, np.maximum(reach.min(axis=1, initial=np.inf), 0.0))


class SearchDrive:
    """Lets the robot look around whenever its localizer needs to see more."""

    def __init__(self, body: BodyConfig) -> None:
        """Begin with nothing to search."""
        self._body = body
        self._look_around: LookAround | None = None

    def tick(self, now: float, localizer: Localizer, touches: bool) -> Twist | None:
        """Return the wanted twist while it looks around, else None; ``touches`` as LookAround."""
        if localizer.estimate.knowledge is not Knowledge.SEARCHING:
            self._look_around = None
            return None
        if localizer.view is None or not localizer.needs_to_look_around:
            return None
        if self._look_around is None:
            self._look_around = LookAround(self._body)
        return self._look_around.tick(now, localizer.reckoned, localizer.view.ends, touches)
