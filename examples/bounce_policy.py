"""A robot that drives straight on until it bumps, and turns away: how the first robot vacuums did.

./roomba exec python examples/bounce_policy.py
"""

import gymnasium
import numpy as np
from numpy.typing import NDArray

from roomba.gym.observation import BUMPER, CLIFF, LIDAR


class Bounce:
    """Knows nothing but what the sensors tell in this moment, and how long it still turns."""

    def __init__(self, seed: int = 0) -> None:
        """Turn by angles that are drawn from this seed."""
        self._random = np.random.default_rng(seed)
        self._turns_left, self._side = 0, 1.0

    def __call__(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the speed and the turning that it wants, -1..1."""
        left, right = observation[BUMPER] > 0.0
        sees_drop = observation[CLIFF].any()
        if self._turns_left == 0 and (left or right or sees_drop):
            self._side = 1.0 if right and not left else -1.0
            self._turns_left = int(self._random.integers(3, 9))
        if self._turns_left > 0:
            self._turns_left -= 1
            return np.array([-0.3 if sees_drop else 0.0, 0.5 * self._side], np.float32)
        room_ahead = observation[LIDAR][[-1, 0, 1]].min()
        return np.array([1.0 if room_ahead > 0.4 else 0.4, 0.0], np.float32)


def main() -> None:
    """Let it clean until the episode is over, and tell what came of it."""
    environment = gymnasium.make("roomba.gym:RoombaClean-v0", home="apartment")
    bounce = Bounce()
    observation, info = environment.reset(seed=0)
    total, is_over = 0.0, False
    while not is_over:
        observation, reward, terminated, truncated, info = environment.step(bounce(observation))
        total += float(reward)
        is_over = terminated or truncated
    print(
        f"bouncing for {info['time']:.0f} s: {info['dirt_removed']:.1f} g in the bin, "
        f"{100 * info['covered']:.0f} % of the floor covered, {info['energy']:.2f} Wh used, "
        f"{info['collisions']:.0f} collisions, reward {total:.2f}"
    )


if __name__ == "__main__":
    main()
