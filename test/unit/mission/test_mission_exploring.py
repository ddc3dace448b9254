"""Exploring as a mission: commands and what comes up, without a world; the map grows by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fixtures.missions.exploring import (
    AWAY,
    CONFIG,
    DOCKED,
    HALL,
    HERE,
    LOW,
    ROBOT,
    WHOLE,
    Rig,
    exploring,
    known_to,
)
from fixtures.missions.told_mission import TICK
from fixtures.robots.missions import DOOR, TWO_ROOMS, WALL_X

from roomba.clean_request import CleanRequest
from roomba.geometry import STANDSTILL, Twist
from roomba.grid import OCCUPIED, OccupancyMap
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.driving.path_driver import DriveState, DriveStep, PathDriver
from roomba.mission.exploring.exploration import Exploration
from roomba.mission.inputs.senses import Battery
from roomba.mission.phases.machine import Errand, Event
from roomba.perception.localization.estimate import Knowledge
from roomba.vocabulary import Phase


def stuck(rig: Rig, monkeypatch: pytest.MonkeyPatch, state: DriveState) -> None:
    """Let the drive that is under way end like that."""
    assert rig.mission.driver is not None
    with monkeypatch.context() as patched:
        ended = DriveStep(state, Twist(), "it is stuck")
        patched.setattr(PathDriver, "tick", lambda driver, senses, limit: ended)
        rig.tick()


def test_told_to_explore_it_drives_and_sweeps_nothing() -> None:
    rig = exploring()
    assert rig.phase is Phase.EXPLORING
    assert rig.mission.state.errand is Errand.EXPLORE
    assert rig.tick().twist != Twist()
    assert not rig.mission.sweeps
    assert rig.mission.steady(rig.senses) is not None
    assert rig.mission.seconds_to_go() == 0.0
    assert rig.mission.speed_limit(rig.senses) == CONFIG.exploring.speed
    rough = replace(rig.senses, knowledge=Knowledge.ROUGH)
    assert rig.mission.speed_limit(rough) == ROBOT.walk.careful_speed


def test_from_its_station_it_comes_out_first_once_its_gyro_has_settled() -> None:
    rig = Rig(DOCKED)
    rig.mission.explore(rig.senses)
    assert rig.phase is Phase.UNDOCKING
    stand = round(CONFIG.exploring.stand_first / TICK)
    assert rig.tick(stand - 2).twist == STANDSTILL
    assert rig.tick(4).twist.linear < 0.0


def test_with_nothing_left_it_goes_home() -> None:
    rig = exploring(WHOLE)
    assert rig.phase is Phase.RETURNING
    assert rig.mission.state.errand is Errand.HOME
    rig.tick(pose=TWO_ROOMS.station, battery=DOCKED.battery)
    assert rig.phase is Phase.DOCKED
    result = rig.result
    assert (result.outcome, result.message) == (CleanOutcome.COMPLETED, "")
    assert result.unseen == ()
    assert result.known == pytest.approx((~WHOLE.solid).sum() * 0.05**2)
    assert result.duration == pytest.approx(6 * TICK, abs=2 * TICK)
    assert rig.mission.exploration is None
    assert rig.mission.take_result() is None


def test_a_map_makes_a_difference_when_the_goal_is_seen_or_there_is_none() -> None:
    rig = Rig()
    assert rig.mission.wants_map(HALL)
    rig = exploring()
    assert not rig.mission.wants_map(HALL)
    assert rig.mission.wants_map(WHOLE)
    rig = Rig(DOCKED)
    rig.mission.explore(rig.senses)
    rig.tick()
    assert rig.phase is Phase.UNDOCKING
    assert not rig.mission.wants_map(WHOLE)


def test_a_map_makes_a_difference_when_it_shows_something_new_on_the_way() -> None:
    rig = exploring()
    values, frame = HALL.values.copy(), HALL.frame
    low, column = frame.cell_of(HERE.x + 0.35, 0.0)
    beside, on = values.copy(), values.copy()
    beside[frame.cell_of(HERE.x, HERE.y - 0.4)] = OCCUPIED
    on[low:, column] = OCCUPIED
    assert not rig.mission.wants_map(OccupancyMap(frame, beside))
    assert rig.mission.wants_map(OccupancyMap(frame, on))
    # Going by that map it finds nothing new on it.
    rig.grow(OccupancyMap(frame, on))
    rig.tick(2)
    assert rig.mission.driver is None or not rig.mission.wants_map(OccupancyMap(frame, on))


def test_a_map_that_changes_nothing_leaves_it_on_its_way() -> None:
    rig = exploring()
    driver = rig.mission.driver
    assert driver is not None
    rig.grow(known_to(WALL_X + 0.2))
    assert rig.mission.driver is driver
    # Now the way ahead turns out to be a wall, on the map.
    values = HALL.values.copy()
    frame = HALL.frame
    low = frame.cell_of(0.0, 0.0)[0]
    values[low:, frame.cell_of(HERE.x + 0.35, 0.0)[1]] = OCCUPIED
    rig.grow(OccupancyMap(frame, values))
    assert rig.mission.driver is None
    rig = exploring()
    rig.grow(WHOLE)
    assert rig.mission.driver is None
    rig.tick()
    # Once it looks anew for what stands in the way.
    assert rig.phase is Phase.EXPLORING
    rig.tick()
    assert rig.phase is Phase.RETURNING


def test_a_map_of_other_paths_ends_a_drive_home() -> None:
    rig = exploring(WHOLE)
    rig.tick(2)
    assert rig.mission.driver is not None
    rig.grow(WHOLE)
    assert rig.mission.driver is None


@pytest.mark.parametrize("state", [DriveState.STUCK, DriveState.CUT_OFF])
def test_a_place_that_it_does_not_get_to_is_given_up(
    monkeypatch: pytest.MonkeyPatch, state: DriveState
) -> None:
    rig = exploring()
    assert rig.mission.exploration is not None
    stuck(rig, monkeypatch, state)
    assert rig.phase is Phase.EXPLORING
    assert len(rig.mission.exploration.unseen) == 1
    rig.tick()
    # Other places of the doorway may be left; then there is none.
    while rig.phase is Phase.EXPLORING:
        assert len(rig.mission.exploration.unseen) < 4
        if rig.mission.driver is not None:
            stuck(rig, monkeypatch, DriveState.CUT_OFF)
        rig.tick()
    assert rig.phase is Phase.RETURNING
    rig.tick(pose=TWO_ROOMS.station, battery=DOCKED.battery)
    unseen = rig.result.unseen
    assert len(set(unseen)) == len(unseen) >= 1
    for x, y in unseen:
        assert WALL_X - 0.1 < x < WALL_X + 0.2
        assert DOOR[0] < y < DOOR[1]


def test_before_it_ends_it_tries_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is given up at one tick is no reason to end: others may be left."""
    rig = exploring()
    rig.mission.driver = None

    def give_one_up(exploration: Exploration, *asked: object) -> None:
        if exploration.times_given_up < 3:
            exploration.give_up((0.0, 0.0))

    monkeypatch.setattr(Exploration, "next_path", give_one_up)
    rig.tick(4)
    assert rig.phase is Phase.EXPLORING
    rig.tick()
    assert rig.phase is Phase.RETURNING


def test_stuck_again_and_again_it_asks_for_help(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = exploring()
    for times in range(CONFIG.exploring.most_stuck):
        assert rig.phase is Phase.EXPLORING
        stuck(rig, monkeypatch, DriveState.STUCK)
        assert rig.mission.exploration is not None
        assert rig.mission.exploration.times_stuck == times + 1
        rig.mission.exploration.given_up.clear()
        rig.tick(2)
    stuck(rig, monkeypatch, DriveState.STUCK)
    assert rig.phase is Phase.ERROR
    assert rig.mission.message == "it is stuck"
    assert rig.result.outcome is CleanOutcome.STUCK
    rig.command(Event.RESUME)
    assert rig.phase is Phase.EXPLORING
    assert rig.tick(3).twist != Twist()


def test_a_drive_that_ends_well_is_no_reason_to_give_up(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = exploring()
    stuck(rig, monkeypatch, DriveState.DONE)
    assert rig.mission.exploration is not None
    assert rig.mission.exploration.unseen == []


def test_low_it_goes_home_charges_until_it_is_full_and_goes_on() -> None:
    rig = exploring()
    rig.tick(round(6.0 / TICK), battery=LOW)
    assert rig.phase is Phase.RETURNING
    assert rig.mission.state.errand is Errand.EXPLORE
    rig.tick(pose=TWO_ROOMS.station, battery=replace(LOW, is_docked=True))
    assert rig.phase is Phase.CHARGING
    assert rig.mission.take_exploration() is None
    # How much an exploration still needs is not known.
    rig.tick(20, battery=Battery(CONFIG.energy.full_enough - 0.01, 26.0, is_docked=True))
    assert rig.phase is Phase.CHARGING
    rig.tick(battery=Battery(CONFIG.energy.full_enough, 26.0, is_docked=True))
    assert rig.phase is Phase.UNDOCKING
    assert rig.mission.exploration is not None


def test_a_long_pause_is_no_reason_to_give_up_where_it_was_going() -> None:
    rig = exploring()
    rig.command(Event.PAUSE)
    rig.tick(round(2.0 * CONFIG.exploring.patience / TICK))
    rig.command(Event.RESUME)
    rig.tick(20)
    assert rig.phase is Phase.EXPLORING
    assert rig.mission.exploration is not None
    assert rig.mission.exploration.unseen == []


def test_paused_it_stands_and_goes_on_from_there() -> None:
    rig = exploring()
    rig.command(Event.PAUSE)
    assert rig.tick(20).twist == Twist()
    assert rig.phase is Phase.PAUSED
    assert rig.mission.take_exploration() is None
    rig.command(Event.RESUME)
    assert rig.phase is Phase.EXPLORING
    assert rig.tick(3).twist != Twist()


@pytest.mark.parametrize(
    ("event", "outcome", "phase"),
    [
        (Event.STOP, CleanOutcome.STOPPED, Phase.IDLE),
        (Event.DOCK, CleanOutcome.STOPPED, Phase.RETURNING),
    ],
)
@pytest.mark.parametrize("is_paused", [False, True])
def test_commands_end_it(
    event: Event, outcome: CleanOutcome, phase: Phase, is_paused: bool
) -> None:
    rig = exploring()
    if is_paused:
        rig.command(Event.PAUSE)
    rig.command(event, "the operator pressed it")
    assert rig.phase is phase
    assert rig.mission.exploration is None
    assert rig.result.outcome is outcome
    rig.mission.explore(rig.senses)
    assert rig.mission.state.errand is Errand.EXPLORE


@pytest.mark.parametrize("is_paused", [False, True])
def test_after_an_emergency_stop_it_can_go_on(is_paused: bool) -> None:
    rig = exploring()
    if is_paused:
        rig.command(Event.PAUSE)
    rig.command(Event.EMERGENCY, "the operator pressed it")
    assert rig.tick(20).twist == Twist()
    with pytest.raises(CommandRefusedError, match="cannot explore now"):
        rig.mission.explore(rig.senses)
    rig.command(Event.RELEASE)
    assert rig.phase is Phase.PAUSED
    assert rig.tick(20).twist == Twist()
    assert rig.mission.take_exploration() is None
    rig.command(Event.RESUME)
    assert rig.phase is Phase.EXPLORING
    assert rig.tick(3).twist != Twist()


def test_a_newer_errand_takes_over() -> None:
    rig = exploring()
    rig.mission.explore(rig.senses)
    # The end of the older one must not be taken for that of the newer.
    assert rig.mission.take_exploration() is None
    assert rig.mission.exploration is not None
    rig.mission.clean(CleanRequest(), rig.senses)
    assert rig.result.outcome is CleanOutcome.STOPPED
    assert rig.mission.cleaning is not None
    rig.mission.explore(rig.senses)
    assert rig.mission.cleaning is None
    cleaned = rig.mission.take_result()
    assert cleaned is not None
    assert cleaned.outcome is CleanOutcome.STOPPED
    assert rig.mission.take_exploration() is None


def test_with_too_little_charge_it_does_not_begin() -> None:
    rig = Rig(replace(AWAY, battery=Battery(0.1, 26.0)))
    with pytest.raises(CommandRefusedError, match="bring the robot to its station"):
        rig.mission.explore(rig.senses)
    assert rig.phase is Phase.IDLE


@pytest.mark.parametrize(
    ("changes", "outcome"),
    [
        ({"lifted": True}, CleanOutcome.FAULT),
        ({"knowledge": Knowledge.LOST, "trouble": "carried"}, CleanOutcome.LOST),
        ({"battery": Battery(0.001, 26.0)}, CleanOutcome.BATTERY),
    ],
)
def test_what_goes_wrong_is_told_and_can_be_resumed(
    changes: dict[str, object], outcome: CleanOutcome
) -> None:
    rig = exploring()
    rig.tick(1, **changes)
    assert rig.phase is Phase.ERROR
    assert rig.result.outcome is outcome
    rig.tick(lifted=False, knowledge=Knowledge.KNOWN, battery=Battery())
    rig.command(Event.RESUME)
    assert rig.phase is Phase.EXPLORING
    assert rig.tick(3).twist != Twist()
