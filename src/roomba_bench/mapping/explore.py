"""A robot without a map explores a home; then it cleans that home by the map that it made."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from roomba.commands.map.runs import Drawn, run_trial
from roomba.commands.trials.trial import Trial
from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.sensors import EXACT_LIDAR
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.mission.cleaning.result import CleanOutcome, CleanResult
from roomba.mission.docking.docking import staging_pose
from roomba.world.home.home import Home
from roomba_bench.coverage.clean import home_named, true_floor
from roomba_bench.coverage.floor import drawn
from roomba_bench.ours_sim import ROBOT


@dataclass(frozen=True)
class Task:
    """An exploration: ``folder`` is of map_server maps, or "" for a shipped home."""

    home: str
    seed: int = 0
    folder: str = ""


@dataclass(frozen=True, eq=False)
class Explored:
    """What came of it: the robot's map, and the one that dead reckoning makes of its scans.

    ``seconds`` are robot time, ``way`` m; ``is_done`` says that it docked and
    takes itself to have seen all.
    """

    task: Task
    made: Drawn
    blind: Drawn
    seconds: float
    way: float
    hits: int
    is_done: bool


@dataclass(frozen=True)
class Cleaned:
    """What came of a clean: the share of the true floor, 0..1, s of robot time, and whether it came
    home.
    """

    share: float
    seconds: float
    is_home_and_done: bool


def explore(task: Task) -> Explored:
    """Make an exploration with the shipped noise."""
    path = str(Path(task.folder) / f"{task.home}.yaml") if task.folder else task.home
    run = run_trial(Trial(home=path, seed=task.seed, sensors="noisy", lidar=EXACT_LIDAR))
    record = run.record
    return Explored(
        task,
        run.made,
        run.by_odometry,
        record.result.duration,
        record.result.distance,
        record.hits,
        run.is_completed,
    )


def clean(task: Task, known: OccupancyMap | None) -> Cleaned:
    """Clean a home by a map of it, by default its true one; true poses are counted."""
    home = home_named(task.home, task.folder)
    robot = HeadlessMission(home, ROBOT, seed=task.seed, known=known)
    staging = robot.context.staging
    record = robot.clean()
    is_home = robot.seen.battery.is_docked
    return _cleaned(home, staging, record.poses, record.result, is_home=is_home)


def clean_unknown(task: Task) -> Cleaned:
    """Clean a home that the robot has never seen; true poses are counted."""
    home = home_named(task.home, task.folder)
    robot = HeadlessMission(home, ROBOT, seed=task.seed, known=MappingConfig())
    staging = staging_pose(home.station, DockingConfig().staging_distance)
    record = robot.clean()
    is_home = robot.seen.battery.is_docked
    return _cleaned(home, staging, record.poses, record.result, is_home=is_home)


def _cleaned(
    home: Home, staging: Pose, poses: NDArray[np.float64], result: CleanResult, *, is_home: bool
) -> Cleaned:
    points = np.concatenate([[[home.station.x, home.station.y]], poses[:, 1:3]])
    floor = true_floor(home, (staging.x, staging.y))
    left = floor.floor & ~drawn(floor.frame, points)
    share = 1.0 - float(np.count_nonzero(left)) / np.count_nonzero(floor.floor)
    is_done = result.outcome is CleanOutcome.COMPLETED
    return Cleaned(share, result.duration, is_done and is_home)
