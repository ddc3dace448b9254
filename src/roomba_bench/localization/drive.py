"""Drives about a home for a while, and compares the ways to know the pose with the truth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.geometry import Twist, wrap_angle
from roomba.perception.localization.estimate import Knowledge
from roomba_bench.localization.robot import (
    LocalizedRobot,
    Spots,
    home_named,
    stand_things,
    with_closed_door,
)

STATES = tuple(Knowledge)
"""The states by number, for ``Drive.states``."""
THINGS = 8
"""Round things that stand about in a changed home."""
_SPEED = 0.45
_BACK = Twist(-0.15, 0.0)
_BACKING = 0.6
_TURNING = 2.0
"""m/s, s, rad/s."""
_MARGIN = 0.35
"""m from the robot's middle to a thing ahead, at which it chooses a new direction."""
_FARTHEST = 4.0
"""m; more room than this makes a direction no better."""
_NEAREST = 0.2
_DIRECTIONS = 36
_HALF_WIDTH = 12
"""Beams to each side that must be clear around a direction."""
_AIMED = 0.1
_PATIENCE = 60.0
"""s; a turn that takes longer is given up as impossible."""

Errors = NDArray[np.float32]
"""[n, 2]: m and rad, none negative."""


@dataclass(frozen=True)
class Task:
    """A drive to make: ``folder`` is of map_server maps, or "" for a shipped home.

    If ``is_changed``, things stand about and a door is shut that the map does not know. What the
    lidar saw in the first ``scan_seconds`` goes to the file ``scans``, if one is named.
    """

    home: str
    seed: int
    seconds: float
    folder: str = ""
    is_changed: bool = False
    scans: Path | None = None
    scan_seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class Drive:
    """The errors of each source at each tick, [ticks, 2].

    ``states`` are numbers into :data:`STATES`, int8 [ticks]; ``distance`` is the distance driven,
    m.
    """

    task: Task
    ours: Errors
    reckoned: Errors
    odometry: Errors
    states: NDArray[np.int8]
    distance: float


class _Mode(Enum):
    BACKING = auto()
    TURNING = auto()
    GOING = auto()


class Wander:
    """Drives at random: turn to a direction with room, go there, back off from contacts; repeat."""

    def __init__(self, random: np.random.Generator) -> None:
        """Begin by backing out of the station."""
        self._random = random
        self._mode, self._until = _Mode.BACKING, _BACKING
        self._heading = self._way = 0.0

    def tick(self, now: float, heading: float, ranges: NDArray[np.float32], touches: bool) -> Twist:
        """Return the wanted twist; ``heading`` is the wheels', rad, ``ranges`` the last scan."""
        if touches:
            self._mode, self._until = _Mode.BACKING, now + _BACKING
        elif now > self._until:
            self._choose(heading, ranges)
            self._mode, self._until = _Mode.TURNING, now + _PATIENCE
        left = wrap_angle(self._heading - heading)
        if self._mode is _Mode.TURNING and abs(left) < _AIMED:
            self._mode, self._until = _Mode.GOING, now + self._way / _SPEED
        if self._mode is _Mode.BACKING:
            return _BACK
        if self._mode is _Mode.TURNING:
            return Twist(0.0, max(-_TURNING, min(_TURNING, 4.0 * left)))
        return Twist(_SPEED, 2.0 * left)

    def _choose(self, heading: float, ranges: NDArray[np.float32]) -> None:
        """Choose a direction, more likely one with more room, and the distance to go."""
        seen = np.clip(np.where(np.isfinite(ranges), ranges, _FARTHEST), _NEAREST, _FARTHEST)
        middles = np.arange(_DIRECTIONS) * len(ranges) // _DIRECTIONS
        beams = middles[:, None] + np.arange(-_HALF_WIDTH, _HALF_WIDTH + 1)
        room = np.maximum(seen[beams % len(ranges)].min(axis=1) - _MARGIN, 0.0)
        worth = room.astype(np.float64) ** 2 + 1e-6
        chosen = int(self._random.choice(_DIRECTIONS, p=worth / worth.sum()))
        self._heading = wrap_angle(heading + chosen * 2.0 * math.pi / _DIRECTIONS)
        self._way = float(room[chosen]) * self._random.uniform(0.3, 1.0)


def drive(task: Task) -> Drive:
    """Make a drive."""
    random = np.random.default_rng(task.seed)
    home = home_named(task.home, task.folder)
    if task.is_changed:
        home = with_closed_door(home, random)
    robot = LocalizedRobot(home, task.seed)
    if task.is_changed:
        spots = Spots(home, robot.config.body.radius)
        stand_things(robot.simulator, spots, THINGS, random)
    return _Recorder(task, robot).run(Wander(random))


class _Recorder:
    """Writes down a drive, tick by tick."""

    def __init__(self, task: Task, robot: LocalizedRobot) -> None:
        self._task, self._robot = task, robot
        self._poses: list[tuple[float, ...]] = []
        self._states: list[int] = []
        self._scans: list[NDArray[np.float32]] = []
        self._scanned: list[int] = []

    def run(self, wander: Wander) -> Drive:
        robot = self._robot
        distance = robot.simulator.numbers["distance"]
        while robot.seen.time < self._task.seconds:
            seen = robot.seen
            robot.tick(wander.tick(seen.time, seen.odometry.theta, robot.ranges, robot.touches))
            self._note()
        rows = np.array(self._poses)
        if self._task.scans is not None:
            self._save(self._task.scans, rows)
        true = rows[:, 1:4]
        return Drive(
            self._task,
            errors(true, rows[:, 4:7]),
            errors(true, rows[:, 7:10]),
            errors(true, rows[:, 10:13]),
            np.array(self._states, np.int8),
            robot.simulator.numbers["distance"] - distance,
        )

    def _note(self) -> None:
        robot, seen = self._robot, self._robot.seen
        estimate = robot.localizer.estimate
        start = robot.home.station
        poses = (
            seen.pose,
            estimate.pose,
            start.compose(robot.localizer.reckoned),
            start.compose(seen.odometry),
        )
        row = (number for pose in poses for number in (pose.x, pose.y, pose.theta))
        if robot.has_scanned and seen.time <= self._task.scan_seconds:
            self._scanned.append(len(self._poses))
            self._scans.append(robot.ranges)
        self._poses.append((seen.time, *row))
        self._states.append(STATES.index(estimate.knowledge))

    def _save(self, path: Path, rows: Floats) -> None:
        """Write what was there at each scan: float32 [scans, beams], and float64 [scans, ...]."""
        at = rows[self._scanned]
        np.savez(
            path,
            ranges=np.array(self._scans),
            stamps=at[:, 0],
            truth=at[:, 1:4],
            believed=at[:, 4:7],
            reckoned=at[:, 7:10],
            odometry=at[:, 10:13],
        )


def errors(true: Floats, poses: Floats) -> Errors:
    """Return how far poses (x, y, theta) are off true ones, [n, 2]: m and rad, none negative."""
    off = poses - true
    turn = (off[:, 2] + math.pi) % (2.0 * math.pi) - math.pi
    return np.column_stack([np.hypot(off[:, 0], off[:, 1]), np.abs(turn)]).astype(np.float32)
