"""Poses, twists and angles in the plane.

SI units; angles in radians, counter-clockwise from the x axis (REP-103).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
"""x, y, m."""

TWO_PI = 2.0 * math.pi
FARTHEST = 1e5
"""m; no place of a home is farther than this from the origin of its frame."""


def heading_of(x: float, y: float, z: float, w: float) -> float:
    """Return the heading, rad, of a quaternion of any length, without its tilt; 0 of zeros."""
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def wrap_angle(angle: float) -> float:
    """Return the same direction in (-pi, pi], rad; NaN of what is not finite."""
    if abs(angle) > TWO_PI:
        angle = math.copysign(abs(angle) % TWO_PI, angle)
    if angle > math.pi:
        return angle - TWO_PI
    return angle if angle > -math.pi else angle + TWO_PI


@dataclass(frozen=True, slots=True)
class Twist:
    """Velocity of a planar body in its own frame: forward, m/s, and turning left, rad/s."""

    linear: float = 0.0
    angular: float = 0.0

    @property
    def is_finite(self) -> bool:
        """Whether both parts are numbers that can be driven."""
        return math.isfinite(self.linear) and math.isfinite(self.angular)


STANDSTILL = Twist()
RoundObstacle = tuple[float, float, float]
"""x, y and radius of a round thing that the map does not show, m, map frame."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Position, m, and heading, rad, of one frame in another."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    @property
    def is_finite(self) -> bool:
        """Whether all three are numbers that a robot can stand at."""
        return all(map(math.isfinite, (self.x, self.y, self.theta)))

    def as_array(self) -> NDArray[np.float64]:
        """Return x, y, m, and theta, rad: a new array, [3], as compiled code takes poses."""
        return np.array([self.x, self.y, self.theta])

    def compose(self, other: Pose) -> Pose:
        """Return ``other``, given in this pose's frame, in the frame that this pose is given in."""
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        return Pose(
            self.x + cosine * other.x - sine * other.y,
            self.y + sine * other.x + cosine * other.y,
            wrap_angle(self.theta + other.theta),
        )

    def transform(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points, given in this pose's frame, in the frame that this pose is given in.

        float64 [n, 2 or more]: x, y, m; further columns stay as they are.
        """
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        moved = points.copy()
        moved[:, 0] = self.x + cosine * points[:, 0] - sine * points[:, 1]
        moved[:, 1] = self.y + sine * points[:, 0] + cosine * points[:, 1]
        return moved

    def place_of(self, x: float, y: float) -> tuple[float, float]:
        """Return a point, m, of this pose's frame in the frame that this pose is given in."""
        there = self.compose(Pose(x, y))
        return there.x, there.y

    def inverse(self) -> Pose:
        """Return the pose that undoes this one: ``p.compose(p.inverse())`` is the identity."""
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        return Pose(-cosine * self.x - sine * self.y, sine * self.x - cosine * self.y, -self.theta)

    def distance_to(self, x: float, y: float) -> float:
        """Return the straight distance to a point of the same frame, m."""
        return math.hypot(x - self.x, y - self.y)

    def bearing_to(self, x: float, y: float) -> float:
        """Return the angle from this heading to a point of the same frame, rad in (-pi, pi]."""
        return wrap_angle(math.atan2(y - self.y, x - self.x) - self.theta)


def old_in_new(before: Pose, after: Pose) -> Pose:
    """Return the pose of an old frame in a new one, from one place given in both.

    The place is ``before`` in the old frame and ``after`` in the new one. The result is exactly the
    identity where both are the same.
    """
    return Pose() if before == after else after.compose(before.inverse())
