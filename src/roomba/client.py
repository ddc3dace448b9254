"""What a user interface may ask of a robot: a protocol that ROS implements and a fake for tests.

Answers are immutable snapshots. Metres, m/s and seconds of the robot's clock; the map frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError


class RobotUnavailableError(RoombaError):
    """The robot, or the part of it that was asked, does not answer."""


class RequestRefusedError(RoombaError):
    """The robot answered that it will not do what was asked; the message is its reason."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Where and how fast the robot may go: both coordinates from ``low`` to ``high``."""

    low: float
    high: float
    max_speed: float


@dataclass(frozen=True, slots=True)
class RobotState:
    """The newest values the robot has told; ``dirt`` in g under its body.

    ``doubt`` says why it does not know well where it is, and what helps; empty if it does.
    """

    x: float
    y: float
    speed: float
    dirt: float
    doubt: str = ""


class WalkOutcome(Enum):
    """How a walk ended."""

    ARRIVED = "arrived"
    CANCELLED = "cancelled"
    REFUSED = "refused"
    """Never begun: the destination cannot be walked to."""
    FAILED = "failed"
    """Given up on the way."""
    LOST = "lost"
    """The action server vanished while it walked."""


@dataclass(frozen=True, slots=True)
class WalkReport:
    """The end of a walk; ``distance`` is what was really travelled, ``duration`` what it took."""

    outcome: WalkOutcome
    distance: float
    duration: float
    message: str


class Walk(Protocol):
    """A walk under way."""

    def next_feedback(self, timeout: float) -> float | None:
        """Wait up to ``timeout`` s of wall time for news: the path distance left, m, else None.

        Returns None at once when the walk has ended; then there is a report.
        """

    def report(self) -> WalkReport | None:
        """Return the end of the walk, or None while it lasts."""

    def cancel(self) -> None:
        """Ask the robot to stop, without waiting; the report follows."""


class RobotClient(Protocol):
    """A robot as its user interfaces see it."""

    def limits(self) -> Limits:
        """Return the limits in force now."""

    def station(self) -> tuple[float, float]:
        """Return where the charging station is."""

    def state(self, timeout: float = 5.0) -> RobotState:
        """Return the newest state; RobotUnavailableError when none comes in ``timeout`` s.

        A value that the robot has not told for a few seconds counts as none.
        """

    def path_length(self, x: float, y: float) -> float:
        """Return the length of the way to a point, m.

        Raises RequestRefusedError with the reason, RobotUnavailableError when nobody answers.
        """

    def walk_to(self, x: float, y: float) -> Walk:
        """Start walking; raises RobotUnavailableError when no action server answers."""


class CameraClient(Protocol):
    """The robot's camera as its users see it."""

    def picture(self, degrees: float) -> NDArray[np.uint8]:
        """Return the picture nearest to an angle, uint8 [height, width, 3] RGB.

        Raises RobotUnavailableError (no camera service within 5 s) or RequestRefusedError.
        """
