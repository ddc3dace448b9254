"""Looking around: driving a little, by what is in sight, while the robot's place is not known.

Looking around needs no map and no place: the robot goes where the lidar shows room and where it has
not been yet, so that each scan shows something new.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from roomba.clock import LONGEST_TICK
from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import LookingAroundConfig
from roomba.geometry import STANDSTILL, Pose, Twist
from roomba.perception.localization.estimate import Knowledge

if TYPE_CHECKING:
    from roomba.robot.place import Place

_DIRECTIONS: Final = 36
"""Directions to go that are compared, 10 degrees apart."""


class LookAround:
    """Ticked with what is in sight; poses are those of dead reckoning, in any frame."""

    def __init__(self, body: BodyConfig, config: LookingAroundConfig) -> None:
        """Begin standing."""
        self._radius, self._config = body.radius, config
        self._visited: list[tuple[float, float]] = []
        self._target: tuple[float, float] | None = None
        self._backs_until = -math.inf
        self._was_touching = False
        self._margin = config.clearance

    def tick(self, now: float, pose: Pose, ends: NDArray[np.float64], touches: bool) -> Twist:
        """Return the wanted twist; ``ends`` float64 [n, 2 or more] are the ends of beams, m.

        ``ends`` are in the robot's frame, of the newest scan; ``touches`` tells whether bumper or
        cliff sensors found something.
        """
        config = self._config
        is_new, self._was_touching = touches and not self._was_touching, touches
        if is_new:
            self._visited.append((pose.x, pose.y))
            self._target, self._backs_until = None, now + config.backing_time
        if now < self._backs_until <= now + config.backing_time:
            return Twist(-config.backing_speed, 0.0)
        if self._target is None:
            self._target = self._next_target(pose, ends)
        return self._go(pose, ends, self._target)

    def _go(self, pose: Pose, ends: NDArray[np.float64], target: tuple[float, float]) -> Twist:
        config, bearing = self._config, pose.bearing_to(*target)
        left = pose.distance_to(*target)
        if left < config.arrival_tolerance:
            self._target = None
            return STANDSTILL
        if abs(bearing) > config.aimed:
            most = config.turning_speed
            return Twist(0.0, max(-most, min(most, 4.0 * bearing)))
        room = float(self._room(ends, np.array([0.0]))[0])
        if room < config.arrival_tolerance:
            # Something came into the way.
            self._visited.append((pose.x, pose.y))
            self._target = None
            return STANDSTILL
        return Twist(min(config.speed, left + 0.05, room), 2.0 * bearing)

    def _next_target(self, pose: Pose, ends: NDArray[np.float64]) -> tuple[float, float]:
        """Choose the point, of those with room on the way, that is farthest from where it was."""
        self._visited.append((pose.x, pose.y))
        bearings = np.arange(_DIRECTIONS) * (2.0 * math.pi / _DIRECTIONS)
        config = self._config
        for margin in (config.clearance, config.tight_clearance):
            self._margin = margin
            ways = np.minimum(self._room(ends, bearings), config.longest_leg)
            if ways.max() >= config.shortest_leg:
                break
        headings = pose.theta + bearings
        points = np.array([pose.x, pose.y]) + ways[:, None] * np.column_stack(
            (np.cos(headings), np.sin(headings))
        )
        away = np.hypot(*(points[:, None, :] - np.array(self._visited)).transpose(2, 0, 1))
        worth = np.where(ways >= min(config.shortest_leg, ways.max()), away.min(axis=1), -1.0)
        best = points[int(np.argmax(worth))]
        return float(best[0]), float(best[1])

    def _room(
        self, ends: NDArray[np.float64], bearings: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how far the body can go straight along each bearing, m, at most a long leg."""
        room = np.full(len(bearings), 2.0 * self._config.longest_leg)
        cosine, sine = np.cos(bearings)[:, None], np.sin(bearings)[:, None]
        ahead = cosine * ends[:, 0] + sine * ends[:, 1]
        aside = np.abs(cosine * ends[:, 1] - sine * ends[:, 0])
        in_way = (aside < self._radius + self._margin) & (ahead > 0.0)
        reach = np.where(in_way, ahead - self._radius - self._margin, np.inf)
        return np.minimum(room, np.maximum(reach.min(axis=1, initial=np.inf), 0.0))


class SearchDrive:
    """Lets the robot look around whenever more must be seen to find its place.

    It is ticked while the robot may drive for that. A search has its whole time from then on: a
    robot that stands where it was set down, for however long, sees nothing new by which it could be
    found.
    """

    def __init__(self, body: BodyConfig, config: LookingAroundConfig) -> None:
        """Begin with nothing to search."""
        self._body, self._config = body, config
        self._look_around: LookAround | None = None
        self._ticked = -math.inf

    def tick(self, now: float, place: Place, touches: bool) -> Twist | None:
        """Return the twist while the robot looks around, else None; ``touches``: see LookAround."""
        if not 0.0 <= now - self._ticked <= LONGEST_TICK:
            place.look_anew()
        self._ticked = now
        if place.estimate.knowledge is not Knowledge.SEARCHING:
            self._look_around = None
            return None
        sight = place.sight_to_look_around
        if sight is None:
            return None
        if self._look_around is None:
            self._look_around = LookAround(self._body, self._config)
        return self._look_around.tick(now, *sight, touches)
