"""The record of a headless run: a row of numbers for each tick."""

from __future__ import annotations

from typing import Final

TIME: Final = 0
TRUE: Final = slice(1, 4)
BELIEVED: Final = slice(4, 7)
ODOMETRY: Final = slice(7, 10)
GYRO: Final = 10
PASSED: Final = 11
"""Columns of a tick that passed: t, s; x, y (m) and theta (rad), true, as believed, and by the
wheels; the gyro's turning speed, rad/s."""
POSES: Final = slice(0, 4)
"""Of these, the time and the true pose."""
