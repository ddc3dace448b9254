"""The compiled loop against the ordinary classes, tick by tick.

Compiled, each second scan corrects the pose; where it is each one, as tick by tick, both drive the
same way to the last bit until a path ends: there the compiled loop stands for a tick more.
"""

from __future__ import annotations

import contextlib
import math

import numpy as np
import pytest
from fixtures.missions import FLOOR_TOO_LITTLE, HOME, floor_clean, in_phase, until
from fixtures.worlds import IDEAL, NOISY
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.headless import closed_loop
from roomba.headless.cleaner import CleanRecord, HeadlessMission
from roomba.headless.closed_loop import ClosedLoop
from roomba.mission.cleaning.cleaning import Cleaning
from roomba.mission.cleaning.request import CleanOutcome, CleanRequest
from roomba.mission.phases.machine import Phase
from roomba.world.engine.state.arrays import Fault

THING = (1.0, 0.75, 0.10)
"""x, y and radius of something on the floor of HOME, m."""


class TickByTick(HeadlessMission):
    """Does everything by the ordinary classes."""

    def advance(self) -> None:
        self.tick()


@pytest.fixture
def each_scan(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each scan corrects the pose, compiled or not."""
    monkeypatch.setattr(closed_loop, "EVERY", 1)


def first_path(robot: HeadlessMission) -> NDArray[np.float64]:
    """Return the poses until the first path over the floor is driven, and some more."""
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, lambda: robot.site.plans == 2 or robot.mission.state.phase is Phase.RETURNING)
    return np.concatenate(robot.rows)


@pytest.mark.parametrize(
    ("config", "burst", "thing"),
    [(IDEAL, 60, True), (NOISY, 60, False), (NOISY, 7, True)],
    ids=["ideal-thing", "noisy", "noisy-thing"],
)
def test_both_drive_the_same_way(
    each_scan: None,
    monkeypatch: pytest.MonkeyPatch,
    config: SimulatedRobotConfig,
    burst: int,
    thing: bool,
) -> None:
    # One path, around the thing and back on it: the rest planned anew would be another one.
    monkeypatch.setattr(Cleaning, "plans_anew", lambda *_: False)
    robots = (
        TickByTick(HOME, config, seed=5),
        HeadlessMission(HOME, config, seed=5, longest_burst=burst),
    )
    if thing:
        for robot in robots:
            robot.simulator.place_obstacle(*THING)
    ticked, compiled = (first_path(robot) for robot in robots)
    # The last tick of the path, and the one that plans the next.
    count = len(ticked) - 2
    assert count > 3000
    assert compiled[:count] == pytest.approx(ticked[:count], abs=1e-6)
    # And nearly all of it was compiled.
    assert len(robots[1].rows) < count / (0.6 * burst) + 1200
    swept = [robot.truth.swept_cells for robot in robots]
    assert swept[1] == pytest.approx(swept[0], rel=1e-3)
    believed = [robot.mission.cleaning.coverage.swept_cells for robot in robots]  # type: ignore[union-attr]
    assert believed[1] == pytest.approx(believed[0], rel=1e-3)
    grains = [robot.dirt.grains.sum() for robot in robots]
    assert grains[0] > 1000.0
    assert grains[1] == pytest.approx(grains[0], rel=0.02)


@pytest.mark.parametrize(
    ("config", "thing"), [(IDEAL, False), (NOISY, True)], ids=["ideal", "noisy-thing"]
)
def test_both_clean_as_well(config: SimulatedRobotConfig, thing: bool) -> None:
    robots = (TickByTick(HOME, config, seed=7), HeadlessMission(HOME, config, seed=7))
    records: list[CleanRecord] = []
    for robot in robots:
        if thing:
            robot.simulator.place_obstacle(*THING)
        records.append(robot.clean())
        assert robot.is_home
    ticked, compiled = records
    for record in records:
        assert record.result.outcome is CleanOutcome.COMPLETED
        assert record.hits == 0
        assert len(record.result.missed) == thing
    assert floor_clean(robots[1]) == pytest.approx(floor_clean(robots[0]), abs=0.002)
    assert floor_clean(robots[1]) >= (0.97 if thing else FLOOR_TOO_LITTLE)
    assert compiled.result.covered == pytest.approx(ticked.result.covered, rel=0.003)
    # One round more or less to what was missed makes some difference.
    assert compiled.distance == pytest.approx(ticked.distance, rel=0.15)


def test_what_the_compiled_loop_keeps_agrees_with_what_it_keeps_of_it() -> None:
    robot = HeadlessMission(HOME)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, lambda: robot.seen.time > 60.0)
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    for coverage in (robot.truth, cleaning.coverage):
        kept = coverage.swept_cells
        coverage.count_again()
        assert coverage.swept_cells == kept
    rows = np.concatenate(robot.rows)
    assert np.diff(rows[:, 0]) == pytest.approx(0.05)
    assert rows[-1, 0] == robot.seen.time
    assert rows[-1, 1:] == pytest.approx(
        (robot.seen.pose.x, robot.seen.pose.y, robot.seen.pose.theta)
    )


def cleaning_robot() -> tuple[HeadlessMission, ClosedLoop]:
    """A robot in the middle of a long way, and a loop that may run."""
    robot = HeadlessMission(HOME)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING))
    loop = ClosedLoop(robot, 60)
    until(robot, lambda: robot.seen.time > 30.0)
    until(robot, loop.may_run)
    return robot, loop


def ticks_of(robot: HeadlessMission, loop: ClosedLoop) -> int:
    before = robot.seen.time
    loop.run()
    return round((robot.seen.time - before) / 0.05)


def test_it_never_runs_longer_than_a_burst() -> None:
    robot, _ = cleaning_robot()
    for longest in (1, 5, 17):
        loop = ClosedLoop(robot, longest)
        until(robot, loop.may_run)
        assert 1 <= ticks_of(robot, loop) <= longest


def test_it_does_not_run_while_anything_is_the_matter() -> None:
    robot, loop = cleaning_robot()
    for fault in (Fault.BUMPER_STUCK, Fault.CLIFF_DIRTY, Fault.LIFTED):
        saved, seen = robot.simulator.save(), robot.seen
        robot.simulator.inject(fault, 1.0)
        # Something comes up in the first tick, and ends it.
        assert ticks_of(robot, loop) == 1, fault
        assert not loop.may_run(), fault
        robot.simulator.restore(saved)
        robot.seen = seen
        robot.mission.caught_up(robot.senses(), 0.0)
        assert loop.may_run()
    docked = HeadlessMission(HOME)
    docked.tick()
    assert not docked._loop.may_run()
    robot.mission.state = type(robot.mission.state)(Phase.PAUSED)
    assert not loop.may_run()


def test_it_ends_where_something_came_into_the_way() -> None:
    robot, loop = cleaning_robot()
    for _ in range(400):
        until(robot, loop.may_run)
        driver = robot.mission.driver
        assert driver is not None
        if driver.clear_to - driver.tracker.along > 1.5:
            break
        robot.tick()
    ahead = robot.simulator.pose.compose(Pose(0.5, 0.0, 0.0))
    robot.simulator.place_obstacle(ahead.x, ahead.y, 0.05)
    version = robot.mission.obstacles.version
    ticks = 0
    while loop.may_run():
        ticks += ticks_of(robot, loop)
    # Two scans or three later it is seen.
    assert ticks < 30
    assert robot.mission.obstacles.version != version
    assert not robot.seen.bumper.pressed


def test_pushed_aside_the_ordinary_classes_decide() -> None:
    robot, loop = cleaning_robot()
    pose = robot.simulator.pose
    aside = pose
    for way in (0.1, -0.1):
        with contextlib.suppress(HomeError):
            robot.simulator.put(pose.compose(Pose(0.0, way, 0.0)))
            aside = robot.simulator.pose
    assert aside != pose
    robot.localizer.told(aside, (0.01, 0.01))
    robot.tick()
    driver = robot.mission.driver
    assert driver is not None
    assert abs(driver.tracker.aside) > 0.08
    while loop.may_run() and abs(driver.tracker.aside) > 0.065:
        assert ticks_of(robot, loop) == 1
        robot.tick()
    robot.run()
    assert robot.is_home
    assert math.isclose(floor_clean(robot), 1.0, abs_tol=0.005)
