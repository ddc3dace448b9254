"""Commands and events for a mission without a world, and its answers."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest
from fixtures.missions.told_mission import TICK, ToldMission
from fixtures.robots.missions import HOME, STATION

from roomba.clean_request import CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import DrivingConfig, MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import ConfigError
from roomba.geometry import Pose, Twist
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.commands import CommandRefusedError
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.mission.inputs.senses import Battery, Senses
from roomba.mission.mission import Mission
from roomba.mission.phases.machine import Errand, Event
from roomba.mission.ticks import MissionStep
from roomba.perception.localization.estimate import Knowledge
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.swept.dirt_map import DirtMap
from roomba.perception.things.layer import ThingLayer
from roomba.vocabulary import Phase

CONFIG = RobotConfig()
CONTEXT = PlanningContext(HOME.map, HOME.station, CONFIG, MissionConfig(), DockingConfig())
FIELD = SurfaceField.of(HOME.map)
HERE = Pose(1.0, 0.6, 0.0)
AWAY = Senses(0.0, HERE)
DOCKED = Senses(0.0, STATION, battery=Battery(1.0, 26.0, is_docked=True))


class Rig(ToldMission):
    """A mission whose senses are made by hand; it stands unless it is put somewhere else."""

    def __init__(self, senses: Senses = AWAY) -> None:
        super().__init__(
            Mission(
                CONTEXT,
                CONFIG,
                MissionConfig(),
                DockingConfig(),
                ThingLayer(FIELD),
                DirtMap(HOME.map),
                senses,
            ),
            senses,
        )

    def clean(self) -> Rig:
        self.mission.clean(CleanRequest(), self.senses)
        return self


def cleaning() -> Rig:
    rig = Rig().clean()
    rig.tick(5)
    assert rig.phase is Phase.CLEANING
    return rig


@pytest.mark.parametrize(("senses", "phase"), [(AWAY, Phase.IDLE), (DOCKED, Phase.DOCKED)])
def test_it_begins_standing_where_it_is(senses: Senses, phase: Phase) -> None:
    rig = Rig(senses)
    assert rig.phase is phase
    assert rig.tick(20) == MissionStep()
    assert rig.phase is phase


def test_put_onto_its_station_and_taken_off_it_knows() -> None:
    rig = Rig()
    rig.tick(battery=DOCKED.battery)
    assert rig.phase is Phase.DOCKED
    rig.tick(battery=AWAY.battery)
    assert rig.phase is Phase.IDLE


@pytest.mark.parametrize("event", [Event.PAUSE, Event.RESUME, Event.RELEASE])
def test_what_means_nothing_is_refused_and_changes_nothing(event: Event) -> None:
    rig = Rig()
    state = rig.mission.state
    with pytest.raises(CommandRefusedError, match=f"cannot {event.value} now.*idle"):
        rig.command(event)
    assert rig.mission.state == state


def test_told_to_clean_it_drives() -> None:
    rig = cleaning()
    assert rig.mission.state.errand is Errand.CLEAN
    assert rig.tick().twist != Twist()
    assert rig.mission.sweeps


def test_it_goes_and_reckons_no_faster_than_the_robot() -> None:
    rig = cleaning()
    speed, left = rig.mission.speed_limit(rig.senses), rig.mission.seconds_to_go()
    rig.mission.max_speed = 0.5 * speed
    assert rig.mission.speed_limit(rig.senses) == 0.5 * speed
    assert rig.mission.seconds_to_go() == pytest.approx(2.0 * left)
    rig.mission.max_speed = 0.02
    rough = replace(rig.senses, knowledge=Knowledge.ROUGH)
    assert rig.mission.speed_limit(rough) == 0.02


def test_while_it_waits_it_reckons_with_what_comes_afterwards() -> None:
    rig = cleaning()
    left = rig.mission.seconds_to_go()
    rig.command(Event.PAUSE)
    assert rig.mission.seconds_to_go() == pytest.approx(left, rel=0.5)
    rig.command(Event.DOCK)
    assert rig.mission.seconds_to_go() == 0.0


def test_speeds_that_the_robot_cannot_do_are_refused() -> None:
    fast = MissionConfig(driving=DrivingConfig(speed=0.8))
    parts = ThingLayer(FIELD), DirtMap(HOME.map)
    with pytest.raises(ConfigError, match=r"driving\.speed: expected at most 0\.5 m/s"):
        Mission(CONTEXT, CONFIG, fast, DockingConfig(), *parts, AWAY)


def test_knowing_its_place_only_roughly_it_drives_slowly() -> None:
    rig = cleaning()
    fast = rig.mission.speed_limit(rig.senses)
    slow = rig.mission.speed_limit(replace(rig.senses, knowledge=Knowledge.ROUGH))
    assert fast == MissionConfig().driving.speed
    assert slow == CONFIG.walk.careful_speed < fast


def test_not_knowing_its_place_it_stands_and_looks_around() -> None:
    rig = cleaning()
    step = rig.tick(10, knowledge=Knowledge.SEARCHING, trouble="it was carried")
    assert step == MissionStep(Twist(), looks_around=True)
    assert rig.mission.message == "it stands until it knows where it is: it was carried"
    assert rig.phase is Phase.CLEANING
    assert rig.mission.steady(rig.senses) is None
    step = rig.tick(2, knowledge=Knowledge.KNOWN)
    assert not step.looks_around
    assert step.twist != Twist()


@pytest.mark.parametrize("jump", [0.0, -1e5])
def test_not_finding_its_place_in_time_is_an_error(jump: float) -> None:
    rig = cleaning()
    rig.tick(2, knowledge=Knowledge.SEARCHING, trouble="too little in sight")
    rig.senses = replace(rig.senses, now=rig.senses.now + jump)
    seconds = CONFIG.walk.astray_timeout
    rig.tick(round((seconds - 1.0) / TICK))
    assert rig.phase is Phase.CLEANING
    rig.tick(round(2.0 / TICK))
    assert rig.phase is Phase.ERROR
    assert "too little in sight" in rig.mission.message
    result = rig.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.LOST


def test_lost_it_says_so_at_once() -> None:
    rig = cleaning()
    rig.tick(knowledge=Knowledge.LOST, trouble="nothing looks familiar")
    assert rig.phase is Phase.ERROR
    assert "nothing looks familiar" in rig.mission.message
    rig.tick(knowledge=Knowledge.KNOWN)
    assert rig.phase is Phase.ERROR
    rig.command(Event.RESUME)
    assert rig.mission.message == ""
    assert rig.tick(3).twist != Twist()


def test_what_it_passes_while_its_place_is_unknown_is_not_clean() -> None:
    rig = cleaning()
    coverage = rig.mission.cleaning.ledger.coverage  # type: ignore[union-attr]
    swept = coverage.swept_cells
    rig.tick(knowledge=Knowledge.SEARCHING)
    rig.tick(3, pose=Pose(1.2, 0.6, 0.0))
    assert coverage.swept_cells == swept
    rig.tick(2, knowledge=Knowledge.KNOWN)
    # Only where it is now: not the way there.
    assert 0 < coverage.swept_cells - swept < 400


def test_lifted_its_error_says_what_to_do() -> None:
    rig = cleaning()
    assert rig.tick(lifted=True).twist == Twist()
    assert rig.phase is Phase.ERROR
    assert "resume" in rig.mission.message
    result = rig.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.FAULT
    assert rig.mission.take_result() is None


def test_a_wheel_in_the_air_at_a_sill_does_not_end_its_clean() -> None:
    rig = cleaning()
    rig.tick(wheel_hangs=True)
    rig.tick(wheel_hangs=False)
    assert rig.phase is Phase.CLEANING


def test_lifted_while_it_stands_is_no_matter() -> None:
    rig = Rig()
    rig.tick(lifted=True)
    assert rig.phase is Phase.IDLE
    rig = cleaning()
    rig.command(Event.PAUSE)
    rig.tick(5, lifted=True)
    assert rig.phase is Phase.PAUSED


def test_set_onto_its_station_while_paused_it_comes_out_of_it_again() -> None:
    rig = cleaning()
    rig.command(Event.PAUSE)
    rig.tick(5, battery=DOCKED.battery, pose=STATION)
    assert rig.phase is Phase.PAUSED
    rig.command(Event.RESUME)
    assert rig.phase is Phase.CHARGING
    assert rig.tick(5).twist.linear < 0.0
    assert rig.phase is Phase.UNDOCKING


def test_resumed_on_its_station_it_goes_on_as_soon_as_there_is_enough() -> None:
    rig = cleaning()
    rig.command(Event.PAUSE)
    rig.tick(2, battery=Battery(0.004, 26.0, is_docked=True), pose=STATION)
    for _ in range(3):
        rig.command(Event.RESUME)
        assert rig.tick(20) == MissionStep()
        assert rig.phase is Phase.CHARGING
        rig.command(Event.PAUSE)
    rig.command(Event.RESUME)
    rig.tick(5, battery=DOCKED.battery)
    assert rig.phase is Phase.UNDOCKING


def test_with_an_empty_battery_a_clean_begins_by_charging() -> None:
    rig = Rig(replace(DOCKED, battery=Battery(0.004, 26.0, is_docked=True)))
    rig.clean()
    assert rig.tick(20) == MissionStep()
    assert rig.mission.state.phase is Phase.CHARGING
    assert rig.mission.state.errand is Errand.CLEAN
    assert rig.mission.take_result() is None
    assert rig.mission.message == "the battery is empty: it stays on its station to charge"
    rig.tick(5, battery=DOCKED.battery)
    assert rig.phase is Phase.UNDOCKING


def test_with_an_empty_battery_it_is_not_driven_off_its_station() -> None:
    rig = Rig(replace(DOCKED, battery=Battery(0.004, 26.0, is_docked=True)))
    rig.command(Event.UNDOCK)
    assert rig.tick(20) == MissionStep()
    assert rig.phase is Phase.DOCKED
    assert "the battery is empty" in rig.mission.message
    assert rig.mission.way_ended(Errand.UNDOCK) is CleanOutcome.STOPPED


def test_the_books_are_the_cleans_own() -> None:
    rig = cleaning()
    rig.tick(100, in_bin=3.0)
    rig.tick(1, battery=Battery(0.9, 26.0))
    rig.command(Event.STOP)
    result = rig.mission.take_result()
    assert result is not None
    assert result.dirt == pytest.approx(3.0)
    assert result.energy == pytest.approx(2.6)
    assert result.duration == pytest.approx(106 * TICK, abs=2 * TICK)
    rig.clean()
    rig.tick(10)
    rig.command(Event.STOP)
    result = rig.mission.take_result()
    assert result is not None
    assert (result.dirt, result.energy, result.distance) == (0.0, 0.0, 0.0)
    assert result.duration == pytest.approx(10 * TICK, abs=2 * TICK)


def test_what_a_pause_takes_is_told_but_says_nothing_of_a_metre() -> None:
    rig = cleaning()
    for step in range(300):
        rig.tick(pose=Pose(HERE.x + 0.05 * (step % 2), HERE.y, 0.0), battery=Battery(0.9, 26.0))
    ledger = rig.mission.ledger
    used, per_metre = ledger.energy, ledger.per_metre
    rig.command(Event.PAUSE)
    rig.tick(10, battery=Battery(0.5, 26.0))
    assert ledger.energy == pytest.approx(used + 0.4 * 26.0)
    assert ledger.per_metre == per_metre


@pytest.mark.parametrize("jump", [-1e5, 1e5])
def test_a_clock_that_is_set_does_not_count_as_cleaning(jump: float) -> None:
    rig = cleaning()
    rig.tick(20)
    rig.senses = replace(rig.senses, now=rig.senses.now + jump)
    rig.tick(20)
    rig.command(Event.STOP)
    result = rig.mission.take_result()
    assert result is not None
    assert result.duration == pytest.approx(45 * TICK, abs=1.0)


def test_no_energy_is_told_and_ends_it() -> None:
    rig = cleaning()
    rig.tick(battery=Battery(0.001, 26.0))
    assert rig.phase is Phase.ERROR
    result = rig.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.BATTERY


def test_before_a_low_battery_empties_it_returns() -> None:
    rig = cleaning()
    rig.tick(round(6.0 / TICK), battery=Battery(0.08, 26.0))
    assert rig.phase in (Phase.RETURNING, Phase.DOCKING)
    assert rig.mission.state.errand is Errand.CLEAN


def test_stopped_on_its_station_it_stays_there() -> None:
    rig = Rig(DOCKED)
    rig.command(Event.STOP)
    assert rig.phase is Phase.DOCKED
    rig.command(Event.DOCK)
    assert rig.phase is Phase.DOCKED
    assert rig.mission.take_result() is None


FULL = CONFIG.brush.bin_capacity


def waiting_for_an_empty_bin() -> Rig:
    rig = cleaning()
    rig.tick(in_bin=FULL)
    rig.tick(3, battery=DOCKED.battery, pose=STATION)
    assert rig.phase is Phase.BIN_FULL
    return rig


def test_with_a_full_bin_it_returns_and_sweeps_nothing() -> None:
    rig = cleaning()
    cleaning_under_way = rig.mission.cleaning
    assert cleaning_under_way is not None
    rig.tick(in_bin=FULL)
    assert (rig.phase, rig.mission.state.errand) == (Phase.RETURNING, Errand.CLEAN)
    assert not rig.mission.sweeps
    assert rig.mission.message.startswith("bin full: ")
    swept = cleaning_under_way.ledger.coverage.swept.copy()
    dirt = rig.mission.dirt.way.copy()
    rig.tick(20, pose=Pose(1.6, 0.6, 0.0), grains=5.0)
    assert (cleaning_under_way.ledger.coverage.swept == swept).all()
    assert (rig.mission.dirt.way == dirt).all()


def test_on_its_station_it_waits_for_an_empty_bin_and_says_so() -> None:
    rig = waiting_for_an_empty_bin()
    rig.tick(round(60.0 / TICK))
    assert (rig.phase, rig.mission.state.errand) == (Phase.BIN_FULL, Errand.CLEAN)
    assert rig.mission.message.startswith("bin full: ")
    assert rig.mission.take_result() is None
    rig.tick(2, in_bin=0.0)
    assert rig.phase is Phase.UNDOCKING
    assert rig.mission.message == ""


def test_told_that_the_bin_is_empty_it_goes_by_its_level_sensor() -> None:
    rig = waiting_for_an_empty_bin()
    with pytest.raises(CommandRefusedError, match="100% full by its level sensor"):
        rig.mission.command(Event.EMPTIED, rig.senses)
    rig.tick()
    assert rig.phase is Phase.BIN_FULL
    # One that sticks somewhere in the middle is not worth more than the operator's word.
    rig.senses = replace(rig.senses, in_bin=0.6 * FULL)
    rig.tick()
    assert rig.phase is Phase.BIN_FULL
    rig.mission.command(Event.EMPTIED, rig.senses)
    rig.tick(2)
    assert rig.phase is Phase.UNDOCKING


def test_carried_off_while_its_bin_is_emptied_it_goes_home_to_charge() -> None:
    rig = waiting_for_an_empty_bin()
    rig.tick(20, battery=AWAY.battery, pose=HERE)
    assert rig.phase is Phase.BIN_FULL
    rig.tick(3, in_bin=0.0)
    assert (rig.phase, rig.mission.state.errand) == (Phase.RETURNING, Errand.CLEAN)


def test_a_clean_with_a_full_bin_is_refused() -> None:
    rig = Rig(replace(DOCKED, in_bin=FULL))
    with pytest.raises(CommandRefusedError, match="room in the dust bin"):
        rig.clean()
    assert rig.phase is Phase.DOCKED
    rig.tick(in_bin=0.0)
    assert rig.clean().phase is Phase.UNDOCKING


@pytest.mark.parametrize(
    ("event", "phase"), [(Event.STOP, Phase.DOCKED), (Event.DOCK, Phase.DOCKED)]
)
def test_waiting_for_an_empty_bin_it_can_be_stopped(event: Event, phase: Phase) -> None:
    rig = waiting_for_an_empty_bin()
    rig.command(event)
    rig.tick()
    assert rig.phase is phase
    result = rig.mission.take_result()
    assert result is not None
    assert result.outcome is CleanOutcome.STOPPED


@pytest.mark.parametrize("told", [{"bin_full_at": 0.0}, {}], ids=["grains", "older"])
def test_killed_while_its_bin_is_full_it_still_knows(told: dict[str, float]) -> None:
    """Where the grains told, and no level sensor tells it anew; and by an older checkpoint."""
    rig = waiting_for_an_empty_bin()
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    del values["bin_full_at"]
    again = Rig(replace(rig.senses, in_bin=0.0))
    again.mission.restore({**values, **told}, again.senses)
    again.tick(5)
    assert again.phase is Phase.BIN_FULL
    again.mission.command(Event.EMPTIED, again.senses)
    again.tick(2)
    assert again.phase is Phase.UNDOCKING


def test_a_bin_that_was_emptied_while_the_program_was_not_running_is_empty() -> None:
    rig = waiting_for_an_empty_bin()
    values = rig.mission.checkpoint(rig.senses)
    assert values is not None
    again = Rig(replace(rig.senses, in_bin=0.0))
    again.mission.restore(values, again.senses)
    again.tick(2)
    assert again.phase is Phase.UNDOCKING


def test_floor_that_was_swept_without_a_grain_by_an_almost_full_bin_is_not_clean() -> None:
    rig = cleaning()
    under_way = rig.mission.cleaning
    assert under_way is not None
    lanes = [(x, 0.2 + 0.1 * (row // 2)) for row, x in enumerate((0.2, 2.8, 2.8, 0.2) * 5)]
    drive(rig, lanes, grains=900.0, in_bin=0.9 * FULL)
    swept = under_way.ledger.coverage.swept_area
    assert swept > 2.0
    drive(rig, [(x, y + 1.1) for x, y in lanes], grains=0.0)
    assert rig.phase is Phase.RETURNING
    # But for the last metre of it.
    assert 0.85 * swept < under_way.ledger.coverage.swept_area < 1.1 * swept


def drive(rig: Rig, points: list[tuple[float, float]], **changes: object) -> None:
    """Let it be at one place after the other, 5 cm apart, until it returns."""
    rig.tick(1, **changes)
    for (x, y), (to_x, to_y) in pairwise(points):
        count = max(round(math.dist((x, y), (to_x, to_y)) / 0.05), 1)
        for step in range(1, count + 1):
            share = step / count
            pose = Pose(x + share * (to_x - x), y + share * (to_y - y), 0.0)
            if rig.phase is Phase.CLEANING:
                rig.tick(pose=pose)
