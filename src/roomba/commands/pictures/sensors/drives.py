"""Drives that are recorded step by step, for plots over time or way."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from roomba.arrays import Floats
from roomba.configuration.body import BodyConfig
from roomba.configuration.loops import ControlConfig
from roomba.configuration.robot import TimingConfig
from roomba.control.position_loop import PositionLoop
from roomba.geometry import Twist
from roomba.world.simulator import Simulator

STEP = TimingConfig().world_step
"""s."""
_NEAR = 0.05
"""m; nearer than this to a point of its way the robot goes on to the next one."""


@dataclass(slots=True)
class DriveRecording:
    """A simulator, and all numbers of its robot (see ``Simulator.numbers``) as time passes.

    ``extra`` are more of them, by name: functions of the simulator.
    """

    simulator: Simulator
    extra: dict[str, Callable[[Simulator], float]] = field(default_factory=dict)
    _rows: list[dict[str, float]] = field(default_factory=list, repr=False)

    def drive(self, twist: Twist, seconds: float, dt: float = STEP, steps: int = 1) -> None:
        """Let time pass in steps of ``dt`` s, and write down every ``steps``-th of them."""
        for _ in range(max(1, round(seconds / (dt * steps)))):
            self.step(twist, dt, steps)

    def step(self, twist: Twist, dt: float = STEP, steps: int = 1) -> dict[str, float]:
        """Let so many steps pass; write down and return the numbers then."""
        self.simulator.advance(twist, dt, steps)
        numbers = self.simulator.numbers
        numbers["time"] = self.simulator.time
        for name, function in self.extra.items():
            numbers[name] = function(self.simulator)
        self._rows.append(numbers)
        return numbers

    def of(self, name: str) -> Floats:
        """Return one number over time."""
        return np.array([row[name] for row in self._rows], np.float64)


def follow(
    recording: DriveRecording, points: Sequence[tuple[float, float]], speed: float, seconds: float
) -> None:
    """Drive straight from point to point, m, map frame, again and again, by the true pose."""
    loop = PositionLoop(ControlConfig(), BodyConfig())
    world = recording.simulator
    until = world.time + seconds
    for point in itertools.cycle(points):
        while world.pose.distance_to(*point) > _NEAR:
            if world.time > until:
                return
            recording.step(loop.tick(world.pose, point, speed))


def wander(recording: DriveRecording, seconds: float, dt: float, steps: int, seed: int = 0) -> None:
    """Drive straight on, and turn by chance after each bump."""
    random = np.random.default_rng(seed)
    turning, twist = 0.0, Twist(0.3, 0.0)
    until = recording.simulator.time + seconds
    while recording.simulator.time < until:
        numbers = recording.step(twist, dt, steps)
        turning -= dt * steps
        if numbers["bumper_left"] > 0.0 or numbers["bumper_right"] > 0.0:
            turning = float(random.uniform(0.6, 2.0))
            twist = Twist(0.0, 1.2 if numbers["bumper_right"] > 0.0 else -1.2)
        elif turning <= 0.0:
            twist = Twist(0.3, 0.0)
