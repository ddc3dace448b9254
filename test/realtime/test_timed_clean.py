"""A whole clean at 115200 baud, and one through OpenNeato's bridge, by a clock of their own."""

from __future__ import annotations

import pytest
from fixtures.robots.timed_neato import TimedNeato, brain_on

from roomba.clean_request import CleanRequest
from roomba.commands.trials.runs import mission_config
from roomba.configuration.robot import load_robot_config
from roomba.drivers.robots.table import ROBOTS
from roomba.mission.cleaning.result import CleanOutcome
from roomba.vocabulary import Phase

LONGEST = 3000.0
"""s of the robot's clock."""


@pytest.mark.parametrize("is_bridged", [False, True], ids=["line", "bridge"])
def test_it_cleans_a_home_that_it_does_not_know_and_docks(is_bridged: bool) -> None:
    neato = TimedNeato(115_200, seed=2, is_bridged=is_bridged)
    robot = brain_on(neato, mission_config(load_robot_config(ROBOTS["neato"].file)))
    robot.mission.clean(CleanRequest(), robot.senses())
    result = None
    while result is None:
        assert neato.now < LONGEST, robot.mission.message
        neato.pass_time(1.0)
        result = robot.mission.take_result()
    hits = neato.simulator.numbers["hits"]
    print(
        f"\n{result.outcome.value} ({result.message}): {result.covered:.2f} of "
        f"{result.wanted:.2f} m2, {result.distance:.1f} m in {result.duration:.0f} s, {hits:.0f} "
        f"hits; missed {result.missed}"
    )
    assert result.outcome is CleanOutcome.COMPLETED
    assert result.covered > 0.98 * result.wanted
    assert hits < 5
    assert robot.mission.state.phase is Phase.DOCKED
    assert neato.simulator.observe().battery.is_docked
