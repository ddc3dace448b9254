"""The compiled burst: when it runs, when it ends, and what it hands back.

Whether it does the same as the ordinary classes is tested in test/conformance.
"""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import Final

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import HOME, TWO_ROOMS, in_phase, until

from roomba.clean_request import CleanRequest
from roomba.configuration.mapping import MappingConfig
from roomba.errors import HomeError
from roomba.geometry import Pose, Twist
from roomba.headless.burst import Burst
from roomba.headless.mission import HeadlessMission
from roomba.headless.tick_rows import BELIEVED, BIAS, GYRO, ODOMETRY, PASSED, TIME, TRUE
from roomba.mission.phases.machine import Event
from roomba.perception.localization.estimate import Knowledge
from roomba.robot.readings import CliffReading
from roomba.vocabulary import Phase
from roomba.world.engine.state.arrays import Fault
from roomba.world.home.turned import turned_home

TICK: Final = NOISY.timing.tick
LONG_BACKING: Final = NOISY.body.cliff_backing_time
"""s; after so long it backs away no more."""


def burst_of(robot: HeadlessMission, longest: int = 100) -> Burst:
    return Burst(robot.body, robot.brain, robot.truth, longest)


def under_way(*, is_mapped: bool) -> HeadlessMission:
    """A robot on a long way, that nothing disturbs."""
    if is_mapped:
        robot = HeadlessMission(HOME, NOISY, seed=1)
        robot.mission.clean(CleanRequest(), robot.senses())
        until(robot, in_phase(robot, Phase.CLEANING))
        until(robot, lambda: robot.seen.time > 30.0)
    else:
        robot = HeadlessMission(TWO_ROOMS, NOISY, seed=1, known=MappingConfig())
        robot.mission.explore(robot.senses())
        until(robot, in_phase(robot, Phase.EXPLORING))
    until(robot, lambda: is_steady(robot))
    return robot


def is_steady(robot: HeadlessMission) -> bool:
    """Whether nothing is to be decided for more than a second, as far as can be told."""
    steady = robot.mission.steady(robot.senses())
    if steady is None or steady.driver is None or steady.until < robot.seen.time + 1.0:
        return False
    driver, cleaning = steady.driver, robot.mission.cleaning
    if cleaning is not None:
        watch = cleaning.dirty.watch[0]
        if watch["looked_at"] + watch["look_period"] < robot.seen.time + 1.0:
            return False
    return min(driver.left, driver.ahead.clear_to - driver.tracker.along) > 0.4


BOTH: Final = pytest.mark.parametrize("is_mapped", [True, False], ids=["known", "growing"])


@BOTH
@pytest.mark.parametrize("longest", [1, 5])
def test_it_is_never_longer_than_told(is_mapped: bool, longest: int) -> None:
    robot = under_way(is_mapped=is_mapped)
    before = robot.seen.time
    rows = burst_of(robot, longest).run()
    assert 1 <= len(rows) <= longest
    assert robot.seen.time == pytest.approx(before + len(rows) * TICK)


@BOTH
def test_of_no_length_it_does_nothing(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    before = robot.simulator.digest()
    assert len(burst_of(robot, 0).run()) == 0
    assert robot.simulator.digest() == before


@BOTH
def test_what_passed_is_told_tick_by_tick(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    rows = burst_of(robot).run()
    assert rows.shape == (len(rows), PASSED)
    assert len(rows) > 2
    assert np.diff(rows[:, TIME]) == pytest.approx(TICK)
    seen, believed = robot.seen, robot.brain.pose
    assert rows[-1, TIME] == seen.time
    for columns, pose in ((TRUE, seen.pose), (BELIEVED, believed), (ODOMETRY, seen.odometry)):
        assert rows[-1, columns].tolist() == [pose.x, pose.y, pose.theta]
    assert rows[-1, GYRO] == seen.angular_velocity
    assert rows[-1, BIAS] == robot.brain.keeper.gyro_bias


@BOTH
@pytest.mark.parametrize("fault", [Fault.BUMPER_STUCK, Fault.CLIFF_DIRTY, Fault.LIFTED])
def test_it_ends_when_anything_is_the_matter(is_mapped: bool, fault: Fault) -> None:
    robot = under_way(is_mapped=is_mapped)
    burst = burst_of(robot)
    robot.simulator.inject(fault, 1.0)
    assert len(burst.run()) == 1
    assert len(burst_of(robot).run()) == 0


@BOTH
def test_after_it_an_edge_is_backed_away_from_as_one_before_it_was(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    brain, before = robot.brain, robot.brain.readings
    edge = CliffReading(right=True)
    brain.told(replace(before, cliff=edge, time=before.time - 2.0 * LONG_BACKING))
    assert brain.steer(Twist(0.1, 0.0)).twist.linear < 0.0
    brain.told(before)
    assert len(burst_of(robot).run())
    brain.told(replace(brain.readings, cliff=edge))
    assert brain.steer(Twist(0.1, 0.0)).twist.linear < 0.0


@BOTH
def test_it_ends_when_nothing_is_seen(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    robot.simulator.inject(Fault.LIDAR_BLOCKED, 1.0)
    rows = burst_of(robot).run()
    # One scan in 0.2 s is looked at.
    assert len(rows) <= 5
    assert robot.brain.keeper.place.estimate.knowledge is Knowledge.ROUGH
    assert len(burst_of(robot).run()) == 0


@BOTH
def test_it_ends_where_something_comes_into_the_way(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    until(robot, lambda: is_steady(robot) and robot.mission.driver.left > 1.2)  # type: ignore[union-attr]
    driver = robot.mission.driver
    assert driver is not None
    course, station = driver.tracker.course, driver.tracker.along + 0.7
    x, y = (float(np.interp(station, course.stations, each)) for each in course.points.T)
    robot.simulator.place_obstacle(x, y, 0.05)
    until(robot, lambda: driver.tracker.course is not course or robot.mission.driver is not driver)
    # It left the path before it was there.
    away = robot.seen.pose.distance_to(x, y) - 0.05 - robot.robot_config.body.radius
    assert away > 0.5 * robot.config.driving.look_ahead
    assert not robot.seen.bumper.pressed


@BOTH
def test_who_is_told_to_stand_has_no_bursts(is_mapped: bool) -> None:
    robot = under_way(is_mapped=is_mapped)
    robot.mission.command(Event.PAUSE, robot.senses())
    assert len(burst_of(robot).run()) == 0
    docked = HeadlessMission(HOME)
    assert len(burst_of(docked).run()) == 0


def test_scans_that_only_confirm_where_a_mapper_is_do_not_end_it() -> None:
    robot = under_way(is_mapped=False)
    until(robot, lambda: robot.mission.state.phase is not Phase.EXPLORING)
    lengths = [len(rows) for rows in robot.rows if len(rows) > 1]
    # One scan in 0.2 s is looked at: four ticks.
    assert np.median(lengths) > 4.0


def test_a_scan_worth_keeping_ends_it_and_is_on_the_map() -> None:
    robot = under_way(is_mapped=False)
    kept = len(robot.mapper.trajectory)
    for _ in range(40):
        robot.advance()
        if len(robot.mapper.trajectory) > kept and len(robot.rows[-1]) > 1:
            break
        kept = len(robot.mapper.trajectory)
    assert len(robot.mapper.trajectory) == kept + 1
    here, pose = robot.mapper.trajectory[-1], robot.mapper.pose
    assert here == pytest.approx([pose.x, pose.y, pose.theta])


def test_after_a_look_at_the_map_that_grows_the_next_one_follows_at_once() -> None:
    robot = under_way(is_mapped=False)
    burst, followed = burst_of(robot), 0
    for _ in range(60):
        growing, kept = robot.brain.growing, len(robot.mapper.trajectory)
        assert growing is not None
        due = growing.next_look
        rows = burst.run()
        is_kept = len(robot.mapper.trajectory) > kept
        has_looked = len(rows) > 0 and growing.next_look != due
        if has_looked and not is_kept and is_steady(robot):
            assert len(burst.run())
            followed += 1
        elif not len(rows):
            robot.tick()
    assert followed > 3


def test_what_is_swept_in_it_is_counted_as_if_counted_anew() -> None:
    robot = under_way(is_mapped=True)
    until(robot, lambda: robot.seen.time > 60.0)
    assert sum(map(len, robot.rows)) > 5 * len(robot.rows)
    cleaning = robot.mission.cleaning
    assert cleaning is not None
    for coverage in (robot.truth, cleaning.ledger.coverage):
        kept = coverage.swept_cells
        coverage.count_again()
        assert coverage.swept_cells == kept


def test_pushed_aside_the_ordinary_classes_decide() -> None:
    robot = under_way(is_mapped=True)
    pose = robot.simulator.pose
    for way in (0.15, -0.15):
        with contextlib.suppress(HomeError):
            robot.simulator.put(pose.compose(Pose(0.0, way, 0.0)))
    assert robot.simulator.pose != pose
    robot.localizer.told(robot.simulator.pose, (0.01, 0.01))
    assert len(burst_of(robot).run()) == 0
    robot.tick()
    driver = robot.mission.driver
    assert driver is not None
    # One tick later it has found a way back.
    assert driver.tracker.off_path(robot.brain.pose) < robot.config.driving.off_path
    robot.run()
    assert robot.is_home


def test_truth_is_told_in_the_frame_of_a_turned_home() -> None:
    robot = HeadlessMission(turned_home(HOME, 0.4), seed=1)
    robot.mission.clean(CleanRequest(), robot.senses())
    until(robot, in_phase(robot, Phase.CLEANING))
    until(robot, lambda: robot.seen.time > 30.0 and is_steady(robot))
    rows, seen = burst_of(robot).run(), robot.seen
    assert len(rows) > 2
    assert rows[-1, TRUE] == pytest.approx([seen.pose.x, seen.pose.y, seen.pose.theta])
    assert np.hypot(*(rows[:, TRUE] - rows[:, BELIEVED])[:, :2].T).max() < 0.05
    for x, y in rows[:, TRUE][:, :2].tolist():
        assert robot.truth.swept[robot.truth.frame.cell_of(x, y)]
