"""One errand of a live robot: it runs in the robot's thread, and other threads wait for it."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Final, Generic, TypeVar

from roomba.errors import RoombaError
from roomba.headless.embodied import Embodied
from roomba.headless.live.snapshots import ErrandsEnded
from roomba.mission.phases.machine import Event

_PERIOD: Final = 1.0
"""s of the robot's clock between two progress reports of an errand, as on ROS."""

_News = TypeVar("_News")
_Report = TypeVar("_Report")
Obey = Callable[[Callable[[Embodied], None]], None]
"""A callback that lets the robot carry out a command."""


class LiveErrand(ABC, Generic[_News, _Report]):
    """One errand of a robot: a walk, a clean, an exploration, a way to the station.

    ``obey`` lets the robot carry out a command, ``ending`` tells why the robot's time has stopped,
    and ``pace`` is the robot's seconds per second: below 1, news comes more often by its clock.
    """

    def __init__(self, obey: Obey, ending: Callable[[], str], pace: float) -> None:
        """Begin nothing yet."""
        self._obey, self._ending = obey, ending
        self._slowness = min(1.0, pace)
        self._period = _PERIOD * self._slowness
        self._told = threading.Condition()
        self._news: _News | None = None
        self._report: _Report | None = None
        self._began = self._due = 0.0

    def next_feedback(self, timeout: float) -> _News | None:
        """Wait up to ``timeout`` s of wall time for news; None if none came or the errand ended."""
        with self._told:
            self._told.wait_for(lambda: self.has_ended or self._news is not None, timeout)
            if self.report() is not None:
                return None
            news, self._news = self._news, None
            return news

    def report(self) -> _Report | None:
        """Return how the errand ended, or None while it lasts."""
        with self._told:
            if self._report is None and self._ending():
                self._report = self._lost(self._ending())
            return self._report

    def cancel(self) -> None:
        """Let the robot stop and stay."""
        self._obey(lambda robot: None if self.has_ended else self._cancel(robot))

    @property
    def has_ended(self) -> bool:
        """Whether the errand's end is known."""
        return self._report is not None

    def begin(self, robot: Embodied) -> bool:
        """Let the robot begin, and return whether it does; else the report says why not."""
        self._began = self._due = robot.now.time
        try:
            self._begin(robot)
        except (RoombaError, ValueError) as refusal:
            self._end(self._refused(str(refusal)))
        return not self.has_ended

    @abstractmethod
    def follow(self, robot: Embodied, ended: ErrandsEnded) -> None:
        """Tell how far the errand is, or how it ended."""

    @abstractmethod
    def give_way(self) -> None:
        """End, because something newer took over."""

    @abstractmethod
    def _begin(self, robot: Embodied) -> None:
        """Let the robot begin; raises RoombaError with the reason why not."""

    def _cancel(self, robot: Embodied) -> None:
        robot.mission.command(Event.STOP, robot.senses())

    @abstractmethod
    def _refused(self, reason: str) -> _Report:
        """Return the report of an errand that was not begun."""

    @abstractmethod
    def _lost(self, reason: str) -> _Report:
        """Return the report of an errand that cannot end, because the robot's time has stopped."""

    def _is_due(self, robot: Embodied) -> bool:
        """Whether it is time for news: once in each period."""
        if robot.now.time < self._due:
            return False
        self._due = robot.now.time + self._period
        return True

    def _tell(self, news: _News) -> None:
        with self._told:
            self._news = news
            self._told.notify_all()

    def _end(self, report: _Report) -> None:
        with self._told:
            self._report = report
            self._told.notify_all()
