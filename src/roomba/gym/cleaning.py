"""Cleaning as episodes: many robots at once, each in its own world of one fleet.

The environments of one robot and of many are thin adapters of this module, so a robot's episode is
the same, bit for bit, in either.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.angles import wrap_angles
from roomba.arrays import Floats
from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.gym.floor import Coverage, FloorDistances
from roomba.gym.observation import Observer
from roomba.gym.task import Task
from roomba.world.fleet import Fleet
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM

Flags = NDArray[np.bool_]
Beginning = tuple[int, Pose]
"""The seed of a robot's world, and where the robot stands at first, in the home's own axes."""

CLEAN: Final = 0.99
"""0..1; with this share of the reachable dirt in the bin the task is done."""
_TRIES: Final = 1000
"""Places that are tried for a start; things that move may stand there."""
_COUNTED: Final = {
    "dirt_removed": ("in_bin", 1.0 / MICROGRAMS_PER_GRAM),
    "energy": ("used", 1.0),
    "distance": ("distance", 1.0),
    "collisions": ("hits", 1.0),
}
"""By name: a field of a robot's row and its unit; ``info`` tells its growth in the episode."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """The result of one action of each robot; each array has a row per robot."""

    observations: NDArray[np.float32]
    rewards: Floats
    terminated: Flags
    truncated: Flags
    truths: dict[str, Floats]
    """By name: pose [robots, 3] (x, y, m, theta, rad, map frame), covered (0..1 of the reachable
    floor), dirt_removed (g), energy (Wh), distance (m), collisions, time (s)."""


class CleaningTask:
    """Robots that clean, each in a world of its own, and their rewards."""

    def __init__(self, task: Task, robots: int, threads: int | None = None) -> None:
        """Make the worlds; :meth:`begin` every robot's episode before the first action."""
        self.task = task
        self.home = home = task.loaded_home()
        # No time passes in this world. All worlds begin like it: it shows where a robot fits.
        self._fresh = Fleet([home], task.robot)
        self.fleet = Fleet([home] * robots, task.robot, max_speed=task.max_speed, threads=threads)
        self.senses = Observer(self.fleet, task.max_speed)
        self.floor = FloorDistances.of(home, self.fleet.config)
        dirt = int(self.fleet.dirt(0).micrograms[self.floor.reachable].sum(dtype=np.int64))
        capacity = self.fleet.config.brush.bin_capacity * MICROGRAMS_PER_GRAM
        if dirt == 0:
            raise HomeError(
                f"home {home.name}: expected dirt that can be reached, found none; give it sources"
            )
        self.enough = min(CLEAN * dirt, math.floor(capacity))
        self._coverage = Coverage(self.floor, robots)
        self._full = np.array([task.max_speed, self.fleet.config.body.max_angular_speed])
        self._actions = np.zeros(robots, np.int64)
        self._at_start = {name: np.zeros(robots) for name in _COUNTED}
        self._paid = np.zeros(robots)

    def start_of(self, options: Mapping[str, Any] | None) -> Pose | None:
        """Return where robots are to start, in the home's own axes; None: anywhere.

        ``options`` may say ``start``, (x, y, theta), map frame, or ``at_station``, True. Raises
        ValueError for others, HomeError for a start where the robot does not fit.
        """
        start, at_station = _checked(options or {})
        body = self.fleet.config.body
        if at_station:
            return body.docked_at(self.home.exact.station)
        if start is None:
            return None
        own = self.home.own(start)
        try:
            self._fresh.put(0, own)
        except HomeError:
            raise HomeError(
                f"start: the robot does not fit at ({start.x:.2f}, {start.y:.2f}); expected free "
                f"floor for a body of {body.diameter} m"
            ) from None
        return own

    def beginning_of(self, random: np.random.Generator, start: Pose | None) -> Beginning:
        """Return how an episode begins: at ``start``, or at a free place found by ``random``.

        Raises HomeError if no place is free.
        """
        seed = int(random.integers(2**31))
        return seed, start or self._free_place(random)

    def begin(self, robot: int, beginning: Beginning) -> None:
        """Reset a robot's world and put the robot where :meth:`beginning_of` says.

        The next call of :meth:`act` must mark this robot as ``beginning``.
        """
        seed, start = beginning
        self.fleet.reset_world(robot, seed)
        # The fresh world showed that the robot fits; another check takes longer than the reset.
        self.fleet.poses[robot] = start.as_array()
        self._coverage.forget(robot)

    def act(self, actions: NDArray[np.floating[Any]], beginning: Flags) -> Outcome:
        """Let the time of one action pass; ``actions`` is [robots, 2], each -1..1.

        Robots that are ``beginning`` stand for that time, in which their lidar scans for the first
        time, and their episodes start at its end. Their actions are not used. Raises
        ValueError for actions of another shape, or for used ones that are not finite.
        """
        if np.shape(actions) != (expected := (len(beginning), 2)):
            raise ValueError(f"expected actions of shape {expected}, got {np.shape(actions)}")
        wrong = ~np.isfinite(actions).all(axis=1) & ~beginning
        if wrong.any():
            robot = int(np.argmax(wrong))
            raise ValueError(
                f"expected actions of finite numbers, got {actions[robot].tolist()} for robot "
                f"{robot}"
            )
        twists = np.clip(actions, -1.0, 1.0) * self._full
        twists[beginning] = 0.0
        self.fleet.step(twists, self.task.dt, self.task.steps_per_action)
        self._actions += 1
        self._actions[beginning] = 0
        self._coverage.add(self.fleet.poses)
        truths = self._truths(beginning)
        pay = (
            truths["dirt_removed"]
            - self.task.energy_weight * truths["energy"]
            - self.task.time_weight * truths["time"]
        )
        rewards = pay - self._paid
        rewards[beginning] = 0.0
        self._paid = pay
        robots = self.fleet.robots
        is_done = (robots["in_bin"] >= self.enough) | (robots["charge"] <= 0.0)
        return Outcome(
            observations=self.senses.read(),
            rewards=rewards,
            terminated=is_done & ~beginning,
            truncated=self._actions >= self.task.most_actions,
            truths=truths,
        )

    def _truths(self, beginning: Flags) -> dict[str, Floats]:
        robots = self.fleet.robots
        truths = {"pose": self._told(self.fleet.poses), "covered": self._coverage.shares}
        for name, (field, unit) in _COUNTED.items():
            total = robots[field] * unit
            at_start = self._at_start[name]
            at_start[beginning] = total[beginning]
            truths[name] = total - at_start
        truths["time"] = self._actions * self.task.action_time
        return truths

    def _told(self, poses: Floats) -> Floats:
        """Return poses of the home's own axes in the map frame."""
        axes = self.home.axes
        told = axes.transform(poses)
        told[:, 2] = wrap_angles(told[:, 2] + axes.theta)
        return told

    def _free_place(self, random: np.random.Generator) -> Pose:
        for _ in range(_TRIES):
            x, y = self.floor.places[int(random.integers(len(self.floor.places)))].tolist()
            place = Pose(x, y, float(random.uniform(-math.pi, math.pi)))
            try:
                self._fresh.put(0, place)
            except HomeError:
                continue
            return place
        raise HomeError(
            f"home {self.home.name}: expected a free place to start, found none in "
            f"{_TRIES} tries; give the option start or at_station"
        )


def _checked(options: Mapping[str, Any]) -> tuple[Pose | None, bool]:
    unknown = set(options) - {"start", "at_station"}
    if unknown:
        raise ValueError(
            f"expected the options start or at_station, got {sorted(unknown, key=str)}"
        )
    start, at_station = options.get("start"), options.get("at_station", False)
    if not isinstance(at_station, bool | np.bool_):
        raise ValueError(f"at_station: expected True or False, got {at_station!r}")
    if start is None:
        return None, bool(at_station)
    if at_station:
        raise ValueError(f"expected start or at_station, got both; start is {start}")
    return _pose_of(start), False


def _pose_of(start: Any) -> Pose:
    try:
        x, y, theta = map(float, start)
    except (TypeError, ValueError, OverflowError):
        x = y = theta = math.nan
    pose = Pose(x, y, theta)
    if not pose.is_finite:
        raise ValueError(f"start: expected finite (x, y, theta), m and rad, got {start!r}")
    return pose
