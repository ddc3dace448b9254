"""Where the robot was at each scan, then and at the end."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.homes.worlds import DT
from fixtures.robots.located import LIDAR, steps
from fixtures.robots.mapped import AROUND, CIRCLE, START, Floats, Mapped

from roomba.commands.map.drive.trajectory import Trajectory, write_trajectory


def logged(seconds: float) -> tuple[Trajectory, Mapped, Floats]:
    """Return the log of a drive, the robot, and rows of t, x, y, theta of its true poses."""
    robot, log, truth, scans = Mapped(seed=1), Trajectory(), [], 0
    for _ in steps(seconds):
        seen = robot.world.step(CIRCLE, DT)
        robot.mapper.move(seen.time, seen.odometry, seen.angular_velocity)
        if seen.scans != scans:
            scans = seen.scans
            robot.mapper.see(seen.time, robot.world.ranges, LIDAR)
            log.add(seen.time, robot.mapper)
            here = robot.world.pose
            truth.append((seen.time, here.x, here.y, here.theta))
    return log, robot, np.array(truth)


def test_both_ways_are_told_for_each_scan() -> None:
    log, robot, truth = logged(AROUND)
    robot.mapper.finish()
    for rows in (log.online, log.at_the_end(robot.mapper)):
        assert np.array_equal(rows[:, 0], truth[:, 0])
        assert np.hypot(*(rows[:, 1:3] - truth[:, 1:3]).T).max() < 0.03
        assert max(abs(math.remainder(off, math.tau)) for off in rows[:, 3] - truth[:, 3]) < 0.03


def test_before_the_first_keyframe_nothing_is_told() -> None:
    log, robot = Trajectory(), Mapped()
    log.add(0.0, robot.mapper)
    assert log.online.shape == log.at_the_end(robot.mapper).shape == (0, 4)
    with pytest.raises(ValueError, match="a keyframe or more"):
        _ = robot.mapper.newest_keyframe
    assert robot.mapper.pose == START


def test_lines_read_back_as_they_were(tmp_path: Path) -> None:
    rows = np.array([[1.5e9 + 0.25, -1.0, 2.0, 3.1], [1.5e9 + 0.5, 0.0, -2.5, -3.1]])
    write_trajectory(tmp_path / "way.txt", rows)
    assert np.loadtxt(tmp_path / "way.txt") == pytest.approx(rows, abs=1e-6)
