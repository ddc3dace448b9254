"""A clean is taken up again by a new mission, from a checkpoint that makes sense."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from fixtures.homes.worlds import IDEAL
from fixtures.robots.headless_cleans import THING, assert_all_clean, assert_stands, begun, command
from fixtures.robots.missions import (
    FLOOR_TOO_LITTLE,
    HOME,
    TWO_ROOMS,
    floor_clean,
    fresh_mission,
    in_phase,
    until,
    wait,
)
from fixtures.thoroughness import core_first

from roomba.clean_request import CleanRequest
from roomba.geometry import Pose
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.checkpoint import CheckpointError
from roomba.mission.cleaning.result import CleanOutcome, MissReason
from roomba.mission.phases.machine import Event
from roomba.vocabulary import CleanMode, Phase
from roomba.world.engine.state.arrays import Fault


def restarted(robot: HeadlessMission, values: dict[str, Any] | None = None) -> None:
    """The mission's process ended and begins again, with nothing but the checkpoint."""
    values = json.loads(json.dumps(values or robot.mission.checkpoint(robot.senses())))
    robot.things.forget()
    robot.mission = fresh_mission(robot)
    robot.mission.restore(values, robot.senses())


@pytest.mark.parametrize("seed", core_first(range(4), {0, 1}))
def test_ended_at_any_moment_a_new_mission_goes_on(seed: int) -> None:
    random = np.random.default_rng(seed)
    robot = HeadlessMission(HOME, seed=seed)
    robot.simulator.place_obstacle(*THING)
    request = CleanRequest(passes=1 + seed % 2)
    robot.mission.clean(request, robot.senses())
    ends = robot.seen.time + np.cumsum(random.exponential(30.0, 8))
    for at in ends:
        while robot.seen.time < at and not robot.is_home:
            robot.advance()
        if robot.mission.checkpoint(robot.senses()) is not None:
            restarted(robot)
    record = robot.run()
    result = record.result
    assert result.outcome is CleanOutcome.COMPLETED
    assert robot.is_home
    assert {missed.reason for missed in result.missed} <= {MissReason.THING}
    shadow = math.pi * (THING[2] + 0.1) ** 2
    assert floor_clean(robot) >= FLOOR_TOO_LITTLE - shadow / result.wanted
    # The ledgers go on, too.
    assert result.duration == pytest.approx(robot.seen.time, abs=1.0)
    assert result.dirt == pytest.approx(robot.seen.in_bin, rel=0.05)
    driven = robot.simulator.numbers["distance"]
    assert result.distance == pytest.approx(driven, rel=0.05)


def test_what_is_clean_is_not_cleaned_again_after_a_restart() -> None:
    whole = HeadlessMission(HOME, IDEAL).clean().distance
    robot = begun(130.0, HeadlessMission(HOME, IDEAL))
    assert floor_clean(robot) > 0.4
    driven = robot.simulator.numbers["distance"]
    restarted(robot)
    assert_all_clean(robot, robot.run())
    assert robot.simulator.numbers["distance"] - driven < 0.75 * whole


@pytest.mark.parametrize("phase", [Phase.UNDOCKING, Phase.CLEANING, Phase.RETURNING, Phase.DOCKING])
def test_each_phase_can_be_taken_up_again(phase: Phase) -> None:
    robot = HeadlessMission(HOME)
    request = CleanRequest(CleanMode.SPOT, spot=(2.0, 0.6))
    robot.mission.clean(request, robot.senses())
    until(robot, in_phase(robot, phase))
    for _ in range(20):
        robot.tick()
    restarted(robot)
    record = robot.run()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert record.result.fraction >= 0.99
    assert robot.is_home


def test_a_clean_that_an_emergency_stop_interrupted_waits_for_it_after_a_restart() -> None:
    robot = begun(60.0)
    command(robot, Event.EMERGENCY, "a child")
    restarted(robot)
    assert (robot.mission.state.phase, robot.mission.message) == (Phase.EMERGENCY, "a child")
    assert_stands(robot)
    command(robot, Event.RELEASE)
    assert robot.mission.state.phase is Phase.PAUSED
    restarted(robot)
    assert_stands(robot)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_what_was_held_up_stays_so_after_a_restart() -> None:
    robot = begun()
    command(robot, Event.PAUSE)
    restarted(robot)
    assert robot.mission.state.phase is Phase.PAUSED
    assert_stands(robot)
    command(robot, Event.RESUME)
    wait(robot, 5.0)
    robot.simulator.inject(Fault.LIFTED, 1.0)
    robot.run()
    robot.simulator.inject(Fault.LIFTED, 0.0)
    wait(robot, 1.0)
    restarted(robot)
    assert robot.mission.state.phase is Phase.ERROR
    assert "wheel" in robot.mission.message
    assert_stands(robot)
    command(robot, Event.RESUME)
    assert_all_clean(robot, robot.run())


def test_a_restart_while_it_charges_goes_on_charging() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    restarted(robot)
    wait(robot, 5.0)
    assert robot.mission.state.phase is Phase.CHARGING
    robot.simulator.set_charge(0.95)
    assert_all_clean(robot, robot.run())


def test_without_an_errand_there_is_nothing_to_remember() -> None:
    robot = HeadlessMission(HOME)
    assert robot.mission.checkpoint(robot.senses()) is None
    command(robot, Event.UNDOCK)
    assert robot.mission.checkpoint(robot.senses()) is None
    until(robot, in_phase(robot, Phase.IDLE))
    assert robot.mission.checkpoint(robot.senses()) is None


def test_on_its_way_home_by_command_it_goes_on_after_a_restart() -> None:
    robot = HeadlessMission(HOME, start=Pose(2.5, 0.6, 1.0))
    command(robot, Event.DOCK)
    wait(robot, 4.0)
    restarted(robot)
    until(robot, lambda: robot.is_home, 60.0)


def set_in(values: Any, path: str, new: object) -> None:
    """Set what is at a path of keys and numbers."""
    *way, last = path.split(".")
    for key in way:
        values = values[int(key) if isinstance(values, list) else key]
    values[int(last) if isinstance(values, list) else last] = new


@pytest.mark.parametrize(
    ("path", "junk"),
    [
        ("version", 99),
        ("version", None),
        ("phase", "DANCING"),
        ("phase", None),
        ("errand", "FLYING"),
        ("errand", []),
        ("resumes", 7),
        ("outcome", "SPLENDID"),
        ("cleaning", None),
        ("cleaning", 5),
        ("cleaning", {}),
        ("cleaning.request", {}),
        ("cleaning.request.mode", "thorough"),
        ("cleaning.request.passes", 0),
        ("cleaning.request.passes", "many"),
        ("cleaning.request.fan", "LOUD"),
        ("cleaning.request.zones", [[1.0, 2.0]]),
        ("cleaning.request.spot", ["here", "there"]),
        ("cleaning.stages", 3),
        ("cleaning.stages", [["whole"]]),
        ("cleaning.stages.0.1", "bm90IGEgbWFzaw=="),
        ("cleaning.stage_number", 7),
        ("cleaning.stage_number", -1),
        ("cleaning.stage_number", "one"),
        ("cleaning.wanted", "!"),
        ("cleaning.swept", ""),
        ("cleaning.swept", 12),
        ("cleaning.ever", None),
        ("ledger", [1.0, 2.0]),
        ("ledger", ["far", 0.0, 0.0]),
        ("ledger", None),
        ("duration", "long"),
    ],
)
def test_a_checkpoint_that_is_junk_is_refused(path: str, junk: object) -> None:
    robot = begun(12.0)
    values = json.loads(json.dumps(robot.mission.checkpoint(robot.senses())))
    set_in(values, path, junk)
    robot.mission = fresh_mission(robot)
    with pytest.raises(CheckpointError, match="expected"):
        robot.mission.restore(values, robot.senses())
    assert robot.mission.cleaning is None
    assert not robot.mission.state.drives


SINCE_OLDER_ONES = {"bin_full_at", "driven", "hindrance", "open_edges", "rough_way"}
"""Of these an older checkpoint has none."""


def test_a_checkpoint_without_something_is_refused() -> None:
    robot = begun(12.0)
    values = robot.mission.checkpoint(robot.senses())
    assert values is not None
    for name in values.keys() - SINCE_OLDER_ONES:
        less = {key: value for key, value in values.items() if key != name}
        with pytest.raises(CheckpointError, match=name):
            fresh_mission(robot).restore(less, robot.senses())
    for name in values["cleaning"]:
        less = {key: value for key, value in values["cleaning"].items() if key != name}
        with pytest.raises(CheckpointError, match=name):
            fresh_mission(robot).restore({**values, "cleaning": less}, robot.senses())


def test_a_checkpoint_of_another_map_is_refused() -> None:
    values = begun(12.0).mission.checkpoint(begun(12.0).senses())
    assert values is not None
    other = HeadlessMission(TWO_ROOMS)
    with pytest.raises(CheckpointError, match="expected a grid of"):
        other.mission.restore(values, other.senses())


def test_charging_off_its_station_after_a_restart_it_looks_for_it() -> None:
    robot = begun()
    robot.simulator.set_charge(0.085)
    until(robot, in_phase(robot, Phase.CHARGING), 120.0)
    values = robot.mission.checkpoint(robot.senses())
    robot.simulator.put(Pose(1.0, 1.0, 0.0))
    robot.localizer.told(robot.simulator.pose, (0.05, 0.05))
    robot.simulator.set_charge(0.2)
    robot.tick()
    restarted(robot, values)
    until(robot, lambda: robot.seen.battery.is_docked, 120.0)
