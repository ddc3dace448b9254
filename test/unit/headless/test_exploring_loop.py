"""The compiled exploring loop against the ordinary classes, tick by tick.

Both drive the same way to the last bit until a path ends: there the compiled loop stands for a tick
more.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import pytest
from fixtures.missions import TWO_ROOMS
from fixtures.worlds import IDEAL, NOISY
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.headless.explorer import HeadlessExplorer
from roomba.headless.exploring_loop import ExploringLoop
from roomba.headless.exploring_loop_kernels import BELIEVED, GYRO, ODOMETRY, PASSED, TIME, TRUE
from roomba.mission.cleaning.request import CleanOutcome
from roomba.mission.phases.machine import Phase
from roomba.perception.localization.estimate import Knowledge
from roomba.world.engine.state.arrays import Fault

FIRST_PATH: Final = 300
"""Ticks until the first path in TWO_ROOMS ends, and some less."""


def exploring(robot: HeadlessExplorer, ticks: int) -> NDArray[np.float64]:
    """Let it explore; return the ticks that passed."""
    robot.mission.explore(robot.senses())
    while sum(map(len, robot.passed)) < ticks:
        robot.advance()
    return np.concatenate(robot.passed)[:ticks]


def under_way() -> tuple[HeadlessExplorer, ExploringLoop]:
    """A robot on its way to a frontier, and its loop, that may run."""
    robot = HeadlessExplorer(TWO_ROOMS, NOISY, seed=1)
    robot.mission.explore(robot.senses())
    loop = robot._loop
    while robot.mission.state.phase is not Phase.EXPLORING or not loop.may_run():
        robot.tick()
    return robot, loop


@pytest.mark.parametrize("burst", [60, 7])
@pytest.mark.parametrize("config", [IDEAL, NOISY], ids=["ideal", "noisy"])
def test_both_drive_the_same_way(config: SimulatedRobotConfig, burst: int) -> None:
    robots = [HeadlessExplorer(TWO_ROOMS, config, seed=5, longest_burst=n) for n in (0, burst)]
    ticked, compiled = (exploring(robot, FIRST_PATH) for robot in robots)
    assert np.hypot(*np.diff(ticked[[0, -1], 1:3], axis=0).T) > 0.3
    assert np.array_equal(compiled, ticked)
    assert len(robots[0].passed) == FIRST_PATH
    # Undocking is none of it, and the rest was nearly all compiled.
    assert len(robots[1].passed) < 100 + 0.5 * FIRST_PATH
    one, other = (robot.mapper.occupancy().values for robot in robots)
    assert np.array_equal(one, other)


def test_both_explore_as_well() -> None:
    """Where one path ends a tick later the next one may be another: all in all it is as good."""
    seconds = []
    for burst in (0, 60):
        robots = [HeadlessExplorer(TWO_ROOMS, NOISY, seed=n, longest_burst=burst) for n in range(4)]
        results = [robot.explore().result for robot in robots]
        assert all(result.outcome is CleanOutcome.COMPLETED for result in results)
        assert min(result.known for result in results) > 5.0
        seconds.append(sum(result.duration for result in results))
    assert seconds[1] == pytest.approx(seconds[0], rel=0.2)


def test_what_passed_is_told_tick_by_tick() -> None:
    robot, loop = under_way()
    robot.passed.clear()
    for _ in range(5):
        if loop.may_run():
            loop.run(math.inf)
        else:
            robot.tick()
    rows = np.concatenate(robot.passed)
    assert rows.shape == (len(rows), PASSED)
    assert np.diff(rows[:, TIME]) == pytest.approx(0.05)
    seen, believed = robot.seen, robot.mapper.pose
    assert rows[-1, TIME] == seen.time
    for columns, pose in ((TRUE, seen.pose), (BELIEVED, believed), (ODOMETRY, seen.odometry)):
        assert rows[-1, columns].tolist() == [pose.x, pose.y, pose.theta]
    assert rows[-1, GYRO] == seen.angular_velocity


@pytest.mark.parametrize("longest", [1, 5, 17])
def test_after_so_many_ticks_the_mission_has_its_turn(longest: int) -> None:
    robot, _ = under_way()
    loop = ExploringLoop(robot, longest)
    robot.passed.clear()
    while loop.may_run():
        loop.run(math.inf)
    assert sum(map(len, robot.passed)) == longest
    loop.was_ticked()
    assert loop.may_run()


def test_a_scan_worth_keeping_ends_it_and_is_on_the_map() -> None:
    robot, loop = under_way()
    for _ in range(40):
        kept = len(robot.mapper.trajectory)
        if not loop.may_run():
            robot.tick()
            continue
        loop.run(math.inf)
        if len(robot.mapper.trajectory) > kept:
            break
    assert len(robot.mapper.trajectory) == kept + 1
    here, pose = robot.mapper.trajectory[-1], robot.mapper.pose
    assert here == pytest.approx([pose.x, pose.y, pose.theta])
    assert robot.mapper.estimate.knowledge is Knowledge.KNOWN


def test_it_ends_at_the_time_that_it_is_told() -> None:
    robot, loop = under_way()
    before = robot.seen.time
    loop.run(before + 0.12)
    assert robot.seen.time == pytest.approx(before + 0.15)


@pytest.mark.parametrize("fault", [Fault.BUMPER_STUCK, Fault.CLIFF_DIRTY, Fault.LIFTED])
def test_it_does_not_run_while_anything_is_the_matter(fault: Fault) -> None:
    robot, loop = under_way()
    robot.simulator.inject(fault, 1.0)
    before = robot.seen.time
    loop.run(math.inf)
    # Something comes up in the first tick, and ends it.
    assert robot.seen.time == pytest.approx(before + 0.05)
    assert not loop.may_run()


def test_it_ends_when_nothing_is_seen() -> None:
    robot, loop = under_way()
    robot.simulator.inject(Fault.LIDAR_BLOCKED, 1.0)
    before = robot.seen.time
    while loop.may_run():
        loop.run(math.inf)
    # Each second scan is used, and there are ten in a second.
    assert robot.seen.time - before < 0.5
    assert robot.mapper.estimate.knowledge is Knowledge.ROUGH


def test_what_comes_into_its_way_is_seen_in_time() -> None:
    robot, loop = under_way()
    while robot.mission.driver is None or robot.mission.driver.left < 1.2:
        robot.advance()
    ahead = robot.simulator.pose.compose(Pose(0.6, 0.0, 0.0))
    robot.simulator.place_obstacle(ahead.x, ahead.y, 0.05)
    version = robot.mission.obstacles.version
    while robot.mission.obstacles.version == version:
        robot.advance()
    assert not robot.seen.bumper.pressed
    assert robot.simulator.gap > 0.05
    assert loop.left >= 0


def test_docked_or_paused_it_does_not_run() -> None:
    docked = HeadlessExplorer(TWO_ROOMS)
    docked.tick()
    assert not docked._loop.may_run()
    robot, loop = under_way()
    robot.mission.state = type(robot.mission.state)(Phase.PAUSED)
    assert not loop.may_run()
