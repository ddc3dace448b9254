"""A robot's events for programs: changes, in one stream that all listeners share.

Events are kept for a while by number. A listener takes those after the last number it has. So a
slow listener, or one that comes back, misses nothing that is still kept, and needs no queue.
"""

from __future__ import annotations

import asyncio
import itertools
import time
from collections import deque
from collections.abc import AsyncIterator
from typing import Any, Final

from roomba.client.events import EventFinder, RobotEvent
from roomba.client.view import RobotView
from roomba.ui.web.streams.told import Told

MOST_KEPT: Final = 200
"""Events that can be had again."""
SILENCE: Final = 15.0
"""s of wall time after which a listener gets an empty line: so both sides notice a dead one."""


class Events:
    """The newest events of one robot, found by :class:`roomba.client.events.EventFinder`.

    The event ``missed`` tells a listener that older events are no longer kept.
    """

    def __init__(self, first: int = 1) -> None:
        """Begin without events; ``first`` is the number of the first one, above 0."""
        self._first = first
        self._kept: deque[tuple[int, str]] = deque(maxlen=MOST_KEPT)
        self._numbers = itertools.count(first)
        self._came = asyncio.Event()
        self._finder = EventFinder()

    @property
    def newest(self) -> int:
        """The number of the newest event; one less than the first number before there is one."""
        return self._kept[-1][0] if self._kept else self._first - 1

    def note(self, view: RobotView) -> list[RobotEvent]:
        """Find out what changed since the last look, keep it, and return it."""
        return self._keep(self._finder.look(view))

    def note_gone(self, reason: str) -> list[RobotEvent]:
        """Note that the robot does not answer."""
        return self._keep(self._finder.gone(reason))

    async def after(self, number: int) -> AsyncIterator[str]:
        """Yield all events after a number as lines of an event stream, for ever; 0: all.

        A number of an earlier server does not count here: how many events were missed is unknown.
        """
        if number and not self._first - 1 <= number <= self.newest:
            number = self._first - 1
            yield _lines(number, "missed", {"count": None})
        while True:
            came = self._came
            kept = [(at, text) for at, text in self._kept if at > number]
            if number and kept and kept[0][0] > number + 1:
                yield _lines(kept[0][0] - 1, "missed", {"count": kept[0][0] - 1 - number})
            for at, text in kept:
                number = at
                yield text
            if not kept:
                try:
                    await asyncio.wait_for(came.wait(), SILENCE)
                except asyncio.TimeoutError:
                    yield ":\n\n"

    def _keep(self, found: list[RobotEvent]) -> list[RobotEvent]:
        for event in found:
            number = next(self._numbers)
            self._kept.append((number, _lines(number, event.kind, event.values)))
        if found:
            came, self._came = self._came, asyncio.Event()
            came.set()
        return found


def first_of(now: float) -> int:
    """Return the number of the first event of a server that begins ``now``, s since 1970.

    It is above all numbers of an earlier server, which notes less than one event in a millisecond.
    """
    return round(1000.0 * now)


def _lines(number: int, kind: str, values: dict[str, Any]) -> str:
    """Return an event as the lines of a stream; JSON has no line breaks of its own."""
    told = Told({"type": kind, "at": round(time.time(), 3), **values})
    return f"id: {number}\nevent: {kind}\ndata: {told.text}\n\n"
