"""How the robot moved, by its wheels' encoders and its gyro, and how sure that is."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.robot import GyroConfig, LocalizationConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.localization.belief import Rows, numbers_of, unknown_belief
from roomba.perception.localization.belief_reckon_kernels import LEFT_OUT, WAS_SET_BACK, reckon

_REMEMBERED: Final = 2.0
"""s; how late a scan may come."""

_Row = tuple[float, float, float, float]
"""Stamp, s, and a pose: x, y, theta."""


class DeadReckoning:
    """Keeps a pose in a frame of its own, in which it never jumps but slowly drifts.

    Wheels and gyro both measure each turn; they are weighted by their variances. Kernels may go on
    with its ``belief`` and ``numbers``, until :meth:`begin_history`.
    """

    def __init__(
        self, config: LocalizationConfig, gyro: GyroConfig, belief: Rows | None = None
    ) -> None:
        """Begin at the origin; the pose on the map of a ``belief`` goes along."""
        self.belief = unknown_belief() if belief is None else belief
        self._belief = self.belief[0]
        self._reckoned: NDArray[np.float64] = self._belief["reckoned"]
        self.numbers = numbers_of(config, gyro)
        self._past: deque[_Row] = deque()

    def move(self, stamp: float, odometry: Pose, turning: float | None) -> None:
        """Take the wheels' odometry and the gyro's turning speed, rad/s, if it has one, at a time.

        What is a little older than the last is left out, and so is a jump. When a clock is set back
        the way still counts, but nothing is known of the time that it took.
        """
        done = reckon(
            self.belief,
            self.numbers,
            stamp,
            odometry.x,
            odometry.y,
            odometry.theta,
            math.nan if turning is None else turning,
        )
        if done == LEFT_OUT:
            return
        if done == WAS_SET_BACK:
            self._past.clear()
        self._remember(stamp)

    def went_on(self, reckoned: NDArray[np.float64]) -> None:
        """Remember what kernels reckoned in the belief: rows [n, 4] of stamp, s, x, y, theta."""
        self._past.extend(tuple(row) for row in reckoned.tolist())
        while self._past[0][0] < self._past[-1][0] - _REMEMBERED:
            self._past.popleft()

    def begin_history(self) -> None:
        """Forget the past, as after steps that a compiled burst made in the belief."""
        self._past.clear()
        self._remember(float(self._belief["stamp"]))

    def at(self, stamp: float) -> Pose | None:
        """Return the pose at a time, between those that were told; None if that is too long ago."""
        if not self._past or stamp < self._past[0][0]:
            return None
        later = self._past[-1]
        if stamp >= later[0]:
            return Pose(*later[1:])
        for earlier in reversed(self._past):
            if earlier[0] <= stamp:
                break
            later = earlier
        share = (stamp - earlier[0]) / (later[0] - earlier[0])
        return Pose(
            earlier[1] + share * (later[1] - earlier[1]),
            earlier[2] + share * (later[2] - earlier[2]),
            wrap_angle(earlier[3] + share * wrap_angle(later[3] - earlier[3])),
        )

    def is_newest(self, stamp: float) -> bool:
        """Whether nothing newer than this was told, and something was."""
        return bool(self._past) and stamp >= self._past[-1][0]

    @property
    def pose(self) -> Pose:
        """The newest pose."""
        return Pose(*self._reckoned.tolist())

    @property
    def odometry(self) -> Pose:
        """The newest odometry, in its own frame."""
        return Pose(*self._belief["odometry"].tolist())

    def take_spread(self) -> NDArray[np.float64]:
        """Return what the pose became unsure by since this was last asked for, float64 [3, 3].

        Along the robot's present axes: ahead and left, m2, and of theta, rad2.
        """
        spread = np.diag(self._belief["spread"])
        self._belief["spread"] = 0.0
        return spread

    def _remember(self, stamp: float) -> None:
        x, y, theta = self._reckoned.tolist()
        self._past.append((stamp, x, y, theta))
        while self._past[0][0] < stamp - _REMEMBERED:
            self._past.popleft()
