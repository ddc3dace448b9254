"""``RoombaClean-v0``: one robot that cleans a home."""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from roomba.gym.cleaning import CleaningTask, Outcome
from roomba.gym.task import Task
from roomba.world.fleet import Fleet

Observation = NDArray[np.float32]
Action = NDArray[np.float32]

RENDER_MODES = ("rgb_array",)


class RoombaClean(gymnasium.Env[NDArray[Any], NDArray[Any]]):
    """Drive a robot vacuum so that the dirt is in its bin, soon and with little energy.

    **Action**, Box(-1, 1, (2,)): speed ahead and turning, as shares of ``max_speed`` and of the
    body's greatest angular speed; the drive's acceleration limits hold.

    **Observation**, a flat Box of 51: see :mod:`roomba.gym.observation`. Only what the robot's
    sensors tell; the truth is in ``info``: ``pose``, ``covered``, ``dirt_removed`` (g), ``energy``
    (Wh), ``distance`` (m), ``collisions`` and ``time`` (s), counted from the episode's start.

    **Reward**, in grams: what came into the bin (g) - energy_weight (g/Wh) * what was taken from
    the battery (Wh) - time_weight (g/s) * the time (s). A fresh floor gives up to 0.03 g/s at
    full speed; by default standing costs 0.0014 g/s, and driving 0.0023 g/s. So cleaning pays
    until little is left, standing loses, and driving over clean floor loses more.

    **Start**: a free place that can be reached from the station, by the seed; or as
    ``reset(options=...)`` says: ``{"start": (x, y, theta)}`` or ``{"at_station": True}``. During
    a reset the robot stands for the time of one action, so that it has a scan to begin with.

    **End**: terminated when the battery is empty, the bin is full or holds as much as 99 % of the
    dirt that could be reached at first; truncated after ``duration``.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": list(RENDER_MODES), "render_fps": 5}  # type: ignore[misc]

    def __init__(self, *, render_mode: str | None = None, **task: Any) -> None:
        """Make a home with a robot; ``task`` is the arguments of :class:`roomba.gym.Task`.

        Raises HomeError for a home that cannot be used, ValueError or TypeError for other
        arguments.
        """
        self.task = Task(**task)
        self.metadata = metadata_of(self.metadata, self.task, render_mode)  # type: ignore[misc]
        self.render_mode = render_mode
        self._cleaning = CleaningTask(self.task, robots=1, threads=1)
        self.action_space = action_space()
        self.observation_space = self._cleaning.senses.space

    @property
    def fleet(self) -> Fleet:
        """The simulated world with its one robot, number 0: the truth, which no policy is given.

        A program may let faults happen there, or look at the floor.
        """
        return self._cleaning.fleet

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode; the same seed and actions give the same observations.

        Raises ValueError for other options, HomeError for a start where the robot does not fit. The
        present episode then goes on.
        """
        start = self._cleaning.start_of(options)
        super().reset(seed=seed)
        self._cleaning.begin(0, self._cleaning.beginning_of(self.np_random, start))
        outcome = self._cleaning.act(np.zeros((1, 2)), beginning=np.ones(1, np.bool_))
        return outcome.observations[0], _truths(outcome)

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Drive for ``action_time`` s.

        Raises ValueError for an action of another shape, or that is not finite.
        """
        if np.shape(action) != (2,):
            raise ValueError(f"expected an action of shape (2,), got {np.shape(action)}")
        outcome = self._cleaning.act(np.array([action]), beginning=np.zeros(1, np.bool_))
        return (
            outcome.observations[0],
            float(outcome.rewards[0]),
            bool(outcome.terminated[0]),
            bool(outcome.truncated[0]),
            _truths(outcome),
        )

    def render(self) -> NDArray[np.uint8] | None:
        """Return the plan with dirt and robot, uint8 [height, width, 3]; None without a mode."""
        if self.render_mode is None:
            return None
        # Not imported above: it loads OpenCV, which training has no use for.
        from roomba.gym.picture import picture_of

        return picture_of(self._cleaning.fleet, 0)

    def close(self) -> None:
        """End what was begun; may be called again."""
        self._cleaning.fleet.close()


def action_space() -> Box:
    """Return the bounds of an action: speed ahead and turning, as shares of the greatest."""
    return Box(-1.0, 1.0, (2,), np.float32)


def metadata_of(metadata: dict[str, Any], task: Task, render_mode: str | None) -> dict[str, Any]:
    """Return an environment's own metadata; raises ValueError for another render mode."""
    if render_mode is not None and render_mode not in RENDER_MODES:
        raise ValueError(
            f"render_mode: expected None or one of {RENDER_MODES}, got {render_mode!r}"
        )
    return {**metadata, "render_fps": max(1, round(1.0 / task.action_time))}


def _truths(outcome: Outcome) -> dict[str, Any]:
    return {
        name: float(values[0]) if values.ndim == 1 else values[0]
        for name, values in outcome.truths.items()
    }
