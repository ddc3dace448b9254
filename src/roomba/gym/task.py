"""The task of an agent: home, robot, duration, and the weights of the reward."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home


@dataclass(frozen=True, slots=True)
class Task:
    """The arguments of both environments; all but ``home`` have units of their own.

    * ``home``: a name of the homes that come along, the path of a folder or map, or a Home.
    * ``config``: the robot; default: the shipped one. ``sensors``: "noisy" or "ideal"; default:
      as ``config`` says, which is "noisy" unless it says otherwise.
    * ``duration``: s of robot time after which an episode is truncated.
    * ``dt``: s; one step of the world. ``steps_per_action``: so many of them for each action.
    * ``max_speed``: m/s; what an action of 1 asks for. Turning goes up to the body's own limit.
    * ``energy_weight``, g/Wh, and ``time_weight``, g/s: what energy and time cost, in dirt.

    Raises ValueError for numbers out of range.
    """

    home: str | Path | Home = "apartment"
    config: SimulatedRobotConfig | None = None
    sensors: Literal["ideal", "noisy"] | None = None
    duration: float = 600.0
    dt: float = 0.05
    steps_per_action: int = 4
    max_speed: float = 0.5
    energy_weight: float = 0.25
    time_weight: float = 0.001

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name in ("duration", "dt", "max_speed"):
            value = getattr(self, name)
            if not math.isfinite(value) or value <= 0.0:
                raise ValueError(f"{name}: expected a finite number above 0, got {value}")
        for name in ("energy_weight", "time_weight"):
            value = getattr(self, name)
            if not math.isfinite(value) or value < 0.0:
                raise ValueError(f"{name}: expected a finite number of 0 or more, got {value}")
        if self.steps_per_action < 1:
            raise ValueError(
                f"steps_per_action: expected 1 step or more, got {self.steps_per_action}"
            )
        if self.sensors not in (None, "ideal", "noisy"):
            raise ValueError(f'sensors: expected "ideal" or "noisy", got {self.sensors!r}')

    @property
    def robot(self) -> SimulatedRobotConfig:
        """The robot that does it."""
        config = self.config or SimulatedRobotConfig()
        if self.sensors is None:
            return config
        return config.with_sensors(self.sensors)

    @property
    def action_time(self) -> float:
        """Robot time that one action takes, s."""
        return self.dt * self.steps_per_action

    @property
    def most_actions(self) -> int:
        """How many actions an episode has at most."""
        return max(1, round(self.duration / self.action_time))

    def loaded_home(self) -> Home:
        """Return the home; raises HomeError where there is none."""
        if isinstance(self.home, Home):
            return self.home
        return load_home(str(self.home), HOMES, self.robot.body)
