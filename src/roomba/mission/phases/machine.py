"""The mission's state machine: what comes after what. No clock, no I/O, no robot.

A state is a :class:`Phase`, the :class:`Errand` that it is for, and, while the robot is held up,
the phase that comes again. :func:`next_state` says what comes after an event. An event that a phase
does not know changes nothing; if it is a command, it is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

from roomba.mission.cleaning.result import CleanOutcome
from roomba.vocabulary import HELD, Phase


class Errand(Enum):
    """What the robot is on its way for."""

    NONE = "none"
    CLEAN = "clean"
    EXPLORE = "explore"
    HOME = "home"
    """All is done; back to the station."""
    DOCK = "dock"
    UNDOCK = "undock"


class Event(Enum):
    """What happens: commands first, then what the robot itself finds."""

    CLEAN = "clean"
    EXPLORE = "explore"
    DOCK = "dock"
    UNDOCK = "undock"
    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"
    EMERGENCY = "emergency stop"
    RELEASE = "release the emergency stop"
    EMPTY = "empty its bin at its station"

    OUT = "out of the station"
    FINISHED = "all is done: the floor, or the map"
    ARRIVED = "before the station"
    CONTACT = "charging current"
    CONTACT_LOST = "no charging current any more"
    MORE = "there is more to clean: a zone was taken away"
    LOW = "the battery is just enough for the way home"
    BIN_FULL = "the dust bin is full"
    EMPTIED = "the dust bin was emptied"
    """By its level sensor, or told by a person; it changes nothing of what was commanded."""
    CHARGED = "charged enough to go on"
    BEAMS_SEEN = "the beams of its station, for want of which it did not dock"
    FAILED = "it cannot go on by itself"

    @property
    def is_command(self) -> bool:
        """Whether it is a command, whose sender is told when it is refused."""
        return self in _COMMANDS


_COMMANDS: Final = frozenset(
    (
        Event.CLEAN,
        Event.EXPLORE,
        Event.DOCK,
        Event.UNDOCK,
        Event.PAUSE,
        Event.RESUME,
        Event.STOP,
        Event.EMERGENCY,
        Event.RELEASE,
        Event.EMPTY,
    )
)


@dataclass(frozen=True, slots=True)
class MissionState:
    """Where the mission is; ``resumes`` is the phase in which a job that is held up goes on."""

    phase: Phase = Phase.IDLE
    errand: Errand = Errand.NONE
    resumes: Phase | None = None

    @property
    def drives(self) -> bool:
        """Whether the robot moves by itself."""
        return self.phase in _DRIVING


_WORKING: Final = frozenset((Phase.CLEANING, Phase.EXPLORING))
_DRIVING: Final = _WORKING | {Phase.UNDOCKING, Phase.RETURNING, Phase.DOCKING}
_ON_STATION: Final = frozenset((Phase.DOCKED, Phase.CHARGING, Phase.EMPTYING))
_GOES_ON: Final = frozenset((Errand.CLEAN, Errand.EXPLORE))
"""Errands that a charge on the station only interrupts."""
_AMID_IT: Final = frozenset((Phase.CHARGING, Phase.BIN_FULL, Phase.EMPTYING))
"""Phases in which the robot stands at its station amid such an errand. From there it goes on by
charging, which ends at once when there is enough, and notices that the bin is full."""
_OUTLASTS_A_STOP: Final = _GOES_ON | {Errand.HOME}
"""Errands that an emergency stop only interrupts."""


def next_state(state: MissionState, event: Event) -> MissionState | None:
    """Return the state after an event, or None when that event means nothing in this state."""
    if event is Event.EMERGENCY:
        return _stopped_at_once(state)
    if state.phase is Phase.EMERGENCY:
        return _while_stopped(state, event)
    if event.is_command:
        return _commanded(state, event)
    if state.drives:
        return _driving(state, event)
    return _standing(state, event)


def way_ended(
    state: MissionState, errand: Errand, last_command: Event | None
) -> CleanOutcome | None:
    """Return how a way into the station or out of it ended; None while it is under way.

    ``errand`` is DOCK or UNDOCK. The outcome is COMPLETED where the robot was to come to, FAULT
    after an error or an emergency stop, and else STOPPED. A robot that was stopped on its way out,
    or held and released, stands off its station, too: ``last_command``, the last one that it
    obeyed, tells this from a success.
    """
    if state.phase in (Phase.ERROR, Phase.EMERGENCY):
        return CleanOutcome.FAULT
    if state.errand is errand:
        return None
    there = Phase.DOCKED if errand is Errand.DOCK else Phase.IDLE
    is_there = state.phase is there and last_command not in (Event.STOP, Event.RELEASE)
    return CleanOutcome.COMPLETED if is_there else CleanOutcome.STOPPED


def _stopped_at_once(state: MissionState) -> MissionState:
    """Return what an emergency stop makes of a state."""
    resumes = _where_it_goes_on(state)
    if resumes is None or state.errand not in _OUTLASTS_A_STOP:
        return MissionState(Phase.EMERGENCY)
    return replace(state, phase=Phase.EMERGENCY, resumes=resumes)


def _while_stopped(state: MissionState, event: Event) -> MissionState | None:
    """Return what comes after an event while the emergency stop holds: nothing drives."""
    if event is Event.RELEASE:
        is_held_up = state.errand is not Errand.NONE
        return replace(state, phase=Phase.PAUSED) if is_held_up else MissionState()
    return MissionState(Phase.EMERGENCY) if event is Event.STOP else None


def _commanded(state: MissionState, event: Event) -> MissionState | None:
    on_station = state.phase in _ON_STATION
    if event is Event.CLEAN:
        return MissionState(Phase.UNDOCKING, Errand.CLEAN)
    if event is Event.EXPLORE:
        return MissionState(Phase.UNDOCKING, Errand.EXPLORE)
    if event is Event.DOCK:
        if on_station:
            return MissionState(Phase.DOCKED)
        return MissionState(Phase.RETURNING, Errand.DOCK)
    if event is Event.UNDOCK:
        return MissionState(Phase.UNDOCKING, Errand.UNDOCK)
    if event is Event.PAUSE:
        resumes = _where_it_goes_on(state)
        if resumes is None or state.phase in HELD or state.phase is Phase.BIN_FULL:
            return None
        return replace(state, phase=Phase.PAUSED, resumes=resumes)
    if event is Event.RESUME:
        if state.phase in HELD and state.resumes is not None:
            return MissionState(state.resumes, state.errand)
        return None
    if event is Event.EMPTY:
        if on_station or state.phase is Phase.BIN_FULL:
            return MissionState(Phase.EMPTYING, state.errand)
        return None
    if event is Event.STOP:
        return MissionState(Phase.DOCKED if on_station else Phase.IDLE)
    return None


def _driving(state: MissionState, event: Event) -> MissionState | None:
    """Return what comes after an event while it drives."""
    phase, errand = state.phase, state.errand
    if event is Event.FAILED:
        return replace(state, phase=Phase.ERROR, resumes=_again(phase))
    if event is Event.OUT and phase is Phase.UNDOCKING:
        return _after_undocking(errand)
    if event is Event.FINISHED and phase in _WORKING:
        return MissionState(Phase.RETURNING, Errand.HOME)
    if event is Event.MORE and phase is Phase.RETURNING and errand is Errand.HOME:
        return MissionState(Phase.CLEANING, Errand.CLEAN)
    if event is Event.LOW and (phase in _WORKING or phase is Phase.UNDOCKING):
        return replace(state, phase=Phase.RETURNING)
    if event is Event.BIN_FULL and phase in _WORKING:
        return replace(state, phase=Phase.RETURNING)
    if event is Event.ARRIVED and phase is Phase.RETURNING:
        return replace(state, phase=Phase.DOCKING)
    if event is Event.CONTACT and phase in (Phase.UNDOCKING, Phase.RETURNING, Phase.DOCKING):
        return _after_docking(errand)
    return None


def _standing(state: MissionState, event: Event) -> MissionState | None:
    """Return what comes after an event while it stands."""
    phase = state.phase
    if event is Event.CONTACT:
        if phase is Phase.IDLE:
            return MissionState(Phase.DOCKED)
        if phase in HELD:
            # It was carried home. With an errand it resumes from there when it is told to.
            if state.errand in _GOES_ON:
                return replace(state, phase=Phase.PAUSED, resumes=Phase.CHARGING)
            return MissionState(Phase.DOCKED)
    if event is Event.CONTACT_LOST:
        if phase is Phase.DOCKED:
            return MissionState(Phase.IDLE)
        if phase is Phase.CHARGING:
            return replace(state, phase=Phase.RETURNING)
    if phase is Phase.EMPTYING:
        return _emptying(state, event)
    if event is Event.CHARGED and phase is Phase.CHARGING:
        return replace(state, phase=Phase.UNDOCKING)
    if event is Event.BIN_FULL and phase is Phase.CHARGING:
        return replace(state, phase=Phase.BIN_FULL)
    if event is Event.EMPTIED and phase is Phase.BIN_FULL:
        return replace(state, phase=Phase.CHARGING)
    if event is Event.FAILED and phase is Phase.CHARGING:
        return replace(state, phase=Phase.ERROR, resumes=Phase.CHARGING)
    if event is Event.BEAMS_SEEN and phase is Phase.ERROR and state.resumes is not None:
        return MissionState(state.resumes, state.errand)
    return None


def _emptying(state: MissionState, event: Event) -> MissionState | None:
    """Return what comes after an event while its station empties the bin."""
    goes_on = state.errand in _GOES_ON
    if event is Event.EMPTIED or event is Event.FAILED:
        return replace(state, phase=Phase.CHARGING) if goes_on else MissionState(Phase.DOCKED)
    if event is Event.CONTACT_LOST:
        return replace(state, phase=Phase.RETURNING) if goes_on else MissionState(Phase.IDLE)
    return None


def _where_it_goes_on(state: MissionState) -> Phase | None:
    """Return the phase in which a job goes on that is held up now; None: there is none."""
    if state.drives:
        return _again(state.phase)
    if state.errand in _GOES_ON and state.phase in _AMID_IT:
        return Phase.CHARGING
    return state.resumes


def _again(phase: Phase) -> Phase:
    """Return where to take up a phase that was broken off: the station is approached anew."""
    return Phase.RETURNING if phase is Phase.DOCKING else phase


def _after_undocking(errand: Errand) -> MissionState:
    if errand is Errand.CLEAN:
        return MissionState(Phase.CLEANING, errand)
    if errand is Errand.EXPLORE:
        return MissionState(Phase.EXPLORING, errand)
    if errand in (Errand.HOME, Errand.DOCK):
        return MissionState(Phase.RETURNING, errand)
    return MissionState(Phase.IDLE)


def _after_docking(errand: Errand) -> MissionState:
    if errand in _GOES_ON:
        return MissionState(Phase.CHARGING, errand)
    return MissionState(Phase.DOCKED)


VACUUM_STATES: Final[dict[Phase, str]] = {
    Phase.IDLE: "idle",
    Phase.DOCKED: "docked",
    Phase.UNDOCKING: "cleaning",
    Phase.CLEANING: "cleaning",
    Phase.EXPLORING: "cleaning",
    Phase.RETURNING: "returning",
    Phase.DOCKING: "returning",
    Phase.CHARGING: "docked",
    Phase.BIN_FULL: "error",
    Phase.EMPTYING: "docked",
    Phase.PAUSED: "paused",
    Phase.ERROR: "error",
    Phase.EMERGENCY: "error",
}
"""Each phase in the vocabulary that smart homes use."""
