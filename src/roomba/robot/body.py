"""What a brain needs of a body: the simulated one and drivers of real robots implement it."""

from __future__ import annotations

from typing import Protocol

from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading
from roomba.vocabulary import Reason


class Body(Protocol):
    """A robot's sensors, drive and tools.

    Its clock, by which readings are timed, goes on by a tick with each command. While it cannot be
    reached the clock may stand: then what is read has an old time.
    """

    @property
    def trouble(self) -> Reason:
        """Why the body cannot be reached, and what helps; empty while it can."""

    def read(self) -> Readings:
        """Return what the sensors tell now; a scan once."""

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""

    def act(self, command: Command) -> None:
        """Carry out a command for one tick; returns when that has passed."""

    def locate(self) -> None:
        """Beep, if the body can."""
