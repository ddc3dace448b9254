"""Errands of a fake vacuum cleaner: cleans and ways to the station that follow a script."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from roomba.client.protocol import (
    CleanProgress,
    CleanReport,
    DockReport,
    ErrandOutcome,
    ExploreReport,
    MissedFloor,
)
from roomba.time_spent import NOT_COUNTED, TimeSpent
from roomba.vocabulary import OpenEdge, Phase

if TYPE_CHECKING:
    from roomba.client.clock import Clock

CLEANING_RATE = 0.5
"""m2/s."""
EXPLORING_RATE = 2.0
"""m2/s."""
EXPLORING_TIME = 20.0
"""s until all is known."""
HOMING_TIME = 4.0
"""s to the station."""
FEEDBACK_PERIOD = 1.0
LOST_NOTICE = 2.5
"""s from the end of the action server to the client's report of it."""

_INSTANT = 1e-9
"""s; two sums of the same waits may differ by rounding."""


@dataclass(frozen=True, slots=True)
class ErrandScript:
    """One errand: its ``outcome`` comes ``after`` s of work, if the work is not done by then.

    A refusal comes at once. After DISCONNECTED the robot goes on. A robot that ``freezes`` then
    sends no feedback and no report any more.
    """

    outcome: ErrandOutcome = ErrandOutcome.COMPLETED
    after: float = math.inf
    message: str = ""
    missed: tuple[MissedFloor, ...] = ()
    open_edges: tuple[OpenEdge, ...] = ()
    freezes: bool = False


class FakeErrand:
    """What the robot works on: ``cleans`` s of cleaning, then ``drives`` s of driving."""

    def __init__(
        self, script: ErrandScript, clock: Clock, cleans: float, drives: float, driving: Phase
    ) -> None:
        self.cancels = 0
        """How often it was asked to stop."""
        self._script, self._clock = script, clock
        self._cleans, self._drives, self._driving = cleans, drives, driving
        self._began = self._since = clock.monotonic()
        self._worked_before = 0.0
        self._is_paused = False
        self._stopped_by = ""
        self._told = 0

    @property
    def worked(self) -> float:
        """s of work until now; pauses do not count."""
        running = 0.0 if self._is_standing else self._clock.monotonic() - self._since
        return min(self._worked_before + running, self._work)

    @property
    def is_over(self) -> bool:
        """Whether the robot has nothing to do for it any more."""
        return bool(self._stopped_by) or self.worked >= self._work - _INSTANT

    @property
    def is_paused(self) -> bool:
        """Whether it waits to go on."""
        return self._is_paused and not self.is_over

    @property
    def is_fulfilled(self) -> bool:
        """Whether it came to its end as it should."""
        return self.is_over and not self._stopped_by and self._outcome in _KEPT

    @property
    def phase(self) -> Phase:
        """What the robot does for it now."""
        if self.is_paused:
            return Phase.PAUSED
        return Phase.CLEANING if self.worked < self._cleans - _INSTANT else self._driving

    @property
    def cleaned(self) -> float:
        """s of cleaning until now."""
        return min(self.worked, self._cleans)

    def cancel(self) -> None:
        """Stop and stay."""
        self.cancels += 1
        self.end("it was told to stop")

    def end(self, reason: str) -> None:
        """End it for a reason, unless it is over."""
        if not self.is_over:
            self.pause()
            self._stopped_by = reason

    def pause(self) -> None:
        """Stand until it goes on."""
        self._worked_before, self._is_paused = self.worked, True

    def resume(self) -> None:
        """Go on."""
        self._since, self._is_paused = self._clock.monotonic(), False

    @property
    def elapsed(self) -> float:
        """s since it was asked for."""
        return self._clock.monotonic() - self._began

    @property
    def ending(self) -> ErrandOutcome | None:
        """How it ended for the client, or None while it lasts."""
        if self._stopped_by:
            return ErrandOutcome.STOPPED
        return self._outcome if self._left <= _INSTANT else None

    @property
    def reason(self) -> str:
        """Why it ended so, in words."""
        return self._stopped_by or self._script.message

    def waits_for_news(self, timeout: float) -> bool:
        """Let time pass until news or the end, at most ``timeout`` s; return whether news came."""
        if self.ending is not None:
            return False
        due = max(0.0, self._told * FEEDBACK_PERIOD - self.elapsed)
        is_mute = self._is_struck_in(due) or due >= min(self._left, timeout + _INSTANT)
        self._clock.sleep(min(timeout, self._left) if is_mute else due)
        if is_mute or self.ending is not None:
            return False
        self._told += 1
        return True

    @property
    def _is_standing(self) -> bool:
        return self._is_paused or bool(self._stopped_by)

    def _is_struck_in(self, seconds: float) -> bool:
        """Whether the script has made its server silent by then."""
        silences = self._script.freezes or self._outcome is ErrandOutcome.DISCONNECTED
        worked = self.worked + (0.0 if self._is_standing else seconds)
        return silences and worked >= self._script.after - _INSTANT

    @property
    def _outcome(self) -> ErrandOutcome:
        """The outcome unless it is stopped."""
        total = self._cleans + self._drives
        if self._script.outcome is ErrandOutcome.REFUSED or self._script.after < total:
            return self._script.outcome
        return ErrandOutcome.COMPLETED

    @property
    def _work(self) -> float:
        """s of work that the robot does, unless it is stopped."""
        total = self._cleans + self._drives
        if self._outcome is ErrandOutcome.REFUSED:
            return 0.0
        if self._script.freezes or self._outcome is ErrandOutcome.DISCONNECTED:
            return total
        return min(total, self._script.after)

    @property
    def _left(self) -> float:
        """s until the client can report the end; inf while it is not in sight."""
        if self._script.freezes or self._is_paused:
            return math.inf
        if self._outcome is ErrandOutcome.DISCONNECTED:
            # What it has worked stands still at the end of its work: the clock does not.
            running = self._worked_before + self._clock.monotonic() - self._since
            return max(0.0, self._script.after + LOST_NOTICE - running)
        return max(0.0, self._work - self.worked)


_KEPT = (ErrandOutcome.COMPLETED, ErrandOutcome.DISCONNECTED)
"""Outcomes after which the robot itself is where it should be."""


class FakeClean(FakeErrand):
    """A :class:`roomba.client.protocol.CleanHandle` of ``wanted`` m2 in ``rooms``."""

    def __init__(
        self,
        script: ErrandScript,
        clock: Clock,
        wanted: float,
        rooms: Sequence[str],
        battery: float,
    ) -> None:
        super().__init__(script, clock, wanted / CLEANING_RATE, HOMING_TIME, Phase.RETURNING)
        self._wanted, self._rooms, self._battery = wanted, tuple(rooms), battery
        self._of_room = wanted / max(len(self._rooms), 1)

    def progress(self) -> CleanProgress:
        """Return how far it is."""
        share = self.cleaned / self._cleans
        index = self._index
        phase = self.phase.value
        return CleanProgress(
            state=phase,
            room=self._rooms[index] if self._rooms else "",
            covered=share * self._wanted,
            wanted=self._wanted,
            fraction=share,
            seconds_to_go=self._cleans - self.cleaned,
            battery=self._battery,
        )

    @property
    def queue(self) -> tuple[str, ...]:
        """The rooms that are still to be cleaned, the present one first."""
        return self._rooms[self._index :] if self.cleaned < self._cleans else ()

    def change_rooms(self, rooms: tuple[str, ...]) -> None:
        """Clean these after those that are done; a present room that is left out was no work."""
        self._rooms = (*self._rooms[: self._index], *rooms)
        self._wanted = self._of_room * len(self._rooms)
        self._cleans = self._wanted / CLEANING_RATE

    @property
    def _index(self) -> int:
        """The index of the room that the robot is in."""
        return min(int(self.cleaned / self._cleans * len(self._rooms)), len(self._rooms) - 1)

    def next_feedback(self, timeout: float) -> CleanProgress | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        return self.progress() if self.waits_for_news(timeout) else None

    def report(self) -> CleanReport | None:
        """Return the scripted end once its time has come."""
        outcome = self.ending
        if outcome is None:
            return None
        is_known = outcome is not ErrandOutcome.DISCONNECTED
        return CleanReport(
            outcome=outcome,
            message=self.reason,
            covered=self.progress().covered,
            wanted=self._wanted,
            dirt=1.5 * self.progress().covered if is_known else math.nan,
            distance=0.25 * self.worked if is_known else math.nan,
            duration=self.elapsed,
            energy=0.01 * self.worked if is_known else math.nan,
            missed=self._script.missed,
            times=self._times() if is_known else NOT_COUNTED,
            open_edges=self._script.open_edges,
        )

    def _times(self) -> TimeSpent:
        """Return a time of which half the work is the least, and a quarter turning."""
        half = 0.5 * self.worked
        waited = max(self.elapsed - self.worked, 0.0)
        return TimeSpent(half, 1.5 * half, turning=0.5 * half, waiting=waited)


class FakeExploring(FakeErrand):
    """A :class:`roomba.client.protocol.ExploringHandle`; it maps :data:`EXPLORING_RATE`."""

    def next_feedback(self, timeout: float) -> float | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        return self._known if self.waits_for_news(timeout) else None

    def report(self) -> ExploreReport | None:
        """Return the scripted end once its time has come."""
        outcome = self.ending
        if outcome is None:
            return None
        is_known = outcome is not ErrandOutcome.DISCONNECTED
        way = 0.25 * self.worked if is_known else math.nan
        edges = self._script.open_edges
        return ExploreReport(outcome, self.reason, self._known, way, self.elapsed, edges)

    @property
    def _known(self) -> float:
        return EXPLORING_RATE * self.worked


class FakeDocking(FakeErrand):
    """A :class:`roomba.client.protocol.DockingHandle`."""

    def next_feedback(self, timeout: float) -> str | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        return self.phase.value if self.waits_for_news(timeout) else None

    def report(self) -> DockReport | None:
        """Return the scripted end once its time has come."""
        return None if self.ending is None else DockReport(self.ending, self.reason)
