"""Letting undisturbed ticks pass at once: the compiled loop around a headless mission."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from roomba.configuration.robot import TimingConfig
from roomba.headless.closed_loop_kernels import LOOP, Belief, Floor, Track, World, run
from roomba.mission.driving.path_driver import PathDriver
from roomba.perception.localization.belief import numbers_of

if TYPE_CHECKING:
    from roomba.headless.cleaner import HeadlessMission
    from roomba.mission.inputs.senses import Senses
    from roomba.mission.mission import Mission
    from roomba.perception.things.kernels import Things
    from roomba.world.simulator import Observation

_TIMING: Final = TimingConfig()
STEPS_PER_TICK: Final = _TIMING.steps_per_tick
STEP: Final = _TIMING.world_step
"""s; the world's steps between two ticks of the robot."""
EVERY: Final = 2
"""Each such scan corrects the pose and is looked through for things: each 0.2 s."""
LONGEST_BURST: Final = 60
"""Ticks: three seconds, then the mission looks at its battery and its progress."""
MOST_ASIDE: Final = 0.06
"""m; farther from its path than this the ordinary classes decide."""


def is_untouched(seen: Observation) -> bool:
    """Whether nothing touches the robot, or is missing below it, and it stands on no station."""
    hazards = seen.bumper.pressed or seen.cliff.any or seen.wheels.dropped
    return not (hazards or seen.battery.is_docked)


def begin_drive(
    row: Any, mission: Mission, driver: PathDriver, senses: Senses, things: Things
) -> None:
    """Let a row of :data:`DRIVE` be what the drive is at now."""
    row["limit"] = mission.speed_limit(senses)
    row["clear_to"] = driver.clear_to
    row["last_x"], row["last_y"] = mission.last_place
    row["way"] = 0.0
    row["things_version"] = things.layer["version"][0]


class ClosedLoop:
    """Runs the robot's undisturbed ticks, all of them compiled, with the robot's own arrays."""

    def __init__(self, robot: HeadlessMission, longest_burst: int) -> None:
        """Take the robot, and the arrays of it that never change place."""
        self._robot = robot
        simulator, localizer = robot.simulator, robot.localizer
        self._world = World(*simulator.compiled)
        self._belief = Belief(
            localizer.belief,
            numbers_of(robot.robot.localization, robot.robot.gyro, EVERY),
            localizer.field.values,
            localizer.field.place,
            robot.lidar.arrays(),
            robot.things.arrays,
        )
        self._loop = np.zeros(1, LOOP).view(np.recarray)
        row = self._loop[0]
        row.every, row.most_aside = EVERY, MOST_ASIDE
        row.step, row.steps = STEP, STEPS_PER_TICK
        self._rows = np.empty((longest_burst, 4))

    def may_run(self) -> bool:
        """Whether the next ticks are undisturbed, as far as can be told."""
        robot = self._robot
        seen = robot.seen
        return robot.mission.is_undisturbed and robot.localizer.is_calm and is_untouched(seen)

    def run(self) -> None:
        """Let ticks pass until something comes up, at most a burst of them."""
        robot, mission = self._robot, self._robot.mission
        driver = mission.driver
        assert driver is not None
        self._begin(driver)
        tracker = driver.tracker
        tracks = Track(tracker.state, tracker.course)
        ticks = run(self._loop, self._world, self._belief, tracks, self._floor(), self._rows)
        robot.rows.append(self._rows[:ticks].copy())
        row = self._loop[0]
        if mission.sweeps and mission.cleaning is not None:
            coverage = mission.cleaning.coverage
            coverage.swept_cells += int(row.swept)
            coverage.at = (float(row.last_x), float(row.last_y))
        robot.truth.swept_cells += int(row.truth_swept)
        robot.truth.at = (float(row.true_x), float(row.true_y))
        robot.caught_up(float(row.seen), float(row.way))

    def _begin(self, driver: PathDriver) -> None:
        """Take over from the ordinary classes."""
        robot = self._robot
        row = self._loop[0]
        begin_drive(row, robot.mission, driver, robot.senses(), self._belief.things)
        row.scans = robot.seen.scans
        row.sweeps = 1.0 if robot.mission.sweeps else 0.0
        row.true_x, row.true_y = robot.truth.at or (robot.seen.pose.x, robot.seen.pose.y)
        row.swept = row.truth_swept = 0
        row.seen = -1.0

    def _floor(self) -> Floor:
        """Return what is cleaned now; without a clean what is driven over does not count."""
        robot = self._robot
        cleaning, dirt, truth = robot.mission.cleaning, robot.dirt, robot.truth
        cells = truth.cells if cleaning is None else cleaning.coverage.cells
        return Floor(
            cells, truth.cells, truth.place, truth.radius, dirt.grains, dirt.way, dirt.place
        )
