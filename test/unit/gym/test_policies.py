"""The reward must be highest for cleaning, lower for wandering about, lowest for standing."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from examples.bounce_policy import Bounce
from roomba.gym import RoombaClean

Policy = Callable[[NDArray[np.float32]], NDArray[np.float32]]


def total_reward(policy: Policy) -> float:
    environment = RoombaClean(home="apartment", duration=120.0)
    observation, _ = environment.reset(seed=5)
    total, is_over = 0.0, False
    while not is_over:
        observation, reward, terminated, truncated, _ = environment.step(policy(observation))
        total += reward
        is_over = terminated or truncated
    return total


def test_bouncing_beats_chance_and_chance_beats_standing() -> None:
    random = np.random.default_rng(0)
    bouncing = total_reward(Bounce(seed=0))
    by_chance = total_reward(lambda _: random.uniform(-1.0, 1.0, 2).astype(np.float32))
    standing = total_reward(lambda _: np.zeros(2, np.float32))
    assert standing < by_chance < bouncing
    assert standing < 0.0 < bouncing
