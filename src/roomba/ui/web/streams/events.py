"""Events of a robot for programs: what changed, as one stream that all listeners share.

Events are kept for a while by their numbers. A listener takes those after the last one that it has:
a slow one, or one that comes back, misses nothing that is still kept, and there is no queue for it.
"""

from __future__ import annotations

import asyncio
import itertools
import time
from collections import deque
from collections.abc import AsyncIterator
from typing import Any, Final

from roomba.client.plain import known, report_of
from roomba.client.protocol import CleanReport
from roomba.client.view import RobotView
from roomba.ui.web.streams.told import Told

MOST_KEPT: Final = 200
"""Events that can be had again."""
SILENCE: Final = 15.0
"""s of wall time after which a listener gets an empty line: so both sides notice a dead one."""
_AT_REST: Final = ("docked", "idle")
"""States without a run under way; one that met an error may go on."""


class Events:
    """The newest events of one robot.

    ``state``: what it does changed; ``begun`` and ``ended``: a run; ``trouble``: what is wrong,
    empty when all is well again; ``missed``: of some older ones a listener knows nothing any more.
    """

    def __init__(self) -> None:
        """Begin without events."""
        self._kept: deque[tuple[int, str]] = deque(maxlen=MOST_KEPT)
        self._numbers = itertools.count(1)
        self._came = asyncio.Event()
        self._phase = self._trouble = ""
        self._is_running: bool | None = None
        self._last: CleanReport | None = None

    @property
    def newest(self) -> int:
        """The number of the newest event; 0 before the first one."""
        return self._kept[-1][0] if self._kept else 0

    def note(self, view: RobotView) -> None:
        """Find out what changed since the last look."""
        vacuum = view.vacuum
        if vacuum.phase != self._phase:
            self._phase = vacuum.phase
            self._add("state", {**_where(view), "battery": known(vacuum.battery)})
        is_running = self._is_running if vacuum.state == "error" else vacuum.state not in _AT_REST
        if self._is_running is not None:
            self._note_run(view, is_running=bool(is_running))
        self._is_running, self._last = is_running, view.last
        self._note_trouble(view.time, vacuum.message or view.held or view.doubt)

    def _note_run(self, view: RobotView, *, is_running: bool) -> None:
        """Note that a run began, or ended, since the last look."""
        if is_running and not self._is_running:
            self._add("begun", _where(view))
        if view.last is not None and view.last != self._last:
            self._add("ended", {"time": round(view.time, 2), **report_of(view.last)})

    def note_gone(self, reason: str) -> None:
        """Note that the robot does not answer."""
        self._note_trouble(None, reason)

    async def after(self, number: int) -> AsyncIterator[str]:
        """Give all events after a number as lines of an event stream, for ever."""
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

    def _note_trouble(self, at: float | None, trouble: str) -> None:
        if trouble != self._trouble:
            self._trouble = trouble
            self._add("trouble", {"time": at, "message": trouble})

    def _add(self, kind: str, values: dict[str, Any]) -> None:
        number = next(self._numbers)
        self._kept.append((number, _lines(number, kind, values)))
        came, self._came = self._came, asyncio.Event()
        came.set()


def _where(view: RobotView) -> dict[str, Any]:
    vacuum = view.vacuum
    return {
        "time": round(view.time, 2),
        "state": vacuum.state,
        "phase": vacuum.phase,
        "room": vacuum.room,
    }


def _lines(number: int, kind: str, values: dict[str, Any]) -> str:
    """Return an event as the lines of a stream; JSON has no line breaks of its own."""
    told = Told({"type": kind, "at": round(time.time(), 3), **values})
    return f"id: {number}\nevent: {kind}\ndata: {told.text}\n\n"
