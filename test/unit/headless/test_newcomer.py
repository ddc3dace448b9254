"""Whole cleans of small homes that the robot has never seen, counted by where it really was."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.mapped import wrong_cells
from fixtures.robots.missions import HOME, TWO_ROOMS
from numpy.typing import NDArray

from roomba.clean_request import CleanRefusedError, CleanRequest
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.vocabulary import CleanMode, Phase
from roomba.world.home.home import Home


def newcomer(home: Home, seed: int = 0) -> HeadlessMission:
    return HeadlessMission(home, NOISY, seed=seed, known=MappingConfig())


def share_cleaned(poses: NDArray[np.float64], home: Home) -> float:
    """Of the floor that can be cleaned, by the true map and the true poses."""
    context = PlanningContext(
        home.map, home.station, RobotConfig(), MissionConfig(), DockingConfig()
    )
    truth = CoverageMap(context.frame, context.coverable(), context.tool_width)
    for x, y in poses[:, 1:3]:
        truth.sweep(float(x), float(y))
    return truth.fraction


@pytest.mark.parametrize("home", [HOME, TWO_ROOMS])
def test_a_home_is_cleaned_while_it_is_mapped(home: Home) -> None:
    robot = newcomer(home, 3)
    record = robot.clean()
    assert record.result.outcome is CleanOutcome.COMPLETED
    assert robot.mission.state.phase is Phase.DOCKED
    assert not robot.mission.context.is_growing
    assert wrong_cells(record.occupancy, home) == (0, 0)
    assert share_cleaned(record.poses, home) > 0.985
    assert record.result.fraction > 0.99
    # It believes what is so.
    assert record.result.fraction == pytest.approx(share_cleaned(record.poses, home), abs=0.01)


def test_it_cleans_before_the_map_is_whole() -> None:
    robot = newcomer(TWO_ROOMS, 3)
    record = robot.clean()
    before = record.poses[record.poses[:, 0] < record.whole_at]
    assert len(before) < len(record.poses)
    assert share_cleaned(before, TWO_ROOMS) > 0.3


def test_plans_are_counted_on_every_map_that_it_made() -> None:
    robot = newcomer(HOME, 3)
    record = robot.clean()
    assert robot.mission.context is not robot.context
    assert record.plans >= 1
    assert 0.0 < record.planning < 60.0


def test_two_passes_sweep_all_twice() -> None:
    once, twice = (newcomer(HOME, 1).clean(CleanRequest(passes=passes)) for passes in (1, 2))
    assert twice.result.outcome is CleanOutcome.COMPLETED
    assert twice.result.distance > 1.5 * once.result.distance


def test_rooms_are_refused_before_there_are_any() -> None:
    robot = newcomer(TWO_ROOMS)
    with pytest.raises(CleanRefusedError, match="clean the whole home"):
        robot.clean(CleanRequest(CleanMode.ROOMS, rooms=("den",)))
    assert robot.mission.state.phase is Phase.DOCKED
    assert np.count_nonzero(robot.simulator.numbers["distance"]) == 0
