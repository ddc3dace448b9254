"""The mission's state machine: every state with every event."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.phases.machine import (
    VACUUM_STATES,
    Errand,
    Event,
    MissionState,
    next_state,
    way_ended,
)
from roomba.vocabulary import Phase

DRIVING = (
    Phase.UNDOCKING,
    Phase.CLEANING,
    Phase.EXPLORING,
    Phase.RETURNING,
    Phase.DOCKING,
)
GOES_ON = {Errand.CLEAN: Phase.CLEANING, Errand.EXPLORE: Phase.EXPLORING}
"""Errands that a charge only interrupts, and what is done on them."""
HELD = (Phase.PAUSED, Phase.ERROR)
STATES = [
    MissionState(phase, errand, resumes)
    for phase, errand in itertools.product(Phase, Errand)
    for resumes in ((None, *DRIVING) if phase in (*HELD, Phase.EMERGENCY) else (None,))
]
SMART_HOME = {"cleaning", "docked", "paused", "idle", "returning", "error"}


@pytest.mark.parametrize("event", Event)
def test_every_state_takes_every_event(event: Event) -> None:
    for state in STATES:
        _assert_sound(state, event)


def _assert_sound(state: MissionState, event: Event) -> None:
    after = next_state(state, event)
    if event is Event.EMERGENCY:
        assert after is not None
        assert after.phase is Phase.EMERGENCY
        assert after.errand in (Errand.NONE, state.errand)
        assert (after.resumes is None) is (after.errand is Errand.NONE)
        return
    if state.phase is Phase.EMERGENCY:
        # Nothing ends the hold but its release, and that does not drive.
        assert (after is None) is (event not in (Event.RELEASE, Event.STOP))
        assert after is None or not after.drives
        assert event is not Event.STOP or after == MissionState(Phase.EMERGENCY)
        return
    if after is None:
        return
    # What is held up knows where it goes on; nothing else does.
    if after.phase in HELD:
        assert after.resumes is not None or state.resumes is None
        assert after.resumes not in (Phase.PAUSED, Phase.ERROR, Phase.EMERGENCY)
    else:
        assert after.resumes is None
    # It does not drive without an errand, and no errand is lost but by commands and by its end.
    if after.drives and state.errand is not Errand.NONE:
        assert after.errand is not Errand.NONE
    if not event.is_command and state.errand in GOES_ON and after.errand is not state.errand:
        assert event is Event.FINISHED or state.phase in (Phase.IDLE, Phase.DOCKED)
    # It does not explore on a clean, nor clean while it explores.
    if after.phase in GOES_ON.values() and state.phase not in HELD:
        assert after.phase is GOES_ON.get(after.errand, state.phase)


@pytest.mark.parametrize("phase", DRIVING)
@pytest.mark.parametrize("errand", Errand)
def test_a_robot_that_drives_can_be_stopped_paused_and_can_fail(
    phase: Phase, errand: Errand
) -> None:
    state = MissionState(phase, errand)
    paused, failed = next_state(state, Event.PAUSE), next_state(state, Event.FAILED)
    assert paused is not None
    assert failed is not None
    assert (paused.phase, failed.phase) == (Phase.PAUSED, Phase.ERROR)
    for held in (paused, failed):
        resumed = next_state(held, Event.RESUME)
        assert resumed is not None
        assert resumed.errand is errand
        assert resumed.phase is (Phase.RETURNING if phase is Phase.DOCKING else phase)
    assert next_state(state, Event.STOP) == MissionState(Phase.IDLE)


def test_an_exploration_goes_the_way_of_a_clean() -> None:
    """All that happens to the one happens to the other; what is done in between has two names."""
    for phase, event in itertools.product(Phase, Event):
        if phase in GOES_ON.values():
            continue
        for resumes in (None, Phase.UNDOCKING, Phase.RETURNING) if phase in HELD else (None,):
            of_clean = next_state(MissionState(phase, Errand.CLEAN, resumes), event)
            of_exploration = next_state(MissionState(phase, Errand.EXPLORE, resumes), event)
            assert of_exploration == _as_exploration(of_clean, event)
    for event in Event:
        of_clean = next_state(MissionState(Phase.CLEANING, Errand.CLEAN), event)
        of_exploration = next_state(MissionState(Phase.EXPLORING, Errand.EXPLORE), event)
        assert of_exploration == _as_exploration(of_clean, event)


def _as_exploration(state: MissionState | None, event: Event) -> MissionState | None:
    if state is None or event in (Event.CLEAN, Event.EXPLORE):
        return state
    phases = {Phase.CLEANING: Phase.EXPLORING}
    return MissionState(
        phases.get(state.phase, state.phase),
        Errand.EXPLORE if state.errand is Errand.CLEAN else state.errand,
        phases.get(state.resumes, state.resumes) if state.resumes else None,
    )


@pytest.mark.parametrize(
    ("state", "event", "expected"),
    [
        ((Phase.DOCKED,), Event.CLEAN, (Phase.UNDOCKING, Errand.CLEAN)),
        ((Phase.UNDOCKING, Errand.CLEAN), Event.OUT, (Phase.CLEANING, Errand.CLEAN)),
        ((Phase.CLEANING, Errand.CLEAN), Event.FINISHED, (Phase.RETURNING, Errand.HOME)),
        ((Phase.RETURNING, Errand.HOME), Event.ARRIVED, (Phase.DOCKING, Errand.HOME)),
        ((Phase.DOCKING, Errand.HOME), Event.CONTACT, (Phase.DOCKED,)),
        ((Phase.CLEANING, Errand.CLEAN), Event.LOW, (Phase.RETURNING, Errand.CLEAN)),
        ((Phase.DOCKING, Errand.CLEAN), Event.CONTACT, (Phase.CHARGING, Errand.CLEAN)),
        ((Phase.CHARGING, Errand.CLEAN), Event.CHARGED, (Phase.UNDOCKING, Errand.CLEAN)),
        ((Phase.CHARGING, Errand.CLEAN), Event.CONTACT_LOST, (Phase.RETURNING, Errand.CLEAN)),
        ((Phase.CHARGING, Errand.CLEAN), Event.STOP, (Phase.DOCKED,)),
        ((Phase.CLEANING, Errand.CLEAN), Event.BIN_FULL, (Phase.RETURNING, Errand.CLEAN)),
        ((Phase.CHARGING, Errand.CLEAN), Event.BIN_FULL, (Phase.BIN_FULL, Errand.CLEAN)),
        ((Phase.BIN_FULL, Errand.CLEAN), Event.EMPTIED, (Phase.CHARGING, Errand.CLEAN)),
        ((Phase.BIN_FULL, Errand.CLEAN), Event.DOCK, (Phase.RETURNING, Errand.DOCK)),
        ((Phase.DOCKED,), Event.DOCK, (Phase.DOCKED,)),
        ((Phase.DOCKED,), Event.CONTACT_LOST, (Phase.IDLE,)),
        ((Phase.IDLE,), Event.CONTACT, (Phase.DOCKED,)),
        (
            (Phase.PAUSED, Errand.CLEAN, Phase.CLEANING),
            Event.CONTACT,
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
        ),
        ((Phase.UNDOCKING, Errand.UNDOCK), Event.OUT, (Phase.IDLE,)),
        ((Phase.UNDOCKING, Errand.UNDOCK), Event.CONTACT, (Phase.DOCKED,)),
        ((Phase.UNDOCKING, Errand.CLEAN), Event.CONTACT, (Phase.CHARGING, Errand.CLEAN)),
        (
            (Phase.ERROR, Errand.CLEAN, Phase.UNDOCKING),
            Event.CONTACT,
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
        ),
        (
            (Phase.CHARGING, Errand.CLEAN),
            Event.FAILED,
            (Phase.ERROR, Errand.CLEAN, Phase.CHARGING),
        ),
        (
            (Phase.ERROR, Errand.HOME, Phase.RETURNING),
            Event.BEAMS_SEEN,
            (Phase.RETURNING, Errand.HOME),
        ),
        ((Phase.PAUSED, Errand.HOME, Phase.RETURNING), Event.BEAMS_SEEN, None),
        ((Phase.DOCKED,), Event.EXPLORE, (Phase.UNDOCKING, Errand.EXPLORE)),
        ((Phase.UNDOCKING, Errand.EXPLORE), Event.OUT, (Phase.EXPLORING, Errand.EXPLORE)),
        ((Phase.EXPLORING, Errand.EXPLORE), Event.FINISHED, (Phase.RETURNING, Errand.HOME)),
        ((Phase.EXPLORING, Errand.EXPLORE), Event.LOW, (Phase.RETURNING, Errand.EXPLORE)),
        ((Phase.DOCKING, Errand.EXPLORE), Event.CONTACT, (Phase.CHARGING, Errand.EXPLORE)),
        ((Phase.EXPLORING, Errand.EXPLORE), Event.CLEAN, (Phase.UNDOCKING, Errand.CLEAN)),
        ((Phase.RETURNING, Errand.HOME), Event.MORE, (Phase.CLEANING, Errand.CLEAN)),
        ((Phase.RETURNING, Errand.CLEAN), Event.MORE, None),
        ((Phase.RETURNING, Errand.DOCK), Event.MORE, None),
        ((Phase.DOCKING, Errand.HOME), Event.MORE, None),
        ((Phase.IDLE,), Event.PAUSE, None),
        (
            (Phase.CHARGING, Errand.CLEAN),
            Event.PAUSE,
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
        ),
        (
            (Phase.EMPTYING, Errand.CLEAN),
            Event.PAUSE,
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
        ),
        (
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
            Event.CONTACT,
            (Phase.PAUSED, Errand.CLEAN, Phase.CHARGING),
        ),
        ((Phase.EMPTYING,), Event.PAUSE, None),
        ((Phase.IDLE,), Event.RESUME, None),
        ((Phase.CLEANING, Errand.CLEAN), Event.RESUME, None),
        ((Phase.IDLE,), Event.RELEASE, None),
        (
            (Phase.CLEANING, Errand.CLEAN),
            Event.EMERGENCY,
            (Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING),
        ),
        (
            (Phase.DOCKING, Errand.HOME),
            Event.EMERGENCY,
            (Phase.EMERGENCY, Errand.HOME, Phase.RETURNING),
        ),
        (
            (Phase.BIN_FULL, Errand.CLEAN),
            Event.EMERGENCY,
            (Phase.EMERGENCY, Errand.CLEAN, Phase.CHARGING),
        ),
        (
            (Phase.ERROR, Errand.EXPLORE, Phase.EXPLORING),
            Event.EMERGENCY,
            (Phase.EMERGENCY, Errand.EXPLORE, Phase.EXPLORING),
        ),
        (
            (Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING),
            Event.EMERGENCY,
            (Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING),
        ),
        (
            (Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING),
            Event.RELEASE,
            (Phase.PAUSED, Errand.CLEAN, Phase.CLEANING),
        ),
        ((Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING), Event.STOP, (Phase.EMERGENCY,)),
        ((Phase.EMERGENCY, Errand.CLEAN, Phase.CLEANING), Event.RESUME, None),
        ((Phase.EMERGENCY,), Event.RELEASE, (Phase.IDLE,)),
        ((Phase.RETURNING, Errand.DOCK), Event.EMERGENCY, (Phase.EMERGENCY,)),
        ((Phase.UNDOCKING, Errand.UNDOCK), Event.EMERGENCY, (Phase.EMERGENCY,)),
        ((Phase.EMPTYING,), Event.EMERGENCY, (Phase.EMERGENCY,)),
        ((Phase.DOCKED,), Event.EMERGENCY, (Phase.EMERGENCY,)),
    ],
)
def test_what_comes_after_what(
    state: tuple[Any, ...], event: Event, expected: tuple[Any, ...] | None
) -> None:
    """Each state is the phase, the errand, and the phase that a paused robot goes on with."""
    after = None if expected is None else MissionState(*expected)
    assert next_state(MissionState(*state), event) == after


def test_each_phase_has_a_word_that_smart_homes_know() -> None:
    assert set(VACUUM_STATES) == set(Phase)
    assert set(VACUUM_STATES.values()) == SMART_HOME


@given(st.lists(st.sampled_from(list(Event)), max_size=40))
def test_from_anywhere_stop_clean_and_explore_work_once_the_emergency_is_over(
    events: list[Event],
) -> None:
    state = MissionState()
    for event in events:
        state = next_state(state, event) or state
        assert not (state.phase in DRIVING and state.errand is Errand.NONE)
    state = next_state(state, Event.RELEASE) or state
    stopped = next_state(state, Event.STOP)
    assert stopped is not None
    assert not stopped.drives
    cleaning = next_state(stopped, Event.CLEAN)
    assert cleaning == MissionState(Phase.UNDOCKING, Errand.CLEAN)
    exploring = next_state(stopped, Event.EXPLORE)
    assert exploring == MissionState(Phase.UNDOCKING, Errand.EXPLORE)


def test_a_way_out_of_the_station_ends_well_only_if_it_was_not_stopped() -> None:
    out = MissionState(Phase.IDLE)
    way = MissionState(Phase.UNDOCKING, Errand.UNDOCK)
    assert way_ended(way, Errand.UNDOCK, Event.UNDOCK) is None
    assert way_ended(out, Errand.UNDOCK, Event.UNDOCK) is CleanOutcome.COMPLETED
    assert way_ended(out, Errand.UNDOCK, Event.RESUME) is CleanOutcome.COMPLETED
    # Held and released between two looks: it stands, out or not.
    for command in (Event.STOP, Event.RELEASE):
        assert way_ended(out, Errand.UNDOCK, command) is CleanOutcome.STOPPED


@pytest.mark.parametrize("errand", [Errand.DOCK, Errand.UNDOCK])
def test_a_way_to_the_station_or_off_it_ends_in_every_state_but_its_own(errand: Errand) -> None:
    for state in STATES:
        outcome = way_ended(state, errand, None)
        is_fault = state.phase in (Phase.ERROR, Phase.EMERGENCY)
        assert (outcome is CleanOutcome.FAULT) is is_fault
        assert (outcome is None) is (state.errand is errand and not is_fault)
