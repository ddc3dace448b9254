"""The vacuum cleaner in :class:`roomba.fake_client.FakeRobot`: it cleans by a script, not floor."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from roomba.client import (
    CleanMode,
    CleanProgress,
    CleanReport,
    DockReport,
    ErrandOutcome,
    FanLevel,
    MissedFloor,
    RequestRefusedError,
    RobotUnavailableError,
    VacuumSnapshot,
)

if TYPE_CHECKING:
    from roomba.fake_client import Clock

ROOM_AREA = 4.0
SPOT_AREA = 2.25
"""m2 of a room, and of any other thing to be cleaned."""
CLEANING_RATE = 0.5
"""m2/s."""
HOMING_TIME = 4.0
UNDOCKING_TIME = 2.0
"""s to the station, and out of it."""
FEEDBACK_PERIOD = 1.0
LOST_NOTICE = 2.5
"""s from the end of the action server to the client's report of it."""

_INSTANT = 1e-9
"""s; two sums of the same waits may differ by rounding."""


@dataclass(frozen=True, slots=True)
class ErrandScript:
    """One errand: its ``outcome`` comes ``after`` s of work, if the work is not done by then.

    A refusal comes at once. LOST is the client's: the robot goes on. One that ``freezes`` then
    tells and reports no more.
    """

    outcome: ErrandOutcome = ErrandOutcome.COMPLETED
    after: float = math.inf
    message: str = ""
    missed: tuple[MissedFloor, ...] = ()
    freezes: bool = False


class FakeErrand:
    """What the robot works on: ``cleans`` s of cleaning, then ``drives`` s of driving."""

    def __init__(
        self, script: ErrandScript, clock: Clock, cleans: float, drives: float, driving: str
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
    def phase(self) -> str:
        """What the robot does for it now."""
        if self.is_paused:
            return "paused"
        return "cleaning" if self.worked < self._cleans - _INSTANT else self._driving

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
        """Let time pass until there is news or the end, at most ``timeout`` s; whether news."""
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
        silences = self._script.freezes or self._outcome is ErrandOutcome.LOST
        worked = self.worked + (0.0 if self._is_standing else seconds)
        return silences and worked >= self._script.after - _INSTANT

    @property
    def _outcome(self) -> ErrandOutcome:
        """What it comes to if nobody stops it."""
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
        if self._script.freezes or self._outcome is ErrandOutcome.LOST:
            return total
        return min(total, self._script.after)

    @property
    def _left(self) -> float:
        """s until the client can report the end; inf while it is not in sight."""
        if self._script.freezes or self._is_paused:
            return math.inf
        if self._outcome is ErrandOutcome.LOST:
            # What it has worked stands still at the end of its work: the clock does not.
            running = self._worked_before + self._clock.monotonic() - self._since
            return max(0.0, self._script.after + LOST_NOTICE - running)
        return max(0.0, self._work - self.worked)


_KEPT = (ErrandOutcome.COMPLETED, ErrandOutcome.LOST)
"""Outcomes after which the robot itself is where it should be."""


class FakeClean(FakeErrand):
    """A :class:`roomba.client.Clean` of ``wanted`` m2 in ``rooms``."""

    def __init__(
        self,
        script: ErrandScript,
        clock: Clock,
        wanted: float,
        rooms: Sequence[str],
        battery: float,
    ) -> None:
        super().__init__(script, clock, wanted / CLEANING_RATE, HOMING_TIME, "returning")
        self._wanted, self._rooms, self._battery = wanted, rooms, battery

    def progress(self) -> CleanProgress:
        """Return how far it is."""
        share = self.cleaned / self._cleans
        index = min(int(share * len(self._rooms)), len(self._rooms) - 1)
        phase = self.phase
        return CleanProgress(
            state=phase,
            room=self._rooms[index] if self._rooms else "",
            covered=share * self._wanted,
            wanted=self._wanted,
            fraction=share,
            seconds_to_go=self._cleans - self.cleaned,
            battery=self._battery,
        )

    def next_feedback(self, timeout: float) -> CleanProgress | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        return self.progress() if self.waits_for_news(timeout) else None

    def report(self) -> CleanReport | None:
        """Return the scripted end once its time has come."""
        outcome = self.ending
        if outcome is None:
            return None
        is_known = outcome is not ErrandOutcome.LOST
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
        )


class FakeDocking(FakeErrand):
    """A :class:`roomba.client.Docking`."""

    def next_feedback(self, timeout: float) -> str | None:
        """Let time pass until the next feedback or the end, at most ``timeout`` s."""
        return self.phase if self.waits_for_news(timeout) else None

    def report(self) -> DockReport | None:
        """Return the scripted end once its time has come."""
        return None if self.ending is None else DockReport(self.ending, self.reason)


_Errand = TypeVar("_Errand", FakeClean, FakeDocking)


class FakeVacuum:
    """The vacuum cleaner's half of a :class:`roomba.client.RobotClient`; it starts docked.

    ``errands`` are used up one per clean, way to the station or out of it; later ones complete.
    """

    def __init__(
        self,
        clock: Clock,
        room_names: Sequence[str],
        errands: Iterable[ErrandScript],
        battery: float,
    ) -> None:
        self.clock: Clock = clock
        self.answers = True
        self.cleans: list[FakeClean] = []
        self.asked: list[tuple[CleanMode, tuple[str, ...]]] = []
        """What was to be cleaned, and the rooms of it."""
        self.beeps = 0
        self._room_names = tuple(room_names)
        self._scripts = list(errands)
        self._battery = battery
        self._errand: FakeClean | FakeDocking | None = None
        self._is_docked = True

    def clean(
        self,
        mode: CleanMode = CleanMode.WHOLE,
        *,
        rooms: Sequence[str] = (),
        in_order: bool = False,
        zones: Sequence[tuple[float, float, float, float]] = (),
        spot: tuple[float, float] | None = None,
        passes: int = 1,
        fan: FanLevel = FanLevel.STANDARD,
    ) -> FakeClean:
        """Start the next scripted clean; what was under way ends."""
        script = self._next_script()
        names = tuple(rooms) if mode is CleanMode.ROOMS else self._room_names
        unknown = [name for name in names if name not in self._room_names]
        if mode is CleanMode.ROOMS and (unknown or not names):
            message = f"expected rooms among {', '.join(self._room_names)}, got {unknown}"
            script = ErrandScript(ErrandOutcome.REFUSED, message=message)
        is_small = mode in (CleanMode.SPOT, CleanMode.ZONES)
        wanted = SPOT_AREA if is_small else ROOM_AREA * max(1, len(names))
        clean = FakeClean(script, self.clock, passes * wanted, names, self._battery)
        self.asked.append((mode, tuple(rooms)))
        self.cleans.append(clean)
        return self._begin(clean, script)

    def dock(self) -> FakeDocking:
        """Start for the station."""
        return self._move("returning", HOMING_TIME, is_done=self._stands_docked)

    def undock(self) -> FakeDocking:
        """Start backing out of the station."""
        return self._move("undocking", UNDOCKING_TIME, is_done=not self._stands_docked)

    def pause(self) -> None:
        """Stand until it is told to go on."""
        errand = self._answering_errand()
        if errand is None or errand.is_paused:
            raise RequestRefusedError(f"cannot pause now: the robot is {self.vacuum().phase}")
        errand.pause()

    def resume(self) -> None:
        """Go on."""
        errand = self._answering_errand()
        if errand is None or not errand.is_paused:
            raise RequestRefusedError(f"cannot resume now: the robot is {self.vacuum().phase}")
        errand.resume()

    def stop(self) -> None:
        """End what it does, and stay."""
        errand = self._answering_errand()
        if errand is not None:
            errand.end("it was told to stop")

    def locate(self) -> None:
        """Beep."""
        self._answering_errand()
        self.beeps += 1

    def vacuum(self, timeout: float = 5.0) -> VacuumSnapshot:
        """Return what it does now; a silent robot uses up the ``timeout`` and raises."""
        self._require_answers(timeout)
        errand = self._errand if self._errand is not None and not self._errand.is_over else None
        phase = "docked" if self._stands_docked else "idle" if errand is None else errand.phase
        progress = errand.progress() if isinstance(errand, FakeClean) else None
        return VacuumSnapshot(
            state="cleaning" if phase == "undocking" else phase,
            phase=phase,
            message="",
            room="" if progress is None else progress.room,
            covered=0.0 if progress is None else progress.covered,
            wanted=0.0 if progress is None else progress.wanted,
            fraction=0.0 if progress is None else progress.fraction,
            seconds_to_go=0.0 if progress is None else progress.seconds_to_go,
            battery=self._battery,
        )

    def rooms(self, timeout: float = 5.0) -> tuple[str, ...]:
        """Return the names it was made with."""
        self._require_answers(timeout)
        return self._room_names

    @property
    def _stands_docked(self) -> bool:
        """Whether it stands on its station."""
        if self._errand is None:
            return self._is_docked
        if not self._errand.is_fulfilled:
            return False
        return isinstance(self._errand, FakeClean) or self._errand.phase == "returning"

    def _answering_errand(self) -> FakeClean | FakeDocking | None:
        self._require_answers(5.0)
        errand = self._errand
        return None if errand is None or errand.is_over else errand

    def _require_answers(self, timeout: float) -> None:
        if not self.answers:
            self.clock.sleep(timeout)
            raise RobotUnavailableError(f"nothing came within {timeout:g} s")

    def _next_script(self) -> ErrandScript:
        self._require_answers(5.0)
        return self._scripts.pop(0) if self._scripts else ErrandScript()

    def _move(self, driving: str, duration: float, *, is_done: bool) -> FakeDocking:
        script = self._next_script()
        docking = FakeDocking(script, self.clock, 0.0, 0.0 if is_done else duration, driving)
        return self._begin(docking, script)

    def _begin(self, errand: _Errand, script: ErrandScript) -> _Errand:
        if script.outcome is not ErrandOutcome.REFUSED:
            if self._errand is not None:
                self._errand.end("a newer goal took over")
            self._errand = errand
        return errand
