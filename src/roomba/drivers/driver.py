"""The interface of a driver: it speaks a robot's protocol on a line, for the brain."""

from __future__ import annotations

from typing import Protocol

from roomba.drivers.line import LineError
from roomba.robot.command import Command
from roomba.robot.readings import Readings, ScanReading

__all__ = ["Driver", "LineError"]


class Driver(Protocol):
    """One robot on a line.

    The first four methods are for the thread of the brain and return at once; the others are for
    the one thread that serves the line, :class:`roomba.drivers.line_body.LineBody`. A program that
    hangs or dies sends no more commands: the robot stands within 0.5 s after the last one.
    """

    def read(self) -> Readings:
        """Return what the robot told last, at the time of now; each scan is returned once."""

    def newest_scan(self) -> ScanReading | None:
        """Return the newest scan; None before the first one."""

    def act(self, command: Command) -> None:
        """Take the wanted command; without another one the robot stands soon."""

    def locate(self) -> None:
        """Let the robot beep soon."""

    def begin(self) -> None:
        """Take the robot over, for the first time or after its line was gone; raises LineError."""

    def serve(self) -> None:
        """Do what is due on the line; this takes some 0.1 s at most, longer only for a scan.

        Raises LineError, after which :meth:`begin` is due.
        """

    def end(self) -> None:
        """Let the robot stand, and give it back; raises nothing."""
