"""One run: a robot is put into a trial's home and cleans it, and the result is counted."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.commands.trials.figures import Figures, MissedShare
from roomba.commands.trials.homes import home_of, rooms_of
from roomba.commands.trials.numbers import DOCKING, MISSION, ROBOT, with_numbers
from roomba.commands.trials.stages import stages_of
from roomba.commands.trials.things import seeded_things
from roomba.commands.trials.trial import Setting, Trial
from roomba.commands.trials.truth import coverable_floor, true_map
from roomba.commands.trials.zones import zones_of
from roomba.configuration.body import BrushConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import load_config, validated
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.sensors import SIMULATION
from roomba.configuration.simulation import (
    SimulatedRobotConfig,
    SimulationConfig,
    load_simulated_config,
)
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose, RoundObstacle
from roomba.grid import FREE
from roomba.headless.burst import LONGEST_BURST
from roomba.headless.mission import HeadlessMission
from roomba.headless.odometry import odometry_error
from roomba.headless.records import CleanRecord
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.swept.coverage_map import CoverageMap
from roomba.vocabulary import word_of
from roomba.world.home.home import Home
from roomba.world.home.raster import largest_component, where_body_fits

RunObserver = Callable[[HeadlessMission], None]
"""Called with the robot whenever some of its time has passed."""

TRAJECTORY_STEP: Final = 0.1
"""s between two poses of the trajectory."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """The result of a run: ``trajectory`` has rows t (s), x, y (m), theta (rad), true poses.

    ``coverable`` is bool over ``truth.frame``: the floor that could be cleaned.
    """

    trial: Trial
    figures: Figures
    trajectory: Floats
    home: Home
    robot: SimulatedRobotConfig
    reach: float
    things: tuple[RoundObstacle, ...]
    coverable: Mask
    truth: CoverageMap


class ObservedMission(HeadlessMission):
    """A robot that observers look at while it cleans."""

    observers: tuple[RunObserver, ...] = ()

    def advance(self) -> None:
        """Let some ticks pass, and look."""
        super().advance()
        for observe in self.observers:
            observe(self)


class TrialSetup:
    """Everything that is there before a run begins; ``run()`` is the run, once."""

    def __init__(self, trial: Trial, longest_burst: int = LONGEST_BURST) -> None:
        """Make home and robot, watched after ``longest_burst`` ticks; raises RoombaError."""
        self.trial = trial
        self.config = robot_config_of(trial)
        self.home = home_of(trial, self.config.body)
        mission = mission_config(self.config, trial.numbers)
        docking = docking_config(trial.numbers)
        self.robot = ObservedMission(
            self.home,
            self.config,
            mission,
            docking,
            seed=trial.seed,
            rooms=rooms_of(self.home),
            zones=zones_of(trial),
            longest_burst=longest_burst,
            empties_bin_after=trial.empties_bin_after,
            stages=stages_of(trial.stages, trial.code),
        )
        self.things = _things_of(trial, self.home, self.config, self.robot.context.staging)
        for x, y, radius in self.things:
            self.robot.simulator.place_obstacle(x, y, radius)
        if trial.battery < 1.0:
            self.robot.simulator.set_charge(trial.battery)
            self.robot.look()
        self._coverable = partial(
            coverable_floor,
            self.home,
            self.robot.context,
            trial.request,
            self.things,
            self.config,
            mission,
            docking,
        )
        self.coverable = self._coverable()

    def run(self, observers: Iterable[RunObserver] = ()) -> Run:
        """Clean; raises CleanRefusedError and CommandRefusedError."""
        robot = self.robot
        robot.observers = tuple(observers)
        seen = robot.seen
        first = np.array([[seen.time, seen.pose.x, seen.pose.y, seen.pose.theta]])
        began = time.perf_counter()
        record = robot.clean(self.trial.request)
        wall = time.perf_counter() - began
        if self.home.moving:
            self.coverable = self._coverable(ended=robot.seen.time)
        covered = record.truth.swept & self.coverable
        cell = record.truth.cell_area
        result, rows = record.result, robot.passed
        measured = Calibration.of(robot.brain.keeper.place.belief)
        figures = Figures(
            outcome=result.outcome.name,
            message=result.message,
            docked=robot.seen.battery.is_docked,
            duration_s=result.duration,
            wall_s=wall,
            planning_s=record.planning,
            plans=record.plans,
            distance_m=record.distance,
            turning_rad=record.turning,
            energy_wh=result.energy,
            dirt_g=result.dirt,
            times=result.times,
            bins_emptied=len(robot.emptied),
            coverable_m2=float(np.count_nonzero(self.coverable)) * cell,
            covered_m2=float(np.count_nonzero(covered)) * cell,
            tool_width_m=robot.context.tool_width,
            hits=record.hits,
            missed=tuple(
                MissedShare(
                    each.area, each.x, each.y, each.room, each.reason.value, word_of(each.reason)
                )
                for each in result.missed
            ),
            calibration=str(measured),
            wheels_error=odometry_error(rows, self.config, None, has_gyro=False),
            calibrated_wheels_error=odometry_error(rows, self.config, measured, has_gyro=False),
            odometry_error=odometry_error(rows, self.config, None),
            calibrated_error=odometry_error(rows, self.config, measured, knows_bias=True),
        )
        return Run(
            self.trial,
            figures,
            trajectory_of(record, first),
            self.home,
            self.config,
            robot.context.reach,
            tuple(self.things),
            self.coverable,
            record.truth,
        )


def run_trial(trial: Trial, observers: Iterable[RunObserver] = ()) -> Run:
    """Return the run of a trial; raises RoombaError for what cannot be."""
    return TrialSetup(trial).run(observers)


def trajectory_of(record: CleanRecord, first: Floats) -> Floats:
    """Return true poses ten times a second, from the ``first``, float64 [1, 4], to the last."""
    poses = np.concatenate([first, record.poses])
    since = poses[:, 0] - poses[0, 0]
    step = np.floor(since / TRAJECTORY_STEP + 1e-6)
    kept = np.diff(step, prepend=-1.0) > 0.0
    kept[-1] = True
    trajectory: Floats = poses[kept]
    return trajectory


def robot_config_of(trial: Trial) -> SimulatedRobotConfig:
    """Return the robot of a trial; raises ConfigError."""
    config = load_simulated_config(
        trial.config or CONFIGURATION / "robot.yaml", CONFIGURATION / "simulation.yaml"
    )
    config = with_numbers(config, ROBOT, trial.numbers)
    true = with_numbers(config.simulation, SIMULATION, trial.numbers)
    if true is not config.simulation:
        config = with_simulation(config, true)
    if trial.bin is not None:
        values = config.brush.model_dump() | {"bin_capacity": trial.bin}
        brush = validated(BrushConfig, values, "bin: ")
        config = config.model_copy(update={"brush": brush})
    if trial.lidar is not None:
        config = config.with_lidar(trial.lidar)
    if trial.wheels is not None:
        config = config.with_wheels(trial.wheels)
    if trial.sensors is None:
        return config
    return config.with_sensors(trial.sensors)


def with_simulation(config: SimulatedRobotConfig, true: SimulationConfig) -> SimulatedRobotConfig:
    """Return a robot with another simulated truth; raises ConfigError."""
    values = config.model_dump() | {SIMULATION: true.model_dump()}
    return validated(SimulatedRobotConfig, values, "numbers: ")


def mission_config(robot: RobotConfig, numbers: Iterable[Setting] = ()) -> MissionConfig:
    """Return the shipped configuration of the mission, slowed for a robot that is slower.

    ``numbers`` change it first; raises ConfigError.
    """
    shipped = load_config(MissionConfig, CONFIGURATION / "mission.yaml")
    return with_numbers(shipped, MISSION, numbers).slowed_for(robot.body)


def docking_config(numbers: Iterable[Setting] = ()) -> DockingConfig:
    """Return the shipped configuration of docking, with some numbers changed."""
    shipped = load_config(DockingConfig, CONFIGURATION / "docking.yaml")
    return with_numbers(shipped, DOCKING, numbers)


def _things_of(trial: Trial, home: Home, config: RobotConfig, staging: Pose) -> list[RoundObstacle]:
    """Return things on floor where the body fits and that the robot's map shows as free."""
    if not trial.things:
        return []
    free = (true_map(home).values == FREE) & (home.map.values == FREE)
    floor = largest_component(where_body_fits(home.frame, ~free, config.body.radius))
    return seeded_things(home, staging, floor, trial.things, trial.seed)
