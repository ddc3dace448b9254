"""How the robot moved, by its wheels' encoders and its gyro, and how sure that is."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.config import FASTEST_SPEED, GyroConfig, LocalizationConfig
from roomba.geometry import Pose, wrap_angle

_STANDS: Final = 1e-4
"""m and rad; encoders that went on by less than this stood still."""
_SETTLING: Final = 0.3
"""s; so long after it stopped the gyro of a robot that stands shows its bias alone."""
_REMEMBERED: Final = 2.0
"""s; how late a scan may come."""
SET_BACK: Final = 0.1
"""s; a time so much before the last one is of a clock that was set back."""
_UNSEEN: Final = 0.3
"""Share of a change of the turning speed between two samples: so unsure its mean is."""
_JOLT: Final = 0.05
"""s; what a step may be quicker than the fastest robot's: its time is not exact."""
_LONGEST_STEP: Final = 1.0
"""s; the gyro says nothing of a time that was not sampled."""


class DeadReckoning:
    """Keeps a pose in a frame of its own, in which it never jumps but slowly drifts.

    Wheels and gyro both measure each turn; the one counts that is the surer by what is known of
    its errors.
    """

    def __init__(self, config: LocalizationConfig, gyro: GyroConfig) -> None:
        """Begin at the origin."""
        self._config, self._gyro = config, gyro
        self._odometry: Pose | None = None
        self._stamp = -math.inf
        self._past: deque[tuple[float, Pose]] = deque()
        self._turning: float | None = None
        self._bias = 0.0
        self._samples = 0
        self._still_since = math.inf
        self.pose = Pose()
        self._spread = np.zeros((3, 3))

    def move(self, stamp: float, odometry: Pose, turning: float | None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if it has one, at a time.

        What is a little older than the last is left out, and so is a jump. When a clock is set back
        the way still counts, but nothing is known of the time that it took.
        """
        since = stamp - self._stamp
        if since <= 0.0:
            if since > -SET_BACK:
                return
            self._past.clear()
        step = Pose() if self._odometry is None else self._odometry.inverse().compose(odometry)
        if 0.0 < since < math.hypot(step.x, step.y) / FASTEST_SPEED - _JOLT:
            # No robot goes as fast: whoever counts the wheels began anew.
            step = Pose()
        is_timed = since > 0.0 and self._odometry is not None
        elapsed = min(since, _LONGEST_STEP) if is_timed else 0.0
        self._odometry, self._stamp = odometry, stamp
        self._go(step, turning, elapsed)
        self._past.append((stamp, self.pose))
        while self._past[0][0] < stamp - _REMEMBERED:
            self._past.popleft()

    def at(self, stamp: float) -> Pose | None:
        """Return the pose at a time, between those that were told; None if that is too long ago."""
        if not self._past or stamp < self._past[0][0]:
            return None
        later_stamp, later = self._past[-1]
        if stamp >= later_stamp:
            return later
        for earlier_stamp, earlier in reversed(self._past):
            if earlier_stamp <= stamp:
                break
            later_stamp, later = earlier_stamp, earlier
        share = (stamp - earlier_stamp) / (later_stamp - earlier_stamp)
        return Pose(
            earlier.x + share * (later.x - earlier.x),
            earlier.y + share * (later.y - earlier.y),
            wrap_angle(earlier.theta + share * wrap_angle(later.theta - earlier.theta)),
        )

    @property
    def odometry(self) -> Pose:
        """The newest odometry, in its own frame."""
        return self._odometry or Pose()

    def _go(self, step: Pose, turning: float | None, elapsed: float) -> None:
        """Move by a step of the wheels, bent to the turn that is believed."""
        config = self._config
        way = math.hypot(step.x, step.y)
        self._learn_bias(self._stamp, way, step.theta, turning)
        turn, variance = self._turn(way, step.theta, turning, elapsed)
        arc = Pose(0.0, 0.0, 0.5 * (turn - step.theta)).compose(Pose(step.x, step.y, 0.0))
        self.pose = self.pose.compose(Pose(arc.x, arc.y, turn))
        self._spread[0, 0] += config.way_noise**2 * way
        self._spread[1, 1] += config.side_noise**2 * way
        self._spread[2, 2] += variance

    def _learn_bias(self, stamp: float, way: float, turn: float, turning: float | None) -> None:
        """While the wheels stand, the mean of what the gyro shows is its bias."""
        if way > _STANDS or abs(turn) > _STANDS or turning is None:
            self._still_since, self._samples = math.inf, 0
            return
        self._still_since = min(self._still_since, stamp)
        # What turns faster than any bias is a robot that somebody turns.
        if stamp - self._still_since < _SETTLING or abs(turning) > 5.0 * self._worst_bias:
            return
        self._samples += 1
        gain = 1.0 / (self._samples + 20.0)
        self._bias += gain * (turning - self._bias)

    @property
    def _worst_bias(self) -> float:
        return 4.0 * self._gyro.bias + 4.0 * self._gyro.noise

    def _turn(
        self, way: float, wheels: float, turning: float | None, elapsed: float
    ) -> tuple[float, float]:
        """Return the turn, rad, of both measurements weighed, and its variance, rad2."""
        config = self._config
        before, self._turning = self._turning, turning
        by_wheels = config.wheel_turn_noise**2 * way + config.turn_noise**2 * abs(wheels) + 1e-9
        if turning is None or elapsed == 0.0:
            return wheels, by_wheels
        before = turning if before is None else before
        gyro = (0.5 * (before + turning) - self._bias) * elapsed
        by_gyro = (self._gyro.noise * elapsed) ** 2 + config.gyro_drift**2 * elapsed
        by_gyro += config.turn_noise**2 * abs(gyro)
        # Sampled now and then, it does not know how the turning changed in between.
        by_gyro += (_UNSEEN * (turning - before) * elapsed) ** 2
        # What the wheels say beside the gyro may be slip.
        by_wheels += (gyro - wheels) ** 2
        share = by_wheels / (by_wheels + by_gyro)
        return wheels + share * (gyro - wheels), share * by_gyro

    def take_spread(self) -> NDArray[np.float64]:
        """Return what the pose became unsure by since this was last asked for, float64 [3, 3].

        Along the robot's present axes: ahead and left, m2, and of theta, rad2.
        """
        spread, self._spread = self._spread, np.zeros((3, 3))
        return spread
