"""The simulator as used by the benchmarks: the one place to adapt to changes of its interface."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.geometry import Pose
from roomba.grid import FREE, OCCUPIED, OccupancyMap
from roomba.world.fleet import Fleet
from roomba.world.home.home import Home
from roomba.world.lidar import Lidar
from roomba_bench.floors import Floor, free_poses
from roomba_bench.peers.protocol import CHECKED_POSES, Work
from roomba_bench.peers.simulators.arena import SPEED, TURNING_SPEED

ROBOT: Final = SimulatedRobotConfig().with_lidar(EXACT_LIDAR)
"""The shipped robot with an exact lidar, for every table that names no other. Peers have no lidar
that turns while it measures and misses dark things; and figures stay comparable when the default
changes."""
DT = 0.05
"""s; the steps of all simulators here."""
_STEPS = 20
"""Steps in one call: the robots get a new command every second."""
_TWISTS = 61
"""Different commands that a robot gets, again and again."""
_TURN_SHARE = 0.35
_CALLS_PER_CHARGE = 1000
"""Calls until all is reset, battery and dirt too: a robot without charge stands, and costs
little."""
_CHECKED_CALLS = 40
_LEAST_WAY = 0.05
"""m of each checked call; robots that move less do not drive about."""


@dataclass(frozen=True)
class Drive:
    """A fleet at work: ``robots`` in homes, with a lidar of ``scan_rate`` Hz or model ``lidar``.

    They drive straight on for a call, or turn on the spot for one, at random; so they bump. Their
    sensors are ideal, as those of all peers are, if not told otherwise.
    """

    robots: int = 1
    scan_rate: float = 10.0
    threads: int = 1
    sensors: Literal["ideal", "noisy"] = "ideal"
    lidar: str | None = None

    @property
    def config(self) -> SimulatedRobotConfig:
        """The robots as they are simulated."""
        if self.lidar is not None:
            return ROBOT.with_lidar(self.lidar).with_sensors(self.sensors)
        return config_of(self.scan_rate, self.sensors)

    def work(self, home: Home) -> Work:
        """Return the work; units are steps of one robot."""
        floor = Floor(home.name, home.solid, home.frame)
        fleet = Fleet(
            [home] * self.robots,
            self.config,
            starts=free_poses(floor, self.robots, room=0.3),
            threads=self.threads,
        )
        orders = itertools.cycle(_orders(self.robots))
        done = float(self.robots * _STEPS)
        calls = itertools.count()
        fresh = fleet.save()

        def work() -> float:
            if next(calls) % _CALLS_PER_CHARGE == 0:
                fleet.restore(fresh)
            fleet.step(next(orders), DT, steps=_STEPS)
            return done

        return Work(work, {"way": _way(fleet, work)})


def config_of(scan_rate: float, sensors: Literal["ideal", "noisy"]) -> SimulatedRobotConfig:
    """Return the robot of the benchmarks with its lidar at another rate, Hz, and such sensors."""
    lidar = ROBOT.lidar.model_copy(update={"rate": scan_rate})
    return ROBOT.model_copy(update={"lidar": lidar}).with_sensors(sensors)


def scanning(floor: Floor, poses: NDArray[np.float64]) -> Work:
    """Return the work of scanning a floor from all poses; units are scans."""
    lidar = Lidar.on_grid(floor.solid, floor.frame, ROBOT.lidar)
    out = np.empty((len(poses), lidar.config.beams), np.float32)

    def work() -> float:
        lidar.scan(poses, out)
        return float(len(poses))

    work()
    reach = np.float32(lidar.config.max_range)
    first = out[:CHECKED_POSES]
    checked = np.where(np.isposinf(first), reach, first)
    return Work(work, {"mean range": float(np.mean(checked)), "edges": float(lidar.edges.count)})


def scans(floor: Floor, poses: NDArray[np.float64]) -> NDArray[np.float32]:
    """Return ranges, m, float32 [poses, beams]; infinite where there is nothing within reach."""
    return Lidar.on_grid(floor.solid, floor.frame, ROBOT.lidar).scan(poses)


def home_of(floor: Floor) -> Home:
    """Return a home that is nothing but a floor."""
    values = np.where(floor.solid, OCCUPIED, FREE).astype(np.int8)
    x, y, theta = free_poses(floor, 1)[0].tolist()
    return Home(
        name=floor.name,
        map=OccupancyMap(floor.frame, values),
        solid=floor.solid,
        walls=floor.solid,
        station=Pose(x, y, theta),
    )


def bytes_per_robot(home: Home) -> float:
    """Return the memory of one more robot with its own dirt, bytes."""
    return Fleet([home] * 2, ROBOT).bytes_per_robot


def _way(fleet: Fleet, work: Callable[[], float]) -> float:
    """Return the mean distance of a call, m; raises ValueError if robots hardly move."""
    way = 0.0
    for _ in range(_CHECKED_CALLS):
        before = fleet.poses[:, :2].copy()
        work()
        way += float(np.mean(np.hypot(*(fleet.poses[:, :2] - before).T))) / _CHECKED_CALLS
    if way < _LEAST_WAY:
        raise ValueError(f"expected robots that drive about, they come {way:.3f} m in a call")
    return way


def _orders(robots: int) -> list[NDArray[np.float64]]:
    """Return the robots' commands, one array [robots, 2] (m/s, rad/s) per call."""
    random = np.random.default_rng(0)
    turns = random.random((_TWISTS, robots)) < _TURN_SHARE
    ways = random.choice([-1.0, 1.0], (_TWISTS, robots))
    linear, angular = np.where(turns, 0.0, SPEED), np.where(turns, ways * TURNING_SPEED, 0.0)
    return list(np.ascontiguousarray(np.stack([linear, angular], axis=2)))
