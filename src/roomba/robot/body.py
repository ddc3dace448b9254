"""What a brain needs of a body: the simulated one and drivers of real robots implement it."""

from __future__ import annotations

from typing import Protocol

from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading
from roomba.vocabulary import Reason


class Body(Protocol):
    """A robot's sensors, drive and tools.

    The body's clock, which times the readings, goes on by a tick with each command. While the body
    cannot be reached the clock may stand: then readings have an old time.
    """

    @property
    def trouble(self) -> Reason:
        """Why the body cannot be reached, and what helps; empty while it can."""

    def read(self) -> Readings:
        """Return what the sensors tell now; each scan is returned once."""

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""

    def act(self, command: Command) -> None:
        """Carry out a command for one tick; return when the tick has passed."""

    def locate(self) -> None:
        """Beep, if the body can."""
