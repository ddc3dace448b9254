"""Follows a clean or a way to the station until it ends, or until the user has seen enough.

Unlike a walk, an errand goes on without the menu: Ctrl-C stops following it, and does not cancel
it.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator
from typing import Protocol, TypeVar

from rich.console import Console
from rich.progress import Progress

from roomba.client.clock import Clock
from roomba.client.protocol import CleanProgress, RobotUnavailableError
from roomba.shares import share_of, whole_percent
from roomba.ui.live_bar import live_bar
from roomba.ui.progress import POLL_TIME, quantity, say

ERRAND_SILENCE_LIMIT = 15.0
"""s without news after which the menu stops following an errand; news is due every second."""

LINE_PERIOD = 10.0
"""s between two plain lines while nothing changes: a clean takes an hour."""

_News = TypeVar("_News", covariant=True)
_Report = TypeVar("_Report", covariant=True)


class ErrandHandle(Protocol[_News, _Report]):
    """A clean, or a way into or out of the station."""

    def next_feedback(self, timeout: float) -> _News | None:
        """Wait up to ``timeout`` s for news."""

    def report(self) -> _Report | None:
        """Return its end, or None while it lasts."""


def follow_errand(
    errand: ErrandHandle[_News, _Report],
    show: Callable[[_News], None],
    *,
    wants_to_leave: Callable[[], bool],
    clock: Clock = time,
) -> _Report | None:
    """Show an errand until it ends, and return its report; None if the user left before.

    Raises RobotUnavailableError when no news comes for :data:`ERRAND_SILENCE_LIMIT`.
    """
    heard = clock.monotonic()
    while (report := errand.report()) is None:
        now = clock.monotonic()
        if wants_to_leave():
            return None
        if now - heard >= ERRAND_SILENCE_LIMIT:
            raise RobotUnavailableError(
                f"it has told nothing for {ERRAND_SILENCE_LIMIT:g} s; it may go on by itself"
            )
        news = errand.next_feedback(POLL_TIME)
        if news is not None:
            heard = clock.monotonic()
            show(news)
        elif errand.report() is None:
            # a client may know of the end a moment before it can report it
            clock.sleep(max(0.0, now + POLL_TIME - clock.monotonic()))
    return report


def percent(share: float) -> str:
    """Return a share, 0..1, as text; 100 % means all of it, and nothing less."""
    return f"{whole_percent(share)} %" if math.isfinite(share) else "unknown"


def time_text(seconds: float) -> str:
    """Return how long something takes for people: 50 s, 12 min, 1 h 05 min."""
    if not math.isfinite(seconds):
        return "unknown"
    if seconds < 100.0:
        return f"{max(0.0, seconds):.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02d} min"


def to_go_text(seconds: float) -> str:
    """Return the time to go as text; empty where there is none, or it is not known yet."""
    return "" if seconds <= 0.0 else f"{time_text(seconds)} to go"


def area_text(covered: float, wanted: float) -> str:
    """Return how much floor is clean, for people."""
    if not (math.isfinite(covered) and math.isfinite(wanted)):
        return "unknown"
    share = percent(share_of(covered, wanted))
    return f"{covered:.1f} of {quantity(wanted, 'm²', 1)} ({share})"


class CleanView(Protocol):
    """Somewhere to show a clean."""

    def show(self, progress: CleanProgress) -> None:
        """Show how far it is."""


class CleanLines:
    """A plain line for each new state or room, and one now and then between them."""

    def __init__(self, console: Console, clock: Clock) -> None:
        self._console, self._clock = console, clock
        self._said: tuple[str, str] | None = None
        self._said_at = -math.inf

    def show(self, progress: CleanProgress) -> None:
        """Print a line if it is time for one."""
        now, news = self._clock.monotonic(), (progress.state, progress.room)
        if news == self._said and now - self._said_at < LINE_PERIOD:
            return
        self._said, self._said_at = news, now
        parts = [
            f"Cleaned: {area_text(progress.covered, progress.wanted)}",
            progress.state,
            progress.room,
            f"battery {percent(progress.battery)}",
            to_go_text(progress.seconds_to_go),
        ]
        say(self._console, ", ".join(part for part in parts if part))


_FIELDS = ("area", "battery", "to_go", "where")
"""The texts after the bar; the last one is cut off where there is no room."""


class CleanBar:
    """A bar of what is clean, redrawn in place."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task = progress.add_task(
            "Cleaning", total=1.0, area="", battery="", to_go="", where=""
        )

    def show(self, progress: CleanProgress) -> None:
        """Move the bar."""
        share = progress.fraction if math.isfinite(progress.fraction) else 0.0
        self._progress.update(
            self._task,
            description=progress.state.capitalize(),
            completed=share,
            area=area_text(progress.covered, progress.wanted),
            where=progress.room,
            battery=f"battery {percent(progress.battery)}",
            to_go=to_go_text(progress.seconds_to_go),
            refresh=True,
        )


@contextlib.contextmanager
def clean_view(console: Console, clock: Clock) -> Iterator[CleanView]:
    """Give a view for a clean: live on a terminal, plain lines anywhere else."""
    if not console.is_interactive:
        yield CleanLines(console, clock)
        return
    # narrow: all of it should fit into 80 columns
    with live_bar(console, _FIELDS, width=8) as progress:
        yield CleanBar(progress)
