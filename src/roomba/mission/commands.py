"""The commands of a mission: what each requires, and what it begins or ends."""

from __future__ import annotations

from collections.abc import Sequence

from roomba.clean_request import CleanRequest
from roomba.configuration.mission import MissionConfig
from roomba.errors import RoombaError
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.driving.drives import Drives
from roomba.mission.driving.obstacles import Obstacles
from roomba.mission.driving.retry_policy import RetryPolicy
from roomba.mission.inputs.senses import Senses
from roomba.mission.phases.at_station import why_not_emptied
from roomba.mission.phases.job import Job
from roomba.mission.phases.machine import Errand, Event, next_state
from roomba.mission.transitions import BIN_FULL, RELEASED, Transitions
from roomba.vocabulary import NO_REASON, Phase, Reason, RoomWay


class CommandRefusedError(RoombaError):
    """A command that is not possible now; the message says why."""


class Commands:
    """Obeys commands, or refuses them with a reason."""

    def __init__(
        self,
        config: MissionConfig,
        bin_capacity: float,
        transitions: Transitions,
        job: Job,
        drives: Drives,
        obstacles: Obstacles,
        retries: RetryPolicy,
    ) -> None:
        """Take the mission's parts; its dust bin takes ``bin_capacity`` g."""
        self._config, self._bin_capacity = config, bin_capacity
        self._transitions, self._job, self._drives = transitions, job, drives
        self._obstacles, self._retries = obstacles, retries

    def clean(self, request: CleanRequest, senses: Senses) -> None:
        """Begin a clean; raises CleanRefusedError or CommandRefusedError with the reason."""
        self._require_start(Event.CLEAN, senses)
        self._require_room_in_bin(senses)
        cleaning = self._job.cleaning_of(request, self._drives.context, senses)
        self._end("a newer clean took over", senses)
        self._job.begin_clean(cleaning, senses)
        self._forget_obstacles()
        self._transitions.go(Event.CLEAN, senses)

    def explore(self, senses: Senses) -> None:
        """Begin to look for what the map does not show yet; raises CommandRefusedError."""
        self._require_start(Event.EXPLORE, senses)
        self._end("it was told to explore", senses)
        self._job.begin_exploration(senses)
        self._forget_obstacles()
        self._transitions.go(Event.EXPLORE, senses)

    def obey(self, event: Event, senses: Senses, reason: str) -> None:
        """Obey a command without arguments; raises CommandRefusedError with the reason."""
        if event is Event.EMPTIED:
            self._note_empty_bin(senses)
        elif event is Event.EMPTY:
            self._empty_at_station(senses)
        else:
            self._obey(event, senses, reason)

    def _obey(self, event: Event, senses: Senses, reason: str) -> None:
        self._require_possible(event)
        if event in (Event.DOCK, Event.UNDOCK, Event.STOP):
            self._end(f"it was told to {event.value}", senses)
        if event is Event.EMERGENCY and not self._outlasts_a_stop:
            self._end(f"emergency stop: {reason}", senses, CleanOutcome.FAULT)
        held = Reason(reason) if event is Event.EMERGENCY else self._transitions.reason
        self._transitions.go(event, senses)
        if event in (Event.RELEASE, Event.STOP) and senses.battery.is_docked:
            self._transitions.go(Event.CONTACT, senses)
        self._transitions.reason = self._reason_after(event, held)

    def _note_empty_bin(self, senses: Senses) -> None:
        """Note that the dust bin was emptied by hand.

        Raises CommandRefusedError if its level sensor says no.
        """
        level = senses.in_bin / self._bin_capacity
        if level >= self._config.bin.full:
            raise CommandRefusedError(
                f"expected an empty dust bin, got one that is {level:.0%} full by its level sensor"
            )
        self._job.bin.emptied()
        self._transitions.go(Event.EMPTIED, senses)

    def _empty_at_station(self, senses: Senses) -> None:
        """Let the station empty the bin; raises CommandRefusedError with the reason."""
        self._require_possible(Event.EMPTY)
        reason = why_not_emptied(senses.emptying)
        if not reason and not senses.battery.is_docked:
            reason = "it does not stand on its station"
        if reason:
            raise CommandRefusedError(f"cannot {Event.EMPTY.value}: {reason}")
        self._transitions.go(Event.EMPTY, senses)

    def change_rooms(self, names: Sequence[str], each: Sequence[RoomWay]) -> None:
        """Let the clean under way go on with these rooms, the first one at once.

        Raises CommandRefusedError or CleanRefusedError with the reason.
        """
        cleaning, drives = self._job.cleaning, self._drives
        if self._transitions.state.phase is Phase.EMERGENCY:
            raise self._refusal("change the rooms")
        if cleaning is None:
            raise CommandRefusedError("expected a clean of rooms under way, got none: begin one")
        if cleaning.change_rooms(names, each):
            if drives.is_round:
                self._transitions.drop_driver()
            cleaning.begin_room()

    def _end(
        self, message: str, senses: Senses, outcome: CleanOutcome = CleanOutcome.STOPPED
    ) -> None:
        """End the job under way for good; the next one begins with nothing tried."""
        self._transitions.drop_driver()
        self._transitions.end_job(outcome, message, senses)
        self._retries.renew()
        self._job.forget()

    def _forget_obstacles(self) -> None:
        """Begin an errand with nothing in the way: things go, and what stays is felt anew."""
        self._obstacles.forget()
        self._obstacles.begin_errand()

    @property
    def _outlasts_a_stop(self) -> bool:
        """Whether there is a job that an emergency stop only interrupts."""
        after = next_state(self._transitions.state, Event.EMERGENCY)
        return after is not None and after.errand is not Errand.NONE

    def _reason_after(self, event: Event, held: Reason) -> Reason:
        """Return why the robot stands after a command; ``held`` is why an emergency stop holds."""
        phase = self._transitions.state.phase
        if phase is Phase.EMERGENCY:
            return held
        return RELEASED if event is Event.RELEASE and phase is Phase.PAUSED else NO_REASON

    def _require_possible(self, event: Event) -> None:
        if next_state(self._transitions.state, event) is None:
            raise self._refusal(event.value)

    def _refusal(self, what: str) -> CommandRefusedError:
        """Return the refusal of what is not possible in the present phase."""
        phase, message = self._transitions.state.phase, self._transitions.told.text
        state = "held by the emergency stop" if phase is Phase.EMERGENCY else phase.value
        return CommandRefusedError(
            f"cannot {what} now: the robot is {state}" + (f" ({message})" if message else "")
        )

    def _require_start(self, event: Event, senses: Senses) -> None:
        if self._transitions.state.phase is Phase.EMERGENCY:
            self._require_possible(event)
        least = self._config.energy.least_to_start
        if senses.battery.level < least and not senses.battery.is_docked:
            raise CommandRefusedError(
                f"expected a battery of {least:.0%} or more to begin, got "
                f"{senses.battery.level:.0%}; bring the robot to its station"
            )

    def _require_room_in_bin(self, senses: Senses) -> None:
        self._job.look_at_bin(senses)
        if self._job.bin.is_full:
            raise CommandRefusedError(f"expected room in the dust bin, got none: {BIN_FULL.text}")
