"""One run: a robot without a map explores the home of a trial, and its map is compared to it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from roomba.arrays import Floats, Mask
from roomba.commands.map.blind_map import BlindMap
from roomba.commands.map.map_error import MapError, map_error
from roomba.commands.map.seen_floor import seen_floor
from roomba.commands.trials.homes import home_of
from roomba.commands.trials.runs import mission_config, robot_config_of
from roomba.commands.trials.trial import Trial
from roomba.configuration.frozen import load_config
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import CONFIGURATION
from roomba.geometry import Pose
from roomba.grid import OccupancyMap
from roomba.headless.mission import HeadlessMission
from roomba.headless.records import ExploreRecord
from roomba.headless.tick_rows import GYRO, ODOMETRY, TIME, TRUE
from roomba.world.home.home import Home


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """A map, its errors, and the errors of the pose by which it was made.

    ``largest`` and ``last`` are the error of the robot's place, m, at its largest tick, and at the
    end.
    """

    occupancy: OccupancyMap
    error: MapError
    largest: float
    last: float


@dataclass(frozen=True, slots=True, eq=False)
class MapRun:
    """The result of a run: the map that was ``made``, and the one ``by_odometry`` alone.

    ``seen`` is the floor that counts, bool over the home's grid; ``station`` is where the robot's
    own map has its station.
    """

    trial: Trial
    home: Home
    robot: SimulatedRobotConfig
    record: ExploreRecord
    made: Drawn
    by_odometry: Drawn
    seen: Mask
    station: Pose

    @property
    def is_completed(self) -> bool:
        """Whether the robot saw all that it could get to see, and docked."""
        return self.record.result.is_completed

    @property
    def times_real_time(self) -> float:
        """Robot time by time on the clock."""
        return self.record.result.duration / max(self.record.wall, 1e-9)


RunObserver = Callable[["ObservedExplorer"], None]
"""Is shown the robot whenever it looked around: every few ticks, or at each."""

_AS_OFTEN: Final = 0.9
"""Factor on the way between keyframes: by its own odometry a robot reaches each a bit sooner."""


class ObservedExplorer(HeadlessMission):
    """A robot that makes its map, and beside it another map by odometry alone."""

    observers: tuple[RunObserver, ...] = ()

    def begin_blind(self, mapping: MappingConfig) -> None:
        """Begin the map by dead reckoning; the robot stands on its station."""
        numbers = self.robot_config.localization, self.robot_config.gyro
        apart = {"keyframe_way": mapping.keyframe_way, "keyframe_turn": mapping.keyframe_turn}
        often = {name: _AS_OFTEN * value for name, value in apart.items()}
        self.blind = BlindMap(mapping.model_copy(update=often), *numbers, self.simulator.start)
        self.largest_blind = 0.0
        self._seen_scans = -1
        self._hear(self.row())

    @property
    def station(self) -> Pose:
        """Where its own map has its station."""
        return Pose(*self.mapper.trajectory[0].tolist())

    def advance(self) -> None:
        """Let time pass, and look at the result."""
        super().advance()
        self._hear(self.rows[-1])
        for observe in self.observers:
            observe(self)

    def _hear(self, rows: Floats) -> None:
        """Update the map by odometry with the ticks that passed, float64 [n, PASSED]."""
        blind = self.blind
        for row in rows.tolist():
            blind.move(row[TIME], Pose(*row[ODOMETRY]), row[GYRO])
            x, y, _ = row[TRUE]
            self.largest_blind = max(self.largest_blind, blind.pose.distance_to(x, y))
        if self.seen.scans != self._seen_scans:
            self._seen_scans = self.seen.scans
            scan = self.body.newest_scan()
            blind.see(scan.stamp, scan.ranges, scan.lidar)


class MapScene:
    """Everything that is there before a run begins; ``run()`` is the run, once."""

    def __init__(self, trial: Trial) -> None:
        """Make home and robot; raises RoombaError."""
        self.trial = trial
        self.config = robot_config_of(trial)
        self.home = home_of(trial, self.config.body)
        station = self.home.station
        self.seen = seen_floor(
            self.home.solid, self.home.frame, (station.x, station.y), self.config
        )
        mapping = load_config(MappingConfig, CONFIGURATION / "mapping.yaml")
        self.robot = ObservedExplorer(
            self.home, self.config, mission_config(self.config), known=mapping, seed=trial.seed
        )
        self.robot.begin_blind(mapping)

    def run(self, observers: Iterable[RunObserver] = ()) -> MapRun:
        """Explore; raises CommandRefusedError."""
        robot = self.robot
        robot.observers = tuple(observers)
        record = robot.explore()
        true, off = robot.seen.pose, record.believed[:, 1:3] - record.poses[:, 1:3]
        last = robot.brain.pose.distance_to(true.x, true.y)
        largest = float(np.hypot(*off.T).max())
        blind = robot.blind.occupancy()
        last_blind = robot.blind.pose.distance_to(true.x, true.y)
        return MapRun(
            self.trial,
            self.home,
            self.config,
            record,
            Drawn(record.occupancy, self.error_of(record.occupancy), largest, last),
            Drawn(blind, self.error_of(blind), robot.largest_blind, last_blind),
            self.seen,
            robot.station,
        )

    def error_of(self, occupancy: OccupancyMap) -> MapError:
        """Compare a map with the home."""
        return map_error(occupancy, self.home.frame, self.home.solid, self.seen)


def run_trial(trial: Trial) -> MapRun:
    """Make the home of a trial and map it; raises RoombaError."""
    return MapScene(trial).run()
