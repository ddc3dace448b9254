"""Code that the simulating peers share: the floor, the driving rule, and the counted units."""

from __future__ import annotations

import itertools
import math
import random
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from roomba_bench.peers.protocol import CHECKED_POSES, Parameters, Work
from roomba_bench.peers.simulators.boxes import boxes_of

SPEED = 0.3
"""m/s."""
TURNING_SPEED = 1.5
"""rad/s."""
SHORTEST_TURN, LONGEST_TURN = 0.4, 3.0
"""s."""
_CHECKED_STEPS = 200
_LEAST_WAY = 0.3
"""m; a robot that has moved less after the checked steps (10 s) is stuck."""


@dataclass(eq=False)
class Arena:
    """The case, in metres: solid cells (the file and the array), body, lidar, and start."""

    path: Path
    solid: NDArray[np.bool_]
    resolution: float
    origin: tuple[float, float]
    radius: float
    beams: int
    reach: float
    dt: float
    start: tuple[float, float, float]

    @classmethod
    def of(cls, parameters: Parameters) -> Arena:
        """Read the case."""
        path = Path(parameters["solid"])
        x, y, theta = parameters["start"]
        return cls(
            path,
            np.load(path),
            parameters["resolution"],
            (parameters["origin"][0], parameters["origin"][1]),
            parameters["radius"],
            parameters["beams"],
            parameters["reach"],
            parameters["dt"],
            (x, y, theta),
        )

    @property
    def boxes(self) -> NDArray[np.float64]:
        """Boxes over the solid cells: middle x, y, half length along x, along y; float64 [n, 4]."""
        cells = boxes_of(self.solid) * self.resolution
        middle = 0.5 * (cells[:, :2] + cells[:, 2:]) + np.array(self.origin)
        return np.hstack([middle, 0.5 * (cells[:, 2:] - cells[:, :2])])

    @cached_property
    def fan(self) -> NDArray[np.float64]:
        """Ends of the beams at (0, 0, 0), float64 [beams, 2], m."""
        angles = np.arange(self.beams) * (2.0 * math.pi / self.beams)
        return self.reach * np.column_stack([np.cos(angles), np.sin(angles)])

    def beams_from(self, x: float, y: float, theta: float) -> NDArray[np.float64]:
        """Return the ends of the beams at a pose, float64 [beams, 2], m."""
        cosine, sine = math.cos(theta), math.sin(theta)
        turn = np.array([[cosine, sine], [-sine, cosine]])
        ends: NDArray[np.float64] = self.fan @ turn + np.array([x, y])
        return ends


class Engine(Protocol):
    """What a peer's script offers: a robot in the arena."""

    def place(self, x: float, y: float, theta: float) -> None:
        """Put the robot there."""

    def pose(self) -> tuple[float, float, float]:
        """Return where it is: x, y, theta."""

    def step(self, linear: float, angular: float) -> bool:
        """Let dt pass at a speed, m/s and rad/s; return whether it touches something."""

    def scan(self) -> NDArray[np.floating[Any]]:
        """Return the ranges of all beams, m, float [beams]."""


class Bounce:
    """The driving rule, seeded."""

    def __init__(self, dt: float, seed: int = 0) -> None:
        """Steps take ``dt`` s."""
        self._dt = dt
        self._random = random.Random(seed)
        self._turning = 0.0
        self._wants_turn = False

    def twist(self, is_bumped: bool) -> tuple[float, float]:
        """Return the speed of the next step, m/s and rad/s."""
        if self._turning > 0.0:
            self._turning -= self._dt
            return 0.0, TURNING_SPEED
        if is_bumped and not self._wants_turn:
            self._turning = self._random.uniform(SHORTEST_TURN, LONGEST_TURN)
            self._wants_turn = True
            return 0.0, TURNING_SPEED
        # After a turn the robot leaves the wall in the first step: until then no touch is a bump.
        self._wants_turn = False
        return SPEED, 0.0


def work_of(engine: Engine, arena: Arena, parameters: Parameters) -> Work:
    """Return what the case asks for: "drive" counts robot steps, "scan" counts scans."""
    if parameters["case"] == "scan":
        return _scanning(engine, parameters)
    return _driving(engine, arena, int(parameters["scan_every"]))


def _scanning(engine: Engine, parameters: Parameters) -> Work:
    poses = np.load(parameters["poses"]).tolist()
    forever = itertools.cycle(poses)

    def scan() -> float:
        engine.place(*next(forever))
        engine.scan()
        return 1.0

    ranges = []
    for pose in poses[:CHECKED_POSES]:
        engine.place(*pose)
        ranges.append(float(np.mean(engine.scan())))
    return Work(scan, {"mean range": float(np.mean(ranges))})


def _driving(engine: Engine, arena: Arena, scan_every: int) -> Work:
    bounce = Bounce(arena.dt)
    counter = itertools.count()
    is_bumped = False
    engine.place(*arena.start)

    def step() -> float:
        nonlocal is_bumped
        is_bumped = engine.step(*bounce.twist(is_bumped))
        if next(counter) % scan_every == 0:
            engine.scan()
        return 1.0

    way, bumps = 0.0, 0
    before = engine.pose()
    for _ in range(_CHECKED_STEPS):
        step()
        after = engine.pose()
        way += math.dist(before[:2], after[:2])
        bumps += is_bumped
        before = after
    if way < _LEAST_WAY:
        raise ValueError(f"it is stuck: {way:.2f} m in {_CHECKED_STEPS} steps")
    return Work(step, {"way": way, "bumped steps": float(bumps)})
