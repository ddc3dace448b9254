"""Following a path exactly: the loop that drives along swaths and edges."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import TrackingConfig
from roomba.control.course import course_of
from roomba.control.tracking_kernels import TRACK, along_of, off_path, track
from roomba.geometry import Pose, Twist


class PathTracker:
    """Drives along ``points``, float64 [n, 2], m, from the first to the last.

    The robot should stand near the first one; from farther away it drives to the curve.
    """

    def __init__(
        self,
        points: NDArray[np.float64],
        config: TrackingConfig,
        body: BodyConfig,
        period: float,
    ) -> None:
        """Begin at the first point; ``period`` is the time between two ticks, s."""
        self.course = course_of(points, config, body)
        rows = np.zeros(1, TRACK)
        # Two views of one row: reading a number from the plain one takes a tenth of the time.
        self.state, self._row = rows.view(np.recarray), rows[0]
        state = self.state[0]
        state.turning, state.to_turn = 1.0, math.inf
        state.acceleration, state.braking = body.max_acceleration, config.braking
        state.reach, state.reach_time = config.reach, config.reach_time
        state.gain = config.heading_gain
        state.turning_speed = min(config.turning_speed, body.max_angular_speed)
        state.turning_braking = min(config.spot_braking, body.max_angular_deceleration)
        state.aimed = config.aimed
        state.there, state.period = config.arrival_tolerance, period
        state.askew, state.slowest = config.turn_in_place_angle, config.slowest
        state.turning_delay, state.late = config.turning_delay, config.late_ticks

    def tick(self, pose: Pose, limit: float) -> Twist:
        """Return the wanted twist; ``limit`` is the speed wanted, m/s."""
        linear, angular = track(self.state[0], self.course, pose.x, pose.y, pose.theta, limit)
        return Twist(linear, angular)

    def stand(self) -> None:
        """Note that the robot stands, as it was not driven for a while."""
        self._row["speed"] = 0.0

    @property
    def is_done(self) -> bool:
        """Whether the robot is at the end of the path."""
        return bool(self._row["done"] > 0.0)

    @property
    def leg(self) -> int:
        """The leg of the path that the robot is on, from 0."""
        return int(self._row["leg"])

    @property
    def to_turn(self) -> float:
        """What was left of a turn on the spot at the last tick, rad; infinite while driving."""
        return float(self._row["to_turn"])

    @property
    def length(self) -> float:
        """Length of the whole path, m."""
        return float(self.course.stations[-1])

    @property
    def along(self) -> float:
        """How far along the path the robot is, m."""
        return along_of(self.state[0], self.course)

    @property
    def left(self) -> float:
        """How much of the path is still ahead, m."""
        return self.length - self.along

    @property
    def rest(self) -> NDArray[np.float64]:
        """The path still ahead, float64 [n, 2], m; its first point is where the robot is on it."""
        along, points, stations = self.along, self.course.points, self.course.stations
        here = [np.interp(along, stations, points[:, axis]) for axis in (0, 1)]
        return np.vstack((here, points[stations > along]))

    @property
    def aside(self) -> float:
        """How far left of the curve the robot is, m."""
        return float(self._row["aside"])

    def off_path(self, pose: Pose) -> float:
        """Return how far a pose is from the leg that the robot should be on, m."""
        return off_path(self.state[0], self.course, pose.x, pose.y)
