"""The vacuum cleaner in :class:`roomba.client.fake.robot.FakeRobot`: it cleans by a script, not
floor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeVar

from roomba.clean_request import CleanRequest
from roomba.client.fake.errands import (
    EXPLORING_TIME,
    HOMING_TIME,
    ErrandScript,
    FakeClean,
    FakeDocking,
    FakeErrand,
    FakeExploring,
)
from roomba.client.protocol import (
    CleaningClient,
    ErrandOutcome,
    RequestRefusedError,
    RobotUnavailableError,
    VacuumSnapshot,
)
from roomba.vocabulary import OVERTAKEN, CleanMode, Hindrance, Phase, RoomWay

if TYPE_CHECKING:
    from roomba.client.clock import Clock

ROOM_AREA = 4.0
SPOT_AREA = 2.25
"""m2 of a room, and of any other thing to be cleaned."""
UNDOCKING_TIME = 2.0
"""s out of the station."""

_Errand = TypeVar("_Errand", FakeClean, FakeDocking, FakeExploring)


class FakeVacuum(CleaningClient):
    """The vacuum cleaner's half of a :class:`roomba.client.protocol.RobotClient`; it starts docked.

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
        self.asked: list[CleanRequest] = []
        self.beeps = 0
        self.is_bin_full = False
        """May be set: then :meth:`vacuum` says so until the bin is emptied."""
        self._room_names = tuple(room_names)
        self._scripts = list(errands)
        self._battery = battery
        self._errand: FakeClean | FakeDocking | FakeExploring | None = None
        self._is_docked = True

    def begin_clean(self, request: CleanRequest) -> FakeClean:
        """Start the next scripted clean; what was under way ends."""
        script = self._next_script()
        names = request.rooms if request.mode is CleanMode.ROOMS else self._room_names
        unknown = [name for name in names if name not in self._room_names]
        if unknown:
            message = f"expected rooms among {', '.join(self._room_names)}, got {unknown}"
            script = ErrandScript(ErrandOutcome.REFUSED, message=message)
        is_small = request.mode in (CleanMode.SPOT, CleanMode.ZONES)
        wanted = SPOT_AREA if is_small else ROOM_AREA * max(1, len(names))
        each = request.each
        often = sum(way.passes for way in each) / len(each) if each else request.passes
        clean = FakeClean(script, self.clock, often * wanted, names, self._battery)
        self.asked.append(request)
        self.cleans.append(clean)
        return self._begin(clean, script)

    def change_rooms(self, rooms: Sequence[str], each: Sequence[RoomWay] = ()) -> None:
        """Let the clean of rooms under way go on with these."""
        unknown = [name for name in rooms if name not in self._room_names]
        clean = self.cleans[-1] if self.cleans else None
        if clean is None or clean.is_over or self.asked[-1].mode is not CleanMode.ROOMS:
            raise RequestRefusedError("expected a clean of rooms under way, got none: begin one")
        if unknown or not rooms:
            raise RequestRefusedError(
                f"expected rooms among {', '.join(self._room_names)}, got {unknown}"
            )
        clean.change_rooms(tuple(rooms))

    def dock(self) -> FakeDocking:
        """Start for the station."""
        return self._move(Phase.RETURNING, HOMING_TIME, is_done=self._stands_docked)

    def undock(self) -> FakeDocking:
        """Start backing out of the station."""
        return self._move(Phase.UNDOCKING, UNDOCKING_TIME, is_done=not self._stands_docked)

    def explore(self) -> FakeExploring:
        """Start exploring by the next script; what was under way ends."""
        script = self._next_script()
        exploring = FakeExploring(script, self.clock, 0.0, EXPLORING_TIME, Phase.EXPLORING)
        return self._begin(exploring, script)

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

    def empty_bin(self) -> None:
        """Take the bin for empty."""
        self._require_answers(5.0)
        self.is_bin_full = False

    def vacuum(self, timeout: float = 5.0) -> VacuumSnapshot:
        """Return what it does now; a silent robot uses up the ``timeout`` and raises."""
        self._require_answers(timeout)
        errand = self._errand if self._errand is not None and not self._errand.is_over else None
        at_rest = Phase.DOCKED if self._stands_docked else Phase.IDLE
        phase = at_rest if self._stands_docked or errand is None else errand.phase
        progress = errand.progress() if isinstance(errand, FakeClean) else None
        return VacuumSnapshot(
            state=Phase.CLEANING.value if phase is Phase.UNDOCKING else phase.value,
            phase=phase.value,
            message="bin full: empty the dust bin" if self.is_bin_full else "",
            room="" if progress is None else progress.room,
            covered=0.0 if progress is None else progress.covered,
            wanted=0.0 if progress is None else progress.wanted,
            fraction=0.0 if progress is None else progress.fraction,
            seconds_to_go=0.0 if progress is None else progress.seconds_to_go,
            battery=self._battery,
            queue=self._queue(errand),
            hindrance=Hindrance.BIN_FULL if self.is_bin_full else Hindrance.NONE,
        )

    def _queue(self, errand: FakeErrand | None) -> tuple[str, ...]:
        is_of_rooms = bool(self.asked) and self.asked[-1].mode is CleanMode.ROOMS
        return errand.queue if isinstance(errand, FakeClean) and is_of_rooms else ()

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
        return (
            isinstance(self._errand, FakeClean | FakeExploring)
            or self._errand.phase is Phase.RETURNING
        )

    def _answering_errand(self) -> FakeClean | FakeDocking | FakeExploring | None:
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

    def _move(self, driving: Phase, duration: float, *, is_done: bool) -> FakeDocking:
        script = self._next_script()
        docking = FakeDocking(script, self.clock, 0.0, 0.0 if is_done else duration, driving)
        return self._begin(docking, script)

    def _begin(self, errand: _Errand, script: ErrandScript) -> _Errand:
        if script.outcome is not ErrandOutcome.REFUSED:
            if self._errand is not None:
                self._errand.end(OVERTAKEN)
            self._errand = errand
        return errand
