"""The task of an agent: home, robot, duration, and the weights of the reward."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import Final, Literal

from roomba.configuration.body import FASTEST_SPEED
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

_RANGES: Final = {
    "duration": (0.001, 1e7),
    "dt": (0.001, 1.0),
    "max_speed": (0.001, FASTEST_SPEED),
    "energy_weight": (0.0, 1e6),
    "time_weight": (0.0, 1e6),
}
"""The least and the most of each number; with a longer ``dt`` robots pass through walls."""
_MOST_STEPS: Final = 10_000
"""Most steps of the world per action: they are one compiled call, which nothing interrupts."""


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
        for name, (least, most) in _RANGES.items():
            value = getattr(self, name)
            if not least <= value <= most:
                raise ValueError(f"{name}: expected a number of {least:g} to {most:g}, got {value}")
        steps = self.steps_per_action
        if not isinstance(steps, Integral) or not 1 <= steps <= _MOST_STEPS:
            raise ValueError(
                f"steps_per_action: expected a whole number of 1 to {_MOST_STEPS}, got {steps}"
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
