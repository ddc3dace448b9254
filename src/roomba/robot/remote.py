"""A robot that cleans by its own brain: what it tells of itself, and what it can be told to do.

Nothing of it is driven from here. Once told, it goes on by itself, even when it cannot be reached
any more.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.vocabulary import Phase


class WishRefusedError(RoombaError):
    """The robot is reached, and does not do what it was told; the message has its reason."""


class RemoteWish(Enum):
    """What such a robot can be told."""

    CLEAN_HOUSE = "clean all"
    CLEAN_SPOT = "clean where it stands"
    PAUSE = "pause"
    RESUME = "go on"
    STOP = "stop"
    DOCK = "go home"
    BEEP = "beep"


@dataclass(frozen=True, slots=True)
class RemoteState:
    """What the robot does, how full its battery is (0..1), and whether it charges.

    ``trouble`` is why it needs help, in its own words; empty if it does not. ``is_taken`` says that
    another program drives it by hand.
    """

    phase: Phase
    level: float
    is_charging: bool
    trouble: str = ""
    is_taken: bool = False


class RemoteRobot(Protocol):
    """One such robot; each call has a deadline, and raises RoombaError where it is not reached."""

    def look(self) -> RemoteState:
        """Return what it does now, a few seconds old at most; the charge half a minute."""

    def scan(self) -> NDArray[np.float32]:
        """Return where its lidar's beams met something, m, float32 [n, 2].

        In the robot's frame; none while the lidar does not turn.
        """

    def tell(self, wish: RemoteWish) -> None:
        """Tell it what to do; returns when it has heard that.

        Raises WishRefusedError where it is reached and does not do it.
        """
