"""Cleaning as episodes: many robots at once, each in its own world of one fleet.

Both environments are thin adapters of this, so a robot's episode is the same, bit for bit, in
either.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.gym.floor import Coverage, FloorDistances
from roomba.gym.observation import Observer
from roomba.gym.task import Task
from roomba.world.fleet import Fleet
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM

Flags = NDArray[np.bool_]

CLEAN: Final = 0.99
"""0..1; with this share of the reachable dirt in the bin the task is done."""
_TRIES: Final = 1000
"""Places that are tried for a start; some are taken by things that move."""
_COUNTED: Final = {
    "dirt_removed": ("in_bin", 1.0 / MICROGRAMS_PER_GRAM),
    "energy": ("used", 1.0),
    "distance": ("distance", 1.0),
    "collisions": ("hits", 1.0),
}
"""Numbers of a robot's row that are told as counted since the episode's start, and their unit."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What came of one action of each robot; arrays with a row for each."""

    observations: NDArray[np.float32]
    rewards: Floats
    terminated: Flags
    truncated: Flags
    truths: dict[str, Floats]
    """By name: pose [robots, 3] (x, y, m, theta, rad, map frame), covered (0..1 of the reachable
    floor), dirt_removed (g), energy (Wh), distance (m), collisions, time (s)."""


class CleaningTask:
    """Robots that clean, each in a world of its own, and what they get for it."""

    def __init__(self, task: Task, robots: int, threads: int | None = None) -> None:
        """Make the worlds; :meth:`begin` every robot's episode before the first action."""
        self.task = task
        home = task.loaded_home()
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

    def begin(
        self, robot: int, random: np.random.Generator, options: Mapping[str, Any] | None = None
    ) -> None:
        """Put a robot into its world as it is at first, at a place found by ``random``.

        ``options`` may say ``start``, (x, y, theta), or ``at_station``, True. Raises ValueError for
        other options, HomeError for a start where the robot does not fit. The next action of this
        robot must be one of ``beginning``.
        """
        start, at_station = _start_of(options or {})
        self.fleet.reset_world(robot, int(random.integers(2**31)))
        if start is not None:
            self.fleet.put(robot, start)
        elif not at_station:
            self._put_anywhere(robot, random)
        self._coverage.forget(robot)

    def act(self, actions: NDArray[np.floating[Any]], beginning: Flags) -> Outcome:
        """Let the time of one action pass; ``actions`` is [robots, 2], each -1..1.

        Robots that are ``beginning`` stand for that time, in which their lidar scans for the first
        time, and their episodes start at its end. Raises ValueError for actions of another shape,
        or that are not finite; of robots that are beginning they are not used.
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
        truths = {"pose": self.fleet.poses.copy(), "covered": self._coverage.shares}
        for name, (field, unit) in _COUNTED.items():
            total = robots[field] * unit
            at_start = self._at_start[name]
            at_start[beginning] = total[beginning]
            truths[name] = total - at_start
        truths["time"] = self._actions * self.task.action_time
        return truths

    def _put_anywhere(self, robot: int, random: np.random.Generator) -> None:
        for _ in range(_TRIES):
            x, y = self.floor.places[int(random.integers(len(self.floor.places)))].tolist()
            try:
                self.fleet.put(robot, Pose(x, y, float(random.uniform(-math.pi, math.pi))))
            except HomeError:
                continue
            return
        raise HomeError(
            f"home {self.fleet.homes[robot].name}: expected a free place to start, found none in "
            f"{_TRIES} tries; give the option start or at_station"
        )


def _start_of(options: Mapping[str, Any]) -> tuple[Pose | None, bool]:
    unknown = set(options) - {"start", "at_station"}
    if unknown:
        raise ValueError(f"expected the options start or at_station, got {sorted(unknown)}")
    start = options.get("start")
    if start is None:
        return None, bool(options.get("at_station", False))
    numbers = [float(number) for number in start]
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise ValueError(f"start: expected finite (x, y, theta), m and rad, got {start}")
    return Pose(*numbers), False
