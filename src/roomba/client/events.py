"""Events of a robot: what changed between two looks at it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from roomba.client.plain import known, report_of
from roomba.client.protocol import CleanReport
from roomba.client.under_way import is_running
from roomba.client.view import RobotView

EVENT_KINDS: Final = ("state", "begun", "ended", "trouble")
"""``state``: what the robot does changed; ``begun`` and ``ended``: a run; ``trouble``: what is
wrong, in words, which are empty when all is well again. Trouble that goes on is told once, though
its words change."""


@dataclass(frozen=True, slots=True)
class RobotEvent:
    """One change, with plain values for JSON; ``time`` among them is of the robot's clock, s."""

    kind: str
    values: dict[str, Any]


class EventFinder:
    """Compares each look at a robot with the one before."""

    def __init__(self) -> None:
        """Begin before the first look."""
        self._phase = self._trouble = ""
        self._is_running: bool | None = None
        self._last: CleanReport | None = None

    def look(self, view: RobotView) -> list[RobotEvent]:
        """Return what changed since the last look, in order."""
        return list(self._changes(view))

    def gone(self, reason: str) -> list[RobotEvent]:
        """Return what changed: the robot does not answer, for this reason."""
        return list(self._troubles(None, reason, reason))

    def _changes(self, view: RobotView) -> Iterator[RobotEvent]:
        vacuum = view.vacuum
        if vacuum.phase != self._phase:
            self._phase = vacuum.phase
            yield RobotEvent("state", {**_where(view), "battery": known(vacuum.battery)})
        running = is_running(vacuum, before=self._is_running)
        if self._is_running is not None:
            if running and not self._is_running:
                yield RobotEvent("begun", _where(view))
            if view.last is not None and view.last != self._last:
                yield RobotEvent("ended", {"time": round(view.time, 2), **report_of(view.last)})
        self._is_running, self._last = running, view.last
        told = vacuum.message or view.held or view.doubt
        yield from self._troubles(view.time, vacuum.hindrance.value or told, told)

    def _troubles(self, at: float | None, trouble: str, told: str) -> Iterator[RobotEvent]:
        """Yield a trouble that differs from the one before, by its code, or else by its words."""
        if trouble != self._trouble:
            self._trouble = trouble
            yield RobotEvent("trouble", {"time": at, "message": told})


def _where(view: RobotView) -> dict[str, Any]:
    vacuum = view.vacuum
    return {
        "time": round(view.time, 2),
        "state": vacuum.state,
        "phase": vacuum.phase,
        "room": vacuum.room,
    }
