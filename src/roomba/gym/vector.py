"""``RoombaClean-v0`` many times at once, on one fleet: a batch is one compiled call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.geometry import Pose
from roomba.gym.cleaning import Beginning, CleaningTask, Flags, Outcome
from roomba.gym.single import RENDER_MODES, action_space, metadata_of
from roomba.gym.task import Task

Observations = NDArray[np.float32]
Actions = NDArray[np.float32]


class RoombaCleanVector(VectorEnv[Observations, Actions, NDArray[Any]]):
    """Robots that clean, each in its own copy of the home, shared out among threads.

    Actions, observations, rewards and ends are those of :class:`roomba.gym.RoombaClean`, with a
    first axis for the robots: one that is seeded alike gives the same numbers, bit for bit, here
    and there. An episode that ended begins anew with the next step, whose action is not used and
    whose reward is 0 (``AutoresetMode.NEXT_STEP``).
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": list(RENDER_MODES),
        "render_fps": 5,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        *,
        render_mode: str | None = None,
        threads: int | None = None,
        **task: Any,
    ) -> None:
        """Make ``num_envs`` worlds; ``task`` is the arguments of :class:`roomba.gym.Task`.

        ``threads``: at most so many work (default: all cores). Raises what RoombaClean does, and
        ValueError for fewer than one world.
        """
        if num_envs < 1:
            raise ValueError(f"num_envs: expected 1 or more, got {num_envs}")
        self.task = Task(**task)
        self.metadata = metadata_of(self.metadata, self.task, render_mode)  # type: ignore[misc]
        self.render_mode = render_mode
        self.num_envs = num_envs
        self._cleaning = CleaningTask(self.task, num_envs, threads)
        self.single_action_space = action_space()
        self.single_observation_space = self._cleaning.senses.space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._randoms: list[np.random.Generator | None] = [None] * num_envs
        self._has_ended = np.ones(num_envs, np.bool_)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin all episodes; ``options`` as those of RoombaClean, for every robot.

        ``seed``: one for each, or the first of ``num_envs`` in a row; None goes on at random.
        Raises ValueError for another number of seeds, and what RoombaClean does. All present
        episodes then go on.
        """
        start = self._cleaning.start_of(options)
        self._randoms = self._randoms_by(self._seeds(seed))
        super().reset(seed=seed if isinstance(seed, int) else None)
        everyone = np.ones(self.num_envs, np.bool_)
        self._begin(everyone, start)
        outcome = self._cleaning.act(np.zeros((self.num_envs, 2)), beginning=everyone)
        self._has_ended[:] = False
        return outcome.observations, _infos(outcome)

    def step(self, actions: Actions) -> tuple[Observations, Floats, Flags, Flags, dict[str, Any]]:
        """Let all drive, float32 [num_envs, 2].

        Raises ValueError for actions of another shape, or that are not finite.
        """
        beginning = self._has_ended
        self._begin(beginning)
        outcome = self._cleaning.act(np.asarray(actions), beginning)
        self._has_ended = outcome.terminated | outcome.truncated
        return (
            outcome.observations,
            outcome.rewards,
            outcome.terminated,
            outcome.truncated,
            _infos(outcome),
        )

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Return a plan with dirt and robot of each world, uint8 [height, width, 3]."""
        if self.render_mode is None:
            return None
        # Not imported above: it loads OpenCV, which training has no use for.
        from roomba.gym.picture import picture_of

        return tuple(picture_of(self._cleaning.fleet, robot) for robot in range(self.num_envs))

    def close_extras(self, **_: Any) -> None:
        """End the threads."""
        self._cleaning.fleet.close()

    def _begin(self, robots: Flags, start: Pose | None = None) -> None:
        """Begin episodes; if one cannot, none does."""
        numbers = np.flatnonzero(robots).tolist()
        beginnings = [self._beginning_of(robot, start) for robot in numbers]
        for robot, beginning in zip(numbers, beginnings, strict=True):
            self._cleaning.begin(robot, beginning)

    def _beginning_of(self, robot: int, start: Pose | None) -> Beginning:
        random = self._randoms[robot]
        if random is None:
            raise RuntimeError("expected reset() before the first step()")
        return self._cleaning.beginning_of(random, start)

    def _randoms_by(self, seeds: Sequence[int | None]) -> list[np.random.Generator | None]:
        return [
            random if own is None and random is not None else seeding.np_random(own)[0]
            for own, random in zip(seeds, self._randoms, strict=True)
        ]

    def _seeds(self, seed: int | Sequence[int | None] | None) -> Sequence[int | None]:
        if seed is None:
            return [None] * self.num_envs
        seeds = range(seed, seed + self.num_envs) if isinstance(seed, int) else seed
        if len(seeds) != self.num_envs:
            raise ValueError(f"expected {self.num_envs} seeds, one for each, got {len(seeds)}")
        return seeds


def _infos(outcome: Outcome) -> dict[str, Any]:
    """Return the truths of all robots, each with Gymnasium's mask of robots that have it: all."""
    infos: dict[str, Any] = dict(outcome.truths)
    for name, values in outcome.truths.items():
        infos[f"_{name}"] = np.ones(len(values), np.bool_)
    return infos
