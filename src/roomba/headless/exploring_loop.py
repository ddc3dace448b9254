"""Letting undisturbed ticks of an exploration pass at once, from one keyframe to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from roomba.headless.closed_loop import (
    EVERY,
    MOST_ASIDE,
    STEP,
    STEPS_PER_TICK,
    begin_drive,
    is_untouched,
)
from roomba.headless.closed_loop_kernels import Track, World
from roomba.headless.exploring_loop_kernels import EXPLORING_LOOP, PASSED, run

if TYPE_CHECKING:
    from roomba.headless.explorer import HeadlessExplorer


class ExploringLoop:
    """Runs the robot's undisturbed ticks, all of them compiled, with the robot's own arrays."""

    def __init__(self, robot: HeadlessExplorer, longest: int) -> None:
        """Take the robot; after ``longest`` ticks at most its mission has an ordinary one."""
        self._robot, self._longest = robot, longest
        self._world = World(*robot.simulator.compiled)
        self._loop = np.zeros(1, EXPLORING_LOOP)
        self._row = row = self._loop[0]
        row["every"], row["most_aside"] = EVERY, MOST_ASIDE
        row["step"], row["steps"] = STEP, STEPS_PER_TICK
        self.left = longest
        """Ticks until the next ordinary one."""

    def may_run(self) -> bool:
        """Whether the next ticks are undisturbed, as far as can be told."""
        robot = self._robot
        seen, mission = robot.seen, robot.mission
        return (
            self.left > 0
            and mission.is_undisturbed
            and mission.cleaning is None
            and mission.driver is not None
            and abs(mission.driver.tracker.aside) <= MOST_ASIDE
            and robot.mapper.is_calm
            and is_untouched(seen)
        )

    def was_ticked(self) -> None:
        """The mission had its turn."""
        self.left = self._longest

    def run(self, until: float) -> None:
        """Let ticks pass until something comes up, or to a time, s."""
        robot, driver = self._robot, self._robot.mission.driver
        assert driver is not None
        self._begin(until)
        tracker = driver.tracker
        rows = np.empty((self.left, PASSED))
        ticks = run(
            self._loop,
            self._world,
            robot.mapper.following,
            robot.sight,
            Track(tracker.state, tracker.course),
            rows,
        )
        self.left -= ticks
        row = self._row
        robot.caught_up(rows[:ticks], int(row["points"]), float(row["way"]))

    def _begin(self, until: float) -> None:
        """Take over from the ordinary classes."""
        robot, mission, row = self._robot, self._robot.mission, self._row
        assert mission.driver is not None
        begin_drive(row, mission, mission.driver, robot.senses(), robot.sight.things)
        row["until"] = until
        row["scans"] = robot.seen.scans
        at = robot.mapper.at_scan
        row["at_scan"] = at.x, at.y, at.theta
        row["points"] = 0
