"""The record of a headless run: a row of numbers for each tick, and what its columns are."""

from __future__ import annotations

from typing import Final

TIME: Final = 0
"""s of the robot's clock."""
TRUE: Final = slice(1, 4)
"""x, y, m, and theta, rad: where the robot is, map frame."""
BELIEVED: Final = slice(4, 7)
"""The same as the robot believes it."""
ODOMETRY: Final = slice(7, 10)
"""The same by the wheels, in their own frame."""
GYRO: Final = 10
"""The gyro's turning speed, rad/s."""
BIAS: Final = 11
"""What the robot knows of the gyro's bias, rad/s."""
PASSED: Final = 12
"""How many columns there are."""
POSES: Final = slice(0, 4)
"""The time and the true pose."""
